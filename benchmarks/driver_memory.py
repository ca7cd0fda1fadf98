"""Peak memory of a driver that plans, cuts, hands out, takes back and closes a set, with records that are made up."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import pyarrow as pa

from siggen.columns.record import label_schema
from siggen.dataset import label_tables
from siggen.dataset.checked_file import BLOCK_BYTES, DIGITS
from siggen.dataset.chunk import Chunk, ChunkResult
from siggen.dataset.object_name import data_name
from siggen.dataset.shard import FileFacts
from siggen.planning.plan import ShardPlan, estimated_bytes
from siggen.sets import set_run, shard_making
from siggen.sets.shard_making import ShardMaking

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.dataset.sidecar import Sidecar
    from siggen.dataset.storage import Storage

PER_GEARBOX = 4
"""Records of the quickstart."""

SPALLED, DAMAGED_SHARE = 2, 10
"""A record with a spall of many corners, which one gearbox of so many shows."""

VALUES: Mapping[str, Any] = {"string": "healthy", "bool": False, "int32": 0, "int64": 0, "double": 0.0}


def peak_bytes(records: int) -> dict[str, int]:
    """Return the peak of this process when the last shard of a quickstart is done, and when its manifest is written.

    Made up are the tasks, which return nothing, the shards' files, which are not there, and what tables read from
    them. Plan, chunks, sidecars with as many checksums as there would be, tables, card and manifest are real.
    """
    import siggen
    from siggen.dataset.environment import peak_memory_bytes
    from siggen.dataset.storage import LocalFolder
    from siggen.engines.serial import SerialEngine
    from siggen.sets.interruption import Interruption

    config = siggen.load_config("quickstart", [f"specimens={records // PER_GEARBOX}"])
    with (
        tempfile.TemporaryDirectory() as name,
        Interruption() as interruption,
        _made_up(config),
    ):
        run = set_run.set_run(config, LocalFolder(Path(name)), SerialEngine(), None, interruption)
        taken_over = run.make(run.planned)
        assert run.made == records
        done = peak_memory_bytes()["parent"]
        damage = run.physics.damage_rows(config, SPALLED)
        run.physics = replace(run.physics, damage_rows=lambda _, record: [] if _is_whole(record) else damage)
        run.conclude(taken_over)
        return {"shards done": done, "manifest written": peak_memory_bytes()["parent"]}


def _is_whole(record: int) -> bool:
    return record // PER_GEARBOX % DAMAGED_SHARE != 0


@contextmanager
def _made_up(config: Config) -> Iterator[None]:
    """Put records in place that nobody simulates, each with as many blocks of a file as it would have."""
    records = config.specimens * config.records_per_specimen
    blocks = estimated_bytes(config) // records // BLOCK_BYTES + 1
    labels = partial(_labels, label_schema(config))
    nothing = pa.record_batch({"state": pa.array([], pa.string())})
    with ExitStack() as stack:
        stack.enter_context(patch.object(ChunkResult, "batch", lambda _: nothing))
        stack.enter_context(patch.object(shard_making, "PartSimulation", lambda *_: _nothing))
        stack.enter_context(patch.object(ShardMaking, "_data", lambda _, shard: _Unwritten(shard, blocks)))
        stack.enter_context(patch.object(label_tables, "_label_batches", labels))
        yield


def _nothing(chunk: Chunk) -> ChunkResult:
    return ChunkResult(chunk, b"", ())


class _Unwritten:
    """A shard's file that is not written."""

    def __init__(self, shard: ShardPlan, blocks: int) -> None:
        self._shard, self._blocks = shard, blocks

    def __enter__(self) -> _Unwritten:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def add(self, batch: pa.RecordBatch) -> None:
        """Take rows and forget them."""

    def finish(self) -> FileFacts:
        """Return facts with the checksums of a file as large as it would be."""
        count = self._shard.record_count
        checksums = "0" * (DIGITS * self._blocks * count)
        return FileFacts(data_name(self._shard.key), 0, "0" * 64, checksums, count)


def _labels(schema: pa.Schema, _: Storage, sidecar: Sidecar, columns: Sequence[str]) -> Iterator[pa.RecordBatch]:
    """Yield the labels of a shard: ids are right, all else is the same everywhere."""
    ids = [i for first, last in sidecar.records for i in range(first, last + 1)]
    own = {"record_id": ids, "specimen_id": [i // PER_GEARBOX for i in ids], "state_id": [i % PER_GEARBOX for i in ids]}
    fields = [schema.field(name) for name in columns]
    arrays = [pa.array(own.get(f.name) or [VALUES.get(str(f.type), [])] * len(ids), f.type) for f in fields]
    yield pa.RecordBatch.from_arrays(arrays, schema=pa.schema(fields))
