"""The one way in which diagnostics hands work to processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context
from typing import Any

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


@contextmanager
def second_process(*, worth: bool, first: Callable[[], object]) -> Iterator[Callable[..., Callable[[], Any]]]:
    """Give `begin(function, *arguments)`, whose result is called for later: computed meanwhile by another process.

    Parameters
    ----------
    worth : bool
        Whether there is one; without it results are computed here, when they are called for.
    first : callable
        What the other process does at once, such as importing what it will need.
    """
    if not worth:
        yield partial
        return
    with process_pool(1) as pool:
        pool.submit(first)

        def begin(function: Callable[..., Any], *arguments: Any) -> Callable[[], Any]:
            return pool.submit(function, *arguments).result

        yield begin
