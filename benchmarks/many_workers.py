"""A million records on 1,000 workers of virtual time: how busy they are, and what the driver takes.

The driver is real: plan, tasks, answers and the close of the set run as in any run, and the clock advances by the CPU
time that they take. Workers are made up: they are busy for as long as records were measured to take, each at a pace of
its own. What they answer is that of a real shard, every number of it moved by chance, so that it packs as labels do.
"""

from __future__ import annotations

import heapq
import json
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any
from unittest.mock import patch

import numpy as np
import pyarrow as pa

import siggen
from benchmarks.row import Row, duration_text

RECORDS, WORKERS = 1_000_000, 1_000
GOAL_BUSY, GOAL_BYTES = 0.9, 500e6
RECORD_S = 0.54
"""Of a worker per record of quickstart, 1.5 s long (`python -m benchmarks presets`)."""
HAND_OVER_S = 2e-3
"""Of the driver for a task and for its answer, beside its own code (assumed)."""
PACES = (0.8, 1.2)
"""Processors of a cluster are not alike (assumed)."""
PER_GEARBOX = 5


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield how busy workers are, and the driver's memory; `quick` has a tenth of the records."""
    records = RECORDS // 10 if quick else RECORDS
    with tempfile.TemporaryDirectory() as name:
        one = str(Path(name) / "one")
        siggen.generate(siggen.load_config("quickstart", ["specimens=1", "duration_s=0.1"]), one, 1)
        command = [sys.executable, "-m", "benchmarks.many_workers", one, str(records), str(WORKERS)]
        found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    busy, peak = found["busy_s"] / (WORKERS * found["whole_s"]), found["bytes"]
    yield Row(
        f"{records:,} records in {found['shards']:,} shards, {WORKERS:,} workers of virtual time",
        f"{100 * busy:.1f} % busy, {duration_text(found['whole_s'])}",
        f"close of the set by the driver: {duration_text(found['close_s'])}",
        None,
        f">= {100 * GOAL_BUSY:.0f} %",
        busy >= GOAL_BUSY,
    )
    yield Row(
        "the driver's memory", f"{peak / 1e6:.0f} MB", "", None, f"<= {GOAL_BYTES / 1e6:.0f} MB", peak <= GOAL_BYTES
    )


@dataclass(slots=True)
class Cluster(Executor):
    """An executor of virtual time; it is the queue of what is done, too, where the driver waits."""

    workers: int
    answer: Callable[[Any], Any]
    now_s: float = 0.0
    busy_s: float = 0.0
    _left_s: float = field(default_factory=time.process_time)
    _number: int = 0
    _queue: deque[tuple[Future[Any], Any]] = field(default_factory=deque)
    _running: list[tuple[float, int, int, Future[Any], Any]] = field(default_factory=list)
    _idle: list[int] = field(default_factory=list)
    _paces: list[float] = field(default_factory=list)
    _done: deque[Future[Any]] = field(default_factory=deque)

    def __post_init__(self) -> None:
        chance = Random("paces")
        self._paces = [chance.uniform(*PACES) for _ in range(self.workers)]
        self._idle = list(range(self.workers))

    @contextmanager
    def opened(self) -> Iterator[Executor]:
        """Give itself."""
        yield self

    def submit(self, _function: Callable[..., Any], /, *arguments: Any, **_named: Any) -> Future[Any]:
        """Hand a task over."""
        self._advance(HAND_OVER_S)
        future: Future[Any] = Future()
        self._queue.append((future, arguments[0]))
        self._start(self.now_s)
        self._left_s = time.process_time()
        return future

    def put(self, future: Future[Any]) -> None:
        """Note what is done, as the queue of the driver."""
        self._done.append(future)

    def get(self) -> Future[Any]:
        """Return the next future that is done, once its time has come."""
        self._advance(HAND_OVER_S)
        while not self._done or (self._running and self._running[0][0] <= self.now_s):
            end_s, _, worker, future, task = heapq.heappop(self._running)
            self.now_s = max(self.now_s, end_s)
            self._idle.append(worker)
            self._start(end_s)
            future.set_result(("done", self.answer(task)))
        self._left_s = time.process_time()
        return self._done.popleft()

    def _advance(self, more_s: float) -> None:
        self.now_s += time.process_time() - self._left_s + more_s

    def _start(self, now_s: float) -> None:
        while self._queue and self._idle:
            (future, task), worker = self._queue.popleft(), self._idle.pop()
            self._number += 1
            seconds = RECORD_S * task.record_count * self._paces[worker]
            self.busy_s += seconds
            heapq.heappush(self._running, (now_s + seconds, self._number, worker, future, task))


def measured(one: Path, records: int, workers: int) -> dict[str, float]:
    """Return what a run of so many records took."""
    from benchmarks.peak_memory import peak_memory_bytes
    from siggen.dataset.storage import LocalFolder
    from siggen.sets import set_run
    from siggen.sets.interruption import Interruption
    from siggen.workers import tasks
    from siggen.workers.tasks import Workers

    with tempfile.TemporaryDirectory() as name, Interruption() as interruption:
        design = siggen.load_config("quickstart", [f"specimens={records // PER_GEARBOX}"])
        cluster = Cluster(workers, _answers(one))
        run = set_run.SetRun(design, LocalFolder(Path(name)), Workers("virtual", workers, cluster.opened), interruption)
        closing: list[float] = []

        def close(*given: Any) -> object:
            begun_s = time.process_time()
            found = put_last(*given)
            closing.append(time.process_time() - begun_s)
            return found

        put_last = set_run.put_last
        with patch.object(tasks, "SimpleQueue", lambda: cluster), patch.object(set_run, "put_last", close):
            run.run()
        facts = {"whole_s": cluster.now_s + closing[0], "close_s": closing[0], "busy_s": cluster.busy_s}
        return {**facts, "bytes": peak_memory_bytes()["parent"], "shards": len(run.planned)}


def _answers(folder: Path) -> Callable[[Any], Any]:
    """Return what makes up the answer to a task, from a set of one gearbox."""
    from siggen.dataset.object_name import DAMAGE, LABELS
    from siggen.sets.shard_making import MadeShard, _stream

    dataset = siggen.open(folder)
    tables = {LABELS: dataset.labels(), DAMAGE: dataset.damage()}
    (split,) = dataset.inventory.splits.values()
    file = dataset.files[dataset.shards()[0].file]
    chance = np.random.default_rng(0)

    def answer(shard: Any) -> Any:
        count = len(shard.specimens)
        moved = {
            name: _stream(_moved(pa.concat_tables([rows] * count), shard, chance)) for name, rows in tables.items()
        }
        states = {state: rows * count for state, rows in split.states.items()}
        files, made = {f"data/{shard.key}.parquet": file}, shard.record_count
        return MadeShard(shard.key, split.rows * count, states, (), files, made, moved)

    return answer


def _moved(table: pa.Table, shard: Any, chance: np.random.Generator) -> pa.Table:
    """Return rows with the numbers of a shard's records, and every other number moved by a part in a thousand."""
    columns = []
    for field_ in table.schema:
        column = table[field_.name]
        if field_.name == "record_id" and table.num_rows:
            ids = np.fromiter(shard.record_ids, np.int64)
            column = pa.array(np.resize(ids, table.num_rows))
        elif pa.types.is_float64(field_.type):
            values = column.to_numpy()
            column = pa.array(values * (1.0 + 1e-3 * chance.standard_normal(values.size)))
        columns.append(column)
    return pa.table(columns, schema=table.schema).combine_chunks()


if __name__ == "__main__":
    sys.stdout.write(json.dumps(measured(Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))))
