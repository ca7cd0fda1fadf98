"""The one way in which diagnostics hands work to processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context

from siggen.child_environment import SAFE_PATH, child_environment
from siggen.errors import EngineError, counted


@contextmanager
def process_pool(workers: int, initializer: Callable[[], object] | None = None) -> Iterator[ProcessPoolExecutor]:
    """Give spawned processes, which take no module from the folder where the command runs.

    Raises
    ------
    EngineError
        If one of them is ended from outside.
    """
    try:
        with (
            child_environment(SAFE_PATH),  # before the pool: its semaphores start a process, too
            ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=initializer) as pool,
        ):
            yield pool
    except BrokenExecutor as error:
        raise EngineError(
            f"one of {counted(workers, 'process', 'processes')} was ended from outside, most often since memory ran "
            "out; nothing was kept of its work, and the same command begins again"
        ) from error
