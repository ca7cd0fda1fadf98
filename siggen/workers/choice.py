"""Who runs the work, by name or as an executor: the one place that knows which there are."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from functools import partial
from numbers import Integral
from typing import Any

from siggen.errors import EngineError, UsageError
from siggen.workers.clusters import address_of, dask_pool, ray_pool
from siggen.workers.process_pool import worker_pool
from siggen.workers.tasks import Workers

NAMES = ("serial", "processes", "dask", "ray")
OPEN_TASKS = 1_000
"""Of an executor that does not say how many workers it has."""
SHUT_DOWN = ("_shutdown", "_shutdown_thread")
"""How the thread and process pools of Python note that they take no more tasks."""


def default_workers() -> int:
    """Return the number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class SerialExecutor(Executor):
    """Runs what is submitted at once, here; for debuggers, and as the reference of all others."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Run a function and return its result in a future."""
        future: Future[Any] = Future()
        future.set_result(function(*arguments, **named))
        return future


def workers_of(executor: Executor | str | None, workers: int | None, address: str | None = None) -> Workers:
    """Return who runs the work.

    Parameters
    ----------
    executor : Executor, str or None
        An executor of `concurrent.futures`, which whoever gave it ends; or one of `NAMES`. None: 'serial' for no
        workers, else 'processes'.
    workers : int or None
        By default one per core; 'serial' has one whatever is asked for. Of an executor that was given: for how many
        workers tasks are kept open.
    address : str, optional
        Of a cluster of Dask or Ray that is there already.

    Raises
    ------
    UsageError
        If there is no such executor, it was shut down, `workers` is no number that it can have, or an address is given
        without a cluster.
    """
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, Integral) or workers < 0):
        raise UsageError(f"workers: received {workers!r}; allowed: 0, 1, 2 and so on, or None")
    if isinstance(executor, Executor):
        if any(getattr(executor, flag, False) is True for flag in SHUT_DOWN):
            raise UsageError(
                f"executor: received a {type(executor).__name__} that was shut down; allowed: a running one"
            )
        count = workers or getattr(executor, "_max_workers", None) or OPEN_TASKS
        return Workers(type(executor).__name__, count, _Given(executor))
    if executor is None:
        # one worker is a process too: its libraries run one thread, as everywhere, and threads change how sums round
        executor = "serial" if workers == 0 else "processes"
    if executor not in NAMES:
        raise UsageError(
            f"received {_named(executor)} as an executor; allowed: {', '.join(NAMES)}, or an Executor of "
            "concurrent.futures, such as `client.get_executor(pure=False)` of Dask"
        )
    if address is not None and executor not in ("dask", "ray"):
        raise UsageError(f"received the address {address} and the executor {executor}; allowed: with dask and ray")
    if executor == "serial":
        return Workers("serial", 1, SerialExecutor)
    count = default_workers() if workers is None else workers
    if count < 1:
        raise UsageError(f"workers: received {count}; allowed: 1, 2 and so on, or 0 with the executor 'serial'")
    if executor == "processes":
        return Workers("processes", count, partial(worker_pool, count))
    found, pool = address_of(executor, address), dask_pool if executor == "dask" else ray_pool
    is_own = executor == "dask" and found is None
    return Workers(executor, count, partial(pool, count, found), os.getpid() if is_own else None)


class _Given:
    """Gives an executor that somebody else ends; once it broke, no other takes its place."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor

    @contextmanager
    def _once(self) -> Iterator[Executor]:
        yield self._executor

    def __call__(self) -> Any:
        if getattr(self._executor, "_broken", False):
            raise EngineError(f"the executor {type(self._executor).__name__} that was given has broken; give a new one")
        return self._once()


def _named(value: object) -> str:
    return f"'{value}'" if isinstance(value, str) else f"a {type(value).__name__}"
