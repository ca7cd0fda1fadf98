"""The engine's unit of work: records of one specimen, simulated into Arrow bytes."""

from __future__ import annotations

import math
import os
import platform
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pyarrow as pa

from siggen.columns.internals import internals_batch
from siggen.columns.record import RecordFailure, SetColumns, SimulatedRecord, non_finite, record_batch
from siggen.errors import EngineError
from siggen.record.stage_times import collected, stage

Simulate = Callable[[Sequence[int]], Iterable[SimulatedRecord | RecordFailure]]
"""Ids of one specimen's records -> results in the same order, as `siggen.sets.drawn.simulated`."""

_PAUSED: dict[Any, Iterator[SimulatedRecord | RecordFailure]] = {}
"""The simulation of this process whose rest is to come, with the tables of its specimen; one at most."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """Records of one specimen to simulate in one go."""

    shard: str
    records: range

    def rest(self, done: Chunk) -> Chunk | None:
        """Return what a part from the first record on leaves; None where it is the whole."""
        return Chunk(self.shard, range(done.records.stop, self.records.stop)) if done != self else None

    def __str__(self) -> str:
        return f"records {self.records[0]} to {self.records[-1]} of shard {self.shard}"


@dataclass(frozen=True, slots=True)
class ChunkResult:
    """Rows as an Arrow IPC stream, the records that failed, and the internal quantities of a set that stores some.

    Attributes
    ----------
    chunk
        The records that were simulated.
    cpu_s
        CPU time that they took, by stage.
    worker
        The process that made them, as host and number.
    """

    chunk: Chunk
    rows: bytes
    failures: tuple[RecordFailure, ...]
    internals: bytes | None = None
    cpu_s: Mapping[str, float] = field(default_factory=dict, compare=False)
    worker: str = field(default="", compare=False)

    def batch(self) -> pa.RecordBatch:
        """Return the rows without copying them; there may be none."""
        return unpacked_batch(self.rows)

    def internals_batch(self) -> pa.RecordBatch | None:
        """Return the rows of internal quantities, or None in a set without them."""
        return None if self.internals is None else unpacked_batch(self.internals)


def chunks(shard: str, specimens: Sequence[range], group_rows: int) -> Iterator[Chunk]:
    """Cut a shard, given as the record ids of each specimen, into chunks.

    Specimens stay whole, since stiffness tables are built once per specimen and state, unless they fill more than two
    row groups: a chunk must fit into memory several times over.
    """
    for ids in specimens:
        size = len(ids) if len(ids) <= 2 * group_rows else group_rows
        yield from (Chunk(shard, ids[start : start + size]) for start in range(0, len(ids), size))


@dataclass(frozen=True, slots=True)
class ChunkSimulation:
    """The function that an engine maps over chunks; carries to the workers once what simulates a set."""

    columns: SetColumns
    simulate: Simulate

    def __call__(self, chunk: Chunk) -> ChunkResult:
        """Simulate a chunk; `part` without a limit."""
        return self.part(chunk, math.inf)

    def part(self, chunk: Chunk, limit_s: float) -> ChunkResult:
        """Simulate a chunk from its first record on, until a time has passed; at least one record.

        Raises
        ------
        EngineError
            If the simulation raises anything but MemoryError; names the record. A failure of the solver is a result.
        """
        until_s = time.monotonic() + limit_s
        with collected("other") as times:
            done, records, failures = self._simulated(chunk, until_s)
            with stage("rows"):
                rows, columns = packed_batch(record_batch(self.columns, records)), self.columns
                internals = packed_batch(internals_batch(columns, records)) if columns.quantities else None
        return ChunkResult(done, rows, tuple(failures), internals, times.seconds, f"{platform.node()} {os.getpid()}")

    def _simulated(self, chunk: Chunk, until_s: float) -> tuple[Chunk, list[SimulatedRecord], list[RecordFailure]]:
        records: list[SimulatedRecord] = []
        failures: list[RecordFailure] = []
        results = self._begun(chunk)
        for record_id in chunk.records:
            result = self._next(results, range(record_id, chunk.records.stop))
            if isinstance(result, RecordFailure):
                failures.append(result)
            elif reason := non_finite(result):
                failures.append(RecordFailure(record_id, "not_finite", reason))
            else:
                records.append(result)
            if time.monotonic() >= until_s:
                break
        done = Chunk(chunk.shard, range(chunk.records.start, record_id + 1))
        if rest := chunk.rest(done):
            _PAUSED[self._key(rest)] = results
        return done, records, failures

    def _begun(self, chunk: Chunk) -> Iterator[SimulatedRecord | RecordFailure]:
        """Go on with a simulation that was paused here, or begin one."""
        paused = _PAUSED.pop(self._key(chunk), None)
        _PAUSED.clear()
        return self._results(chunk.records) if paused is None else paused

    def _key(self, chunk: Chunk) -> tuple[object, ...]:
        return self.columns.identity, chunk.records

    def _results(self, ids: range) -> Iterator[SimulatedRecord | RecordFailure]:
        yield from self.simulate(ids)

    def _next(self, results: Iterator[SimulatedRecord | RecordFailure], ids: range) -> SimulatedRecord | RecordFailure:
        """Return the result of the first of the records that are left."""
        try:
            result = next(results, None)
        except MemoryError:
            raise
        except Exception as error:
            raise EngineError(f"{self._culprit(ids)} raised {error!r}, which is a fault of the program") from error
        if result is None:
            raise EngineError(f"the simulation of record {ids[0]} returned nothing")
        received = result.record_id if isinstance(result, RecordFailure) else result.planned.record_id
        if received != ids[0]:
            raise EngineError(f"the simulation of record {ids[0]} returned record {received}")
        return result

    def _culprit(self, ids: range) -> str:
        """Return the first record that raises when simulated alone."""
        for record_id in ids:
            try:
                list(self.simulate([record_id]))
            except Exception:
                return f"record {record_id}"
        return f"one of the records {ids[0]} to {ids[-1]} (none of them alone)"


def unpacked_batch(rows: bytes) -> pa.RecordBatch:
    """Return the rows of an Arrow stream of one batch, without copying them."""
    with pa.ipc.open_stream(pa.py_buffer(rows)) as stream:
        return stream.read_next_batch()


def packed_batch(batch: pa.RecordBatch) -> bytes:
    """Return an Arrow stream of one batch."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, batch.schema) as writer:
        writer.write_batch(batch)
    return bytes(sink.getvalue().to_pybytes())
