"""The engine of one machine: spawned worker processes that are replaced when they die."""

from __future__ import annotations

import contextlib
import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import wait
from typing import Any

from siggen.engines.protocol import Result, Results, Task, Unfinished, task_error
from siggen.engines.window import WINDOW_PER_WORKER
from siggen.engines.worker import DONE, OUT_OF_MEMORY, RAISED, READY, Worker
from siggen.errors import EngineError, UsageError

TASK_ATTEMPTS = 3
START_ATTEMPTS = 3


def default_workers() -> int:
    """Return the number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class ProcessEngine:
    """Runs tasks in `workers` spawned processes with one numeric thread each.

    Parameters
    ----------
    workers : int
    """

    def __init__(self, workers: int) -> None:
        if workers < 1:
            raise UsageError(f"received {workers} workers; at least 1 is needed")
        self.workers = workers
        self._pool: _Pool | None = None

    def drain(self) -> None:
        """Hand out no further task, nor the rest of one; see `DrainingEngine`."""
        if self._pool is not None:
            self._pool.draining = True

    def map(self, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Results[Result]:
        """Yield (position, result) as tasks complete; see `Engine.map`.

        Raises
        ------
        EngineError
            If a task raised, if its worker died `TASK_ATTEMPTS` times, or if workers do not start.
        """
        pool = self._pool = _Pool(function, self.workers, iter(tasks))
        try:
            yield from pool.run()
        finally:
            self._pool = None
            pool.close()


class _Pool:
    """The workers of one `map` and what they are busy with."""

    def __init__(self, function: Callable[[Any], Any], workers: int, tasks: Iterator[Any]) -> None:
        self.function, self.limit, self.tasks = function, workers, tasks
        self.workers: list[Worker] = []
        self.unfinished: dict[int, Any] = {}
        self.waiting: deque[int] = deque()
        self.losses: dict[int, int] = {}
        self.taken = 0
        self.failed_starts = 0
        self.exhausted = False
        self.draining = False

    def run(self) -> Iterator[tuple[int, Any]]:
        while True:
            self._take()
            if not self.unfinished:
                return
            self._start_workers()
            self._hand_out()
            if self.draining and all(worker.task is None for worker in self.workers):
                return
            results = [result for worker in self._talking() for result in self._hear(worker)]
            # whoever just finished gets its next task before the caller spends time on the results
            self._take()
            self._hand_out()
            yield from results

    def close(self) -> None:
        for worker in self.workers:
            if worker.ready and worker.task is None:
                worker.stop()
            else:
                worker.kill()
        self.workers.clear()

    def _take(self) -> None:
        """Take tasks from the iterable while the window has room and there are some."""
        while not self.exhausted and not self.draining and self.taken < self._oldest() + WINDOW_PER_WORKER * self.limit:
            try:
                task = next(self.tasks)
            except StopIteration:
                self.exhausted = True
                return
            if task is None:
                return
            self.unfinished[self.taken] = task
            self.waiting.append(self.taken)
            self.taken += 1

    def _oldest(self) -> int:
        return min(self.unfinished, default=self.taken)

    def _start_workers(self) -> None:
        while len(self.workers) < min(self.limit, len(self.unfinished)):
            self.workers.append(Worker(self.function))

    def _hand_out(self) -> None:
        for worker in self.workers:
            if worker.ready and worker.task is None and self.waiting and not self.draining:
                self._give(worker, self.waiting.popleft())

    def _give(self, worker: Worker, index: int) -> None:
        worker.task = index
        # one that died while idle: reading from it will show that, and brings the task back
        with contextlib.suppress(OSError):
            worker.connection.send(self.unfinished[index])

    def _talking(self) -> list[Worker]:
        ready = set(wait([worker.connection for worker in self.workers]))
        return [worker for worker in self.workers if worker.connection in ready]

    def _hear(self, worker: Worker) -> Iterator[tuple[int, Any]]:
        try:
            kind, content = worker.connection.recv()
        except (EOFError, OSError):
            self._bury(worker)
            return
        if kind == READY:
            worker.ready, self.failed_starts = True, 0
            return
        index, worker.task = worker.task, None
        assert index is not None  # a worker only answers tasks
        task = self.unfinished.pop(index)
        if kind == RAISED:
            raise task_error(task, content)
        assert kind == DONE
        if isinstance(content, Unfinished):
            self._go_on(worker, index, content.rest)
        yield index, content

    def _go_on(self, worker: Worker, index: int, rest: Any) -> None:
        """Give a worker the rest of its task, for which it still has what it made for the first part."""
        self.unfinished[index] = rest
        self.losses.pop(index, None)
        if not self.draining:
            self._give(worker, index)

    def _bury(self, worker: Worker) -> None:
        """Remove a dead worker and queue its task again."""
        self.workers.remove(worker)
        exit_code = worker.kill()
        if not worker.ready:
            self._count_failed_start(exit_code)
        if worker.task is None:
            return
        losses = self.losses[worker.task] = self.losses.get(worker.task, 0) + 1
        if losses >= TASK_ATTEMPTS:
            raise EngineError(
                f"{self.unfinished[worker.task]} was lost {losses} times because its worker died "
                f"({_death(exit_code)}); what is committed stays: "
                "try again with fewer workers, or with one, to see where it stops"
            )
        self.waiting.appendleft(worker.task)

    def _count_failed_start(self, exit_code: int | None) -> None:
        self.failed_starts += 1
        if self.failed_starts >= START_ATTEMPTS:
            raise EngineError(
                f"{self.failed_starts} workers died while starting ({_death(exit_code)}); in a script of your own, "
                'call siggen below `if __name__ == "__main__":`, since workers import the script'
            )


def _death(exit_code: int | None) -> str:
    if exit_code == OUT_OF_MEMORY:
        return "out of memory"
    if exit_code is None or exit_code >= 0:
        return f"exit code {exit_code}"
    hint = ", usually out of memory" if exit_code == -9 else ""
    return f"signal {-exit_code}{hint}"
