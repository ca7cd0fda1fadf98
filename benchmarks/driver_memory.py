"""Peak memory of a driver that plans, cuts, hands out, takes back and closes a set, with records that are made up."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import pyarrow as pa

from siggen.dataset.checked_file import BLOCK_BYTES, DIGITS
from siggen.dataset.excerpt import Excerpt, Excerpts, excerpt_schemas
from siggen.dataset.manifest import DAMAGE_FOLDER, METADATA_FOLDER
from siggen.dataset.object_name import data_name
from siggen.dataset.shard import FileFacts
from siggen.dataset.sidecar import Sidecar, put_sidecar, ranges, read_sidecar
from siggen.planning.plan import ShardPlan, estimated_bytes
from siggen.sets import set_run
from siggen.sets.shard_work import Answer, ShardWork

if TYPE_CHECKING:
    from siggen.config import Config

PER_GEARBOX = 5
"""Records of the quickstart."""

SPALLED, DAMAGED_SHARE = 2, 10
"""A record with a spall of many corners, which one gearbox of so many shows."""

VALUES: Mapping[str, Any] = {"string": "healthy", "bool": False, "int32": 0, "int64": 0, "double": 0.0}


def peak_bytes(records: int) -> dict[str, int]:
    """Return the peak of this process when the last shard of a quickstart is done, and when its manifest is written.

    Made up are shards and their excerpts, which workers make. Plan, stretches, sidecars with as many checksums as there
    would be, tables, card and manifest are real.
    """
    import siggen
    from siggen.dataset.environment import peak_memory_bytes
    from siggen.dataset.storage import LocalFolder
    from siggen.engines.serial import SerialEngine
    from siggen.sets.interruption import Interruption

    config = siggen.load_config("quickstart", [f"specimens={records // PER_GEARBOX}"])
    with tempfile.TemporaryDirectory() as name, Interruption() as interruption, _made_up(config):
        run = set_run.set_run(config, LocalFolder(Path(name)), SerialEngine(), None, interruption)
        taken_over = run.make(run.planned)
        assert run.made == records
        done = peak_memory_bytes()["parent"]
        run.conclude(taken_over)
        return {"shards done": done, "manifest written": peak_memory_bytes()["parent"]}


@contextmanager
def _made_up(config: Config) -> Iterator[None]:
    """Put shards in place that nobody makes, each with as many blocks of a file as it would have."""
    from siggen.sets import physics

    blocks = estimated_bytes(config) // (config.specimens * config.records_per_specimen) // BLOCK_BYTES + 1
    damage = physics.physics().damage_rows(config, SPALLED)
    with (
        patch.object(ShardWork, "__call__", lambda work, task: _committed(work, task.shard, blocks)),
        patch.object(Excerpts, "read", lambda excerpts, shard: _excerpt(excerpts, shard, damage)),
    ):
        yield


def _committed(work: ShardWork, shard: ShardPlan, blocks: int) -> Answer:
    """Commit a shard whose file is not there."""
    count = shard.record_count
    specimens, records = ranges(shard)
    checksums = "0" * (DIGITS * blocks * count)
    sidecar = Sidecar(
        shard=shard.key,
        split=shard.split,
        identity=work.pieces.maker.identity,
        data=FileFacts(data_name(shard.key), 0, "0" * 64, checksums, count),
        specimens=specimens,
        records=records,
        rows_per_state=dict.fromkeys(work.simulation.config.state_names, count // PER_GEARBOX),
        failures=(),
        environment=work.pieces.maker.environment,
    )
    put_sidecar(work.pieces.storage, sidecar)
    return Answer(shard.key, count, sidecar=sidecar.without_bulk((), ()))


def _excerpt(excerpts: Excerpts, shard: str, damage: Sequence[Mapping[str, object]]) -> Excerpt:
    """Return the rows of a shard: ids are right, all else is the same everywhere; one gearbox of ten shows a spall."""
    records = read_sidecar(excerpts.storage, shard).records
    ids = [i for first, last in records for i in range(first, last + 1)]
    own = {"record_id": ids, "specimen_id": [i // PER_GEARBOX for i in ids], "state_id": [i % PER_GEARBOX for i in ids]}
    schemas = excerpt_schemas(excerpts.config)
    fields = schemas[METADATA_FOLDER]
    arrays = [pa.array(own.get(f.name) or [VALUES.get(str(f.type), [])] * len(ids), f.type) for f in fields]
    spalled = [i for i in ids if i // PER_GEARBOX % DAMAGED_SHARE == 0]
    rows = [{**row, "record_id": i} for i in spalled for row in damage]
    return {
        METADATA_FOLDER: pa.RecordBatch.from_arrays(arrays, schema=fields),
        DAMAGE_FOLDER: pa.RecordBatch.from_pylist(rows, schema=schemas[DAMAGE_FOLDER]),
    }
