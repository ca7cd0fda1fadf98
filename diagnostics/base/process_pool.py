"""The one way in which diagnostics hands work to processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context

from siggen.child_environment import SAFE_PATH, child_environment


@contextmanager
def process_pool(workers: int, initializer: Callable[[], object] | None = None) -> Iterator[ProcessPoolExecutor]:
    """Give spawned processes, which take no module from the folder where the command runs."""
    with (
        child_environment(SAFE_PATH),  # before the pool: its semaphores start a process, too
        ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=initializer) as pool,
    ):
        yield pool
