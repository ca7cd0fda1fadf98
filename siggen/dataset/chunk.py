"""The engine's unit of work: records of one specimen, simulated into Arrow bytes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.column import Column
from siggen.columns.internals import internals_batch
from siggen.columns.record import Record, RecordFailure, non_finite, record_batch
from siggen.errors import EngineError
from siggen.stage_times import collected, stage

if TYPE_CHECKING:
    from siggen.config import Config

Simulate = Callable[["Config", Sequence[int]], Sequence[Record | RecordFailure]]
"""(config, ids of one specimen's records) -> results in the same order, as `simulate_specimen` of siggen.record."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """Records of one specimen to simulate in one go."""

    shard: str
    records: range

    def __str__(self) -> str:
        return f"records {self.records[0]} to {self.records[-1]} of shard {self.shard}"


@dataclass(frozen=True, slots=True)
class ChunkResult:
    """Rows as an Arrow IPC stream, the records that failed, and the internal quantities of a set that stores some.

    `cpu_s` is the CPU time that the chunk took, by stage.
    """

    rows: bytes
    failures: tuple[RecordFailure, ...]
    internals: bytes | None = None
    cpu_s: Mapping[str, float] = field(default_factory=dict, compare=False)

    def batch(self) -> pa.RecordBatch:
        """Return the rows without copying them; there may be none."""
        return _batch(self.rows)

    def internals_batch(self) -> pa.RecordBatch | None:
        """Return the rows of internal quantities, or None in a set without them."""
        return None if self.internals is None else _batch(self.internals)


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
    """The function that an engine maps over chunks; carries the configuration to the workers once."""

    config: Config
    simulate: Simulate
    quantities: tuple[Column, ...] = ()

    def __call__(self, chunk: Chunk) -> ChunkResult:
        """Simulate a chunk.

        Raises
        ------
        EngineError
            If the simulation raises anything but MemoryError; names the record. A failure of the solver is a result.
        """
        with collected("other") as times:
            rows, failures, internals = self._made(chunk)
        return ChunkResult(rows, failures, internals, times.seconds)

    def _made(self, chunk: Chunk) -> tuple[bytes, tuple[RecordFailure, ...], bytes | None]:
        records: list[Record] = []
        failures: list[RecordFailure] = []
        for result in self._simulated(chunk.records):
            if isinstance(result, RecordFailure):
                failures.append(result)
            elif reason := non_finite(result):
                failures.append(RecordFailure(result.planned.record_id, "not_finite", reason))
            else:
                records.append(result)
        with stage("rows"):
            rows = _stream(record_batch(self.config, records))
            if not self.quantities:
                return rows, tuple(failures), None
            return rows, tuple(failures), _stream(internals_batch(self.config, self.quantities, records))

    def _simulated(self, ids: range) -> Sequence[Record | RecordFailure]:
        try:
            results = self.simulate(self.config, ids)
        except MemoryError:
            raise
        except Exception as error:
            raise EngineError(f"{self._culprit(ids)} raised {error!r}, which is a fault of the program") from error
        received = [r.record_id if isinstance(r, RecordFailure) else r.planned.record_id for r in results]
        if received != list(ids):
            raise EngineError(f"the simulation of records {list(ids)} returned records {received}")
        return results

    def _culprit(self, ids: range) -> str:
        """Return the first record that raises when simulated alone."""
        for record_id in ids:
            try:
                self.simulate(self.config, [record_id])
            except Exception:
                return f"record {record_id}"
        return f"one of the records {ids[0]} to {ids[-1]} (none of them alone)"


def _batch(rows: bytes) -> pa.RecordBatch:
    with pa.ipc.open_stream(pa.py_buffer(rows)) as stream:
        return stream.read_next_batch()


def _stream(batch: pa.RecordBatch) -> bytes:
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, batch.schema) as writer:
        writer.write_batch(batch)
    return bytes(sink.getvalue().to_pybytes())
