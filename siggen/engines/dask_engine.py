"""The engine of Dask: tasks go to a cluster that is there already, or to worker processes of this machine."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any

from siggen.child_environment import OF_WORKERS, child_environment
from siggen.engines.orphan import end_with, ending_with_this
from siggen.engines.protocol import Result, Results, Task, task_error
from siggen.engines.window import windowed
from siggen.engines.worker import RAISED, answer
from siggen.errors import EngineError, UsageError, how_to_install

ADDRESS_VARIABLE = "DASK_SCHEDULER_ADDRESS"


class DaskEngine:
    """Runs tasks on Dask workers with one numeric thread each.

    Parameters
    ----------
    workers : int
        Processes of a cluster on this machine, which ends with the work; for a given cluster, how many workers the
        window of open tasks is cut for.
    address : str, optional
        Of a scheduler, such as tcp://head:8786; default: the environment's `DASK_SCHEDULER_ADDRESS`, else a cluster
        on this machine. Workers of a given cluster need siggen, and one numeric thread (OMP_NUM_THREADS=1 ...).

    Raises
    ------
    UsageError
        If Dask is not installed, or fewer than one worker is asked for.
    """

    def __init__(self, workers: int, address: str | None = None) -> None:
        import importlib.util

        if importlib.util.find_spec("distributed") is None:
            raise UsageError(f"the engine 'dask' needs distributed: {how_to_install('dask')}")
        if workers < 1:
            raise UsageError(f"received {workers} workers; at least 1 is needed")
        self.workers = workers
        self.address = address or os.environ.get(ADDRESS_VARIABLE)
        self._draining = False

    def drain(self) -> None:
        """Hand in no further task, nor the rest of one; see `DrainingEngine`."""
        self._draining = True

    def map(self, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Results[Result]:
        """Yield (position, result) as tasks complete; see `Engine.map`.

        Raises
        ------
        EngineError
            If a task raised, or the workers that ran it died too often.
        """
        from distributed import as_completed

        self._draining = False
        call = answer if self.address is not None else partial(_child_answer, os.getpid())
        with self._client() as client:
            done = as_completed(loop=client.loop)

            def submit(task: Task, position: int) -> Any:
                future = client.submit(call, function, task, pure=False, priority=-position)
                done.add(future)
                return future

            yield from windowed(
                tasks,
                self.workers,
                submit=submit,
                finished=lambda _: done.next_batch(),
                value=_value,
                drained=lambda: self._draining,
            )

    @contextmanager
    def _client(self) -> Iterator[Any]:
        from distributed import Client, LocalCluster

        if self.address is not None:
            with Client(self.address) as client:
                yield client
            return
        options = {"host": "127.0.0.1", "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
        with ExitStack() as stack:
            stack.enter_context(ending_with_this())  # to the end: those that die are replaced
            stack.enter_context(child_environment(OF_WORKERS))  # what Dask is given as `env` comes after the start
            try:
                cluster = stack.enter_context(LocalCluster(n_workers=self.workers, **options))
                client = stack.enter_context(Client(cluster))
            except (RuntimeError, OSError, TimeoutError) as error:
                raise EngineError(
                    f"the cluster of Dask on this machine did not start ({error}); what is committed stays: try again"
                ) from error
            yield client


def _child_answer(parent: int, function: Callable[[Any], Any], task: Any) -> tuple[str, Any]:
    """Answer on a worker that this machine's cluster started as a child of its driver, and ends with it."""
    end_with(parent)
    return answer(function, task)


def _value(future: Any, task: object) -> Any:
    from distributed.scheduler import KilledWorker

    try:
        kind, content = future.result()
    except KilledWorker as error:
        raise EngineError(
            f"{task} was lost because the workers that ran it died ({error.last_worker}); what is committed stays: try "
            "again with fewer workers"
        ) from error
    if kind == RAISED:
        raise task_error(task, content)
    return content
