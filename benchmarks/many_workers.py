"""A million records on 1 to 10,000 workers of virtual time: where a set stops gaining from more of them.

The driver is real: plan, stretches, window, answers and the close of the set run as in any run, and the clock advances
by the CPU time that they take. Workers are made up: they are busy for as long as records and files were measured to
take, each at a pace of its own, and tasks reach them as the engine of a cluster hands them out.
"""

from __future__ import annotations

import tempfile
import time
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, field
from heapq import heappop, heappush
from pathlib import Path
from random import Random
from typing import Any

from benchmarks.driver_memory import PER_GEARBOX, made_up, made_up_sidecar
from benchmarks.row import Row, duration_text
from siggen.dataset.storage import LocalFolder
from siggen.engines.protocol import Unfinished
from siggen.engines.serial import SerialEngine
from siggen.engines.window import windowed
from siggen.sets.interruption import Interruption
from siggen.sets.set_run import SetRun, set_run
from siggen.sets.shard_work import PART_S, Answer, Closing, ShardWork, Stretch

RECORDS = 1_000_000
WORKERS = (1, 10, 75, 300, 1_000, 3_000, 10_000)
GOAL_WORKERS, GOAL_BUSY = 1_000, 0.9

RECORD_S, FILES_S = 0.28, 0.0085
"""Of a worker per record of quickstart: simulation (`benchmarks engines`); file, hashes and excerpt, in its closing."""

HAND_OVER_S = 2e-3
"""Of the driver for a task and for its answer, beside its own code (assumed)."""

PACES = (0.8, 1.2)
"""Processors of a cluster are not alike (assumed)."""


@dataclass(slots=True)
class Cluster:
    """An engine of virtual time; its workers take the task with the lowest position.

    Attributes
    ----------
    now_s
        Clock of the driver.
    busy_s
        Of all workers together.
    """

    workers: int
    now_s: float = 0.0
    busy_s: float = 0.0
    _left_s: float = 0.0
    _handed: int = 0
    _queue: list[tuple[int, int]] = field(default_factory=list)
    _tasks: dict[int, Any] = field(default_factory=dict)
    _answers: dict[int, Any] = field(default_factory=dict)
    _running: list[tuple[float, int, int]] = field(default_factory=list)
    _idle: list[int] = field(default_factory=list)
    _paces: list[float] = field(default_factory=list)
    _done: list[int] = field(default_factory=list)
    _work: ShardWork | None = None

    def __post_init__(self) -> None:
        chance = Random("paces")
        self._paces = [chance.uniform(*PACES) for _ in range(self.workers)]
        self._idle = list(range(self.workers))

    def drain(self) -> None:
        """Be an engine that hands in the rest of a task; nobody interrupts it."""

    def map(self, function: Callable[[Any], Any], tasks: Iterable[Any]) -> Iterator[tuple[int, Any]]:
        """Yield answers as they would come."""
        self._work = function  # type: ignore[assignment]
        self._left_s = time.process_time()
        yield from windowed(tasks, self.workers, self._submit, self._finished, lambda one, _: self._answers.pop(one))

    def _submit(self, task: Any, position: int) -> int:
        self._enter()
        self.now_s += HAND_OVER_S
        self._until(self.now_s)
        self._handed += 1
        self._tasks[self._handed] = task
        heappush(self._queue, (position, self._handed))
        self._start(self.now_s)
        self._left_s = time.process_time()
        return self._handed

    def _finished(self, _: Collection[Any]) -> list[int]:
        self._enter()
        if not self._done:
            self._until(self.now_s)
        if not self._done:
            self.now_s = self._running[0][0]
            self._until(self.now_s)
        found, self._done = self._done, []
        self.now_s += HAND_OVER_S * len(found)
        self._left_s = time.process_time()
        return found

    def _enter(self) -> None:
        """Let the clock advance by what the driver did since it was here."""
        self.now_s += time.process_time() - self._left_s

    def _until(self, now_s: float) -> None:
        while self._running and self._running[0][0] <= now_s:
            end_s, number, worker = heappop(self._running)
            self._done.append(number)
            self._idle.append(worker)
            self._start(end_s)

    def _start(self, now_s: float) -> None:
        while self._queue and self._idle:
            (_, number), worker = heappop(self._queue), self._idle.pop()
            seconds, self._answers[number] = self._answer(self._tasks.pop(number), worker)
            self.busy_s += seconds
            heappush(self._running, (now_s + seconds, number, worker))

    def _answer(self, task: Stretch | Closing, worker: int) -> tuple[float, Answer | Unfinished[Any, Answer]]:
        """Return how long a worker has to do with a task, or with the part of it that fits, and its answer."""
        assert self._work is not None
        shard, name = task.shard, str(worker)
        if isinstance(task, Closing):
            sidecar = made_up_sidecar(self._work, shard, 0).without_bulk((), ())
            return FILES_S * shard.record_count * self._paces[worker], Answer(shard.key, worker=name, sidecar=sidecar)
        rest, records, seconds = deque(task.chunks), 0, 0.0
        while rest and seconds < PART_S:
            records += len(rest.popleft().records)
            seconds = RECORD_S * records * self._paces[worker]
        answer = Answer(shard.key, records, worker=name)
        if rest:
            return seconds, Unfinished(answer, Stretch(shard, tuple(rest)))
        if task.is_whole:
            sidecar = made_up_sidecar(self._work, shard, 0).without_bulk((), ())
            files_s = FILES_S * records * self._paces[worker]
            return seconds + files_s, Answer(shard.key, records, worker=name, sidecar=sidecar)
        return seconds, answer


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row per number of workers; `quick` has a tenth of the records."""
    records = RECORDS // 10 if quick else RECORDS
    close_s = _closing_s(records)
    yield Row(f"{records:,} records: tables, index, card and manifest, by the driver", duration_text(close_s))
    for workers in WORKERS:
        cluster = Cluster(workers)
        with tempfile.TemporaryDirectory() as name, Interruption() as interruption:
            run = _run(records, Path(name), cluster, interruption)
            run.make(run.planned)
            assert (run.made, len(run.sidecars)) == (records, len(run.planned))
        whole_s = cluster.now_s + close_s
        busy = cluster.busy_s / (workers * whole_s)
        is_goal = workers == GOAL_WORKERS and not quick
        yield Row(
            f"{records:,} records, {workers:,} workers of virtual time",
            f"{100 * busy:.1f} % busy, {_long(whole_s)}",
            f"in no time of the driver: {_long(cluster.busy_s / workers)}",
            None,
            f">= {100 * GOAL_BUSY:.0f} %" if is_goal else "",
            busy >= GOAL_BUSY if is_goal else None,
            {"workers": workers, "busy": busy, "seconds": whole_s},
        )


def _closing_s(records: int) -> float:
    """Return the driver's CPU time for the close of a set whose shards and excerpts are there."""
    with tempfile.TemporaryDirectory() as name, Interruption() as interruption:
        run = _run(records, Path(name), SerialEngine(), interruption)
        with made_up(run.config):
            taken_over = run.make(run.planned)
            begun_s = time.process_time()
            run.conclude(taken_over)
            return time.process_time() - begun_s


def _run(records: int, folder: Path, engine: Any, interruption: Interruption) -> SetRun:
    import siggen

    config = siggen.load_config("quickstart", [f"specimens={records // PER_GEARBOX}"])
    return set_run(config, LocalFolder(folder), engine, None, interruption)


def _long(seconds: float) -> str:
    return f"{seconds / 3600:.1f} h" if seconds >= 3600 else duration_text(seconds)
