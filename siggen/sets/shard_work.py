"""What workers do for a shard: simulate stretches of it into pieces, and put the pieces together to the shard itself.

Whoever closes a shard commits it. All that it writes follows from configuration and index, and every file is there as a
whole or not at all: a task that runs twice, also at once, leaves the same files.
"""

from __future__ import annotations

import math
import os
import platform
import time
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field

from siggen.columns.internals import internals_schema
from siggen.columns.record import RecordFailure, record_schema
from siggen.dataset.chunk import Chunk, ChunkResult, ChunkSimulation, chunks
from siggen.dataset.excerpt import Excerpts
from siggen.dataset.manifest import CONFIG
from siggen.dataset.object_name import data_name, internals_name
from siggen.dataset.pieces import Pieces, ShardPieces
from siggen.dataset.shard import TableFile, table_draft
from siggen.dataset.sidecar import Sidecar, promised_shard, put_sidecar, ranges
from siggen.engines.protocol import Unfinished
from siggen.errors import DatasetError
from siggen.file_writing import UNWRITABLE
from siggen.gearbox.plan import ShardPlan
from siggen.record.stage_times import collected

PART_S = 10.0
"""A worker keeps what it has after this time, at the end of a record, and gives back the rest of its stretch."""

PART_BYTES = 64 << 20
"""The same for rows, which a worker holds in memory."""

IDLE_S = 0.05
"""Lost by an engine that hands out None; see `Engine.map`."""


@dataclass(frozen=True, slots=True)
class ChunkStretch:
    """Chunks of a shard that follow each other; `is_whole` where they are the whole shard, which is then closed."""

    shard: ShardPlan
    chunks: tuple[Chunk, ...]
    is_whole: bool = False

    @property
    def key(self) -> str:
        """Name of the shard."""
        return self.shard.key

    def __str__(self) -> str:
        return f"records {self.chunks[0].records[0]} to {self.chunks[-1].records[-1]} of shard {self.shard.key}"


@dataclass(frozen=True, slots=True)
class Closing:
    """A shard all of whose records are in pieces."""

    shard: ShardPlan

    @property
    def key(self) -> str:
        """Name of the shard."""
        return self.shard.key

    def __str__(self) -> str:
        return f"the closing of shard {self.shard.key}"


@dataclass(frozen=True, slots=True)
class Excerpting:
    """A committed shard whose excerpt is missing."""

    key: str

    def __str__(self) -> str:
        return f"the excerpt of shard {self.key}"


Task = ChunkStretch | Closing | Excerpting


@dataclass(frozen=True, slots=True)
class Answer:
    """What came of a task, without rows.

    Attributes
    ----------
    records
        Number of those that were simulated.
    failures
        Those of them that failed.
    cpu_s
        CPU time by stage.
    worker
        Host and number of the process.
    sidecar
        Of the shard, if it is committed; without its ranges, which are planned, and without checksums of blocks.
    error
        What a disk or a store said that takes or gives no more.
    """

    shard: str
    records: int = 0
    failures: tuple[RecordFailure, ...] = ()
    cpu_s: Mapping[str, float] = field(default_factory=dict)
    worker: str = ""
    sidecar: Sidecar | None = None
    error: DatasetError | OSError | None = None


@dataclass(frozen=True, slots=True)
class GroupRows:
    """Rows of a row group: of records, and of internal quantities (0 without them)."""

    records: int
    internals: int

    @property
    def of_chunk(self) -> int:
        """The fewer of both."""
        return min(self.records, self.internals or self.records)


@dataclass(frozen=True, slots=True)
class ShardWork:
    """The function that an engine maps over tasks; carries to the workers once what makes a set.

    Attributes
    ----------
    states
        Names of all that a gearbox may be in.
    group_rows
        Of the files, by the plan of whoever drives the run.
    is_parted
        Whether the engine hands in the rest of a task.
    """

    simulation: ChunkSimulation
    pieces: Pieces
    excerpts: Excerpts
    states: tuple[str, ...]
    group_rows: GroupRows
    is_parted: bool

    def __call__(self, task: Task | None) -> Answer | Unfinished[Task, Answer] | None:
        """Do a task, or the part of it that fits into `PART_S`."""
        if task is None:
            time.sleep(IDLE_S)
            return None
        try:
            self._check_place()
            return self._done(task)
        except DatasetError as error:
            return Answer(task.key, error=error)
        except OSError as error:
            if error.errno is None or error.errno not in UNWRITABLE:
                raise
            return Answer(task.key, error=OSError(error.errno, os.strerror(error.errno)))

    def _done(self, task: Task) -> Answer | Unfinished[Task, Answer]:
        if isinstance(task, ChunkStretch):
            return self._simulated(task)
        if isinstance(task, Closing):
            return self._closed(task.shard)
        with collected("files") as times:
            self.excerpts.put(task.key)
        return self._answer(task.key, (), times.seconds)

    def _check_place(self) -> None:
        storage = self.pieces.storage
        if not storage.exists(CONFIG):
            raise DatasetError(
                f"{storage.location}: the worker on {platform.node()} does not see the folder of the set, into which "
                "it has to write; name a folder that all machines of the cluster share, or s3://bucket/set"
            )

    def _simulated(self, stretch: ChunkStretch) -> Answer | Unfinished[Task, Answer]:
        results: list[ChunkResult] = []
        rest = deque(stretch.chunks)
        until_s = time.monotonic() + PART_S
        while rest and not self._is_part(results, until_s):
            chunk = rest.popleft()
            results.append(self.simulation.part(chunk, until_s - time.monotonic() if self.is_parted else math.inf))
            if (left := chunk.rest(results[-1].chunk)) is not None:
                rest.appendleft(left)
        with collected("files") as times:
            if stretch.is_whole and not rest:
                sidecar = self._committed(stretch.shard, results)
                self.excerpts.put(stretch.key)
                return self._answer(stretch.key, results, times.seconds, sidecar)
            self.pieces.put(results)
        answer = self._answer(stretch.key, results, times.seconds)
        return Unfinished(answer, ChunkStretch(stretch.shard, tuple(rest))) if rest else answer

    def _is_part(self, results: Sequence[ChunkResult], until_s: float) -> bool:
        size = sum(len(one.rows) + len(one.internals or b"") for one in results)
        return self.is_parted and bool(results) and (time.monotonic() >= until_s or size >= PART_BYTES)

    def _closed(self, shard: ShardPlan) -> Answer:
        """Commit a shard from its pieces; what is missing or damaged of them is simulated again."""
        made: list[ChunkResult] = []
        kept = self.pieces.of_shard(shard.key)
        with collected("files") as times:
            sidecar = self._found(shard) or self._committed(shard, self._results(shard, kept, made))
            self.excerpts.put(shard.key)
            kept.drop()
        return self._answer(shard.key, made, times.seconds, sidecar)

    def _found(self, shard: ShardPlan) -> Sidecar | None:
        """Return the sidecar of a task that was done, but whose worker could not say so any more."""
        maker = self.pieces.maker
        found = promised_shard(self.pieces.storage, shard.key, maker.identity, ranges(shard)[0])
        if isinstance(found, str) or found.environment != maker.environment:
            return None
        return found.without_bulk((), ())

    def _results(self, shard: ShardPlan, kept: ShardPieces, made: list[ChunkResult]) -> Iterator[ChunkResult]:
        for chunk in shard_chunks(shard, self.group_rows):
            rest: Chunk | None = chunk
            while rest is not None:
                result = kept.result(rest)
                if result is None:
                    result = self.simulation(rest)
                    made.append(result)
                yield result
                rest = rest.rest(result.chunk)

    def _answer(
        self,
        shard: str,
        made: Sequence[ChunkResult],
        files_s: Mapping[str, float],
        sidecar: Sidecar | None = None,
    ) -> Answer:
        cpu_s = dict(files_s)
        for result in made:
            for stage, seconds in result.cpu_s.items():
                cpu_s[stage] = cpu_s.get(stage, 0.0) + seconds
        records = sum(len(result.chunk.records) for result in made)
        failures = tuple(failure for result in made for failure in result.failures)
        return Answer(shard, records, failures, cpu_s, f"{platform.node()} {os.getpid()}", sidecar)

    def _committed(self, shard: ShardPlan, results: Iterable[ChunkResult]) -> Sidecar:
        """Write the rows of a shard as they come, then commit it with its sidecar."""
        failures: list[RecordFailure] = []
        rows_per_state = dict.fromkeys(self.states, 0)
        with self._data(shard) as data, self._internals(shard) as internals:
            for result in results:
                batch = result.batch()
                failures.extend(result.failures)
                for state in batch.column("state").to_pylist():
                    rows_per_state[state] += 1
                data.add(batch)
                if internals is not None and (inner := result.internals_batch()) is not None:
                    internals.add(inner)
            facts = data.finish()
            internal_facts = None if internals is None else internals.finish()
        specimens, records = ranges(shard)
        sidecar = Sidecar(
            shard=shard.key,
            split=shard.split,
            identity=self.pieces.maker.identity,
            data=facts,
            internals=internal_facts,
            specimens=specimens,
            records=records,
            rows_per_state=rows_per_state,
            failures=tuple(failures),
            environment=self.pieces.maker.environment,
        )
        put_sidecar(self.pieces.storage, sidecar)
        return sidecar.without_bulk((), ())

    def _data(self, shard: ShardPlan) -> AbstractContextManager[TableFile]:
        schema = record_schema(self.simulation.columns)
        return table_draft(self.pieces.storage, data_name(shard.key), schema, self.group_rows.records)

    def _internals(self, shard: ShardPlan) -> AbstractContextManager[TableFile | None]:
        if not self.simulation.columns.quantities:
            return nullcontext()
        schema = internals_schema(self.simulation.columns)
        return table_draft(self.pieces.storage, internals_name(shard.key), schema, self.group_rows.internals)


def shard_chunks(shard: ShardPlan, group_rows: GroupRows) -> Iterator[Chunk]:
    """Cut a shard into chunks."""
    return chunks(shard.key, [*shard.of_specimens], group_rows.of_chunk)
