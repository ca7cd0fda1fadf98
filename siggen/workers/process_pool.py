"""The pool of one machine: copies of one process that has imported, with one numeric thread each.

Where the system has a fork server, it imports the simulation once, and every worker is a copy of it. Elsewhere workers
are spawned and import it themselves.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import current_process, get_context, parent_process
from multiprocessing.context import BaseContext
from typing import Any

from siggen.child_environment import OF_WORKERS, child_environment
from siggen.errors import EngineError
from siggen.workers.orphan import end_with

PARENTS_SIGNALS = {signal.SIGINT, signal.SIGTERM}
"""A terminal sends Ctrl-C to the whole process group; only the parent decides what it means."""

IMPORTING = 78
"""Exit code of a worker that imports a script which starts workers itself."""

PRELOADED = "siggen.sets.preloaded"
DRIVER = "SIGGEN_DRIVER"
"""Variable that tells the fork server whom it ends with."""


class WorkerPool(ProcessPoolExecutor):
    """Worker processes of this machine; leaving its block ends them at once.

    Parameters
    ----------
    workers : int
    """

    def __init__(self, workers: int) -> None:
        context = _context()
        variables = {**os.environ, **OF_WORKERS}
        super().__init__(workers, mp_context=context, initializer=_settle_down, initargs=(variables, os.getpid()))

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Hand a task over.

        Raises
        ------
        BrokenProcessPool
            Also if the fork server died, which copies itself for a new worker.
        """
        try:
            return super().submit(function, *arguments, **named)
        except (EOFError, OSError) as error:
            raise BrokenProcessPool(f"a worker could not be started: {error}") from error

    def __exit__(self, *_: object) -> None:
        """End the workers, whatever they do: what is not finished is made again.

        Raises
        ------
        EngineError
            If they ended because the script starts workers while they import it.
        """
        processes = list((self._processes or {}).values())
        self.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()
        for process in processes:
            process.join()
        if any(process.exitcode == IMPORTING for process in processes):
            raise EngineError(
                "workers import the script, which starts workers again. Put what calls siggen below the line "
                '`if __name__ == "__main__":`'
            ) from None


@contextmanager
def worker_pool(workers: int) -> Iterator[WorkerPool]:
    """Give a pool whose processes are started inside the block, deaf to signals and with one thread each."""
    if getattr(current_process(), "_inheriting", False):  # a worker that is not ready: it imports the script
        os._exit(IMPORTING)
    with child_environment({**OF_WORKERS, DRIVER: str(os.getpid())}), _blocked(PARENTS_SIGNALS):
        pool = WorkerPool(workers)
    with pool:
        yield pool


def _context() -> BaseContext:
    """Return how processes are started; starts the fork server where there is none."""
    if sys.platform != "linux":
        return get_context("spawn")
    from multiprocessing import forkserver

    context = get_context("forkserver")
    context.set_forkserver_preload([PRELOADED])
    forkserver.ensure_running()
    return context


def _settle_down(variables: Mapping[str, str], driver: int) -> None:
    """Prepare a worker: the driver's environment, no signals, one thread, the end with its driver."""
    os.environ.clear()
    os.environ.update(variables)
    for number in PARENTS_SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    end_with(os.getppid())  # the driver, or the fork server, which ends with it
    owner = parent_process()
    if owner is not None and os.getppid() != driver:
        threading.Thread(target=_follow, args=(owner.sentinel,), daemon=True).start()
    import pyarrow as pa

    pa.set_cpu_count(1)
    pa.set_io_thread_count(1)


def _follow(sentinel: int) -> None:
    """End with the driver where the fork server outlives it: somebody else has started that."""
    from multiprocessing.connection import wait

    wait([sentinel])
    os._exit(1)


@contextmanager
def _blocked(numbers: set[signal.Signals]) -> Iterator[None]:
    """Block signals inside the block: a process started there inherits it, and cannot be hit before it ignores them."""
    if not hasattr(signal, "pthread_sigmask"):  # not a POSIX system
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, numbers)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
