"""metadata/ and damage/: the small tables of a set, derived from its finished shards."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.record import damage_schema, label_schema
from siggen.dataset.checked_file import parquet_file
from siggen.dataset.manifest import DAMAGE_FOLDER, METADATA_FOLDER
from siggen.dataset.shard import FileFacts, write_table
from siggen.dataset.sidecar import Sidecar, read_sidecar
from siggen.dataset.storage import Storage

if TYPE_CHECKING:
    from siggen.config import Config

DamageRows = Callable[["Config", int], Sequence[Mapping[str, object]]]
"""(config, record_id) -> rows of the damage table for one record, as siggen.record gives them."""

GROUP_ROWS = 4096
"""Rows per row group; a few MB of labels or outlines."""


def write_metadata(storage: Storage, config: Config, split: str, sidecars: Sequence[Sidecar]) -> FileFacts:
    """Write the columns before the signals of all shards of a split, in the order of the shards."""
    schema = label_schema(config)
    batches = (batch for sidecar in sidecars for batch in _label_batches(storage, sidecar, schema.names))
    return write_table(storage, f"{METADATA_FOLDER}/{split}.parquet", schema, batches, GROUP_ROWS)


def write_damage(
    storage: Storage, config: Config, split: str, sidecars: Sequence[Sidecar], damage_rows: DamageRows
) -> FileFacts:
    """Write one row per single damage of every record of a split, in the order of the records."""
    schema = damage_schema(config)
    batches = (
        batch
        for sidecar in sidecars
        for labels in _label_batches(storage, sidecar, ["record_id", "specimen_id", "state_id"])
        for batch in _damage_batches(config, schema, labels.to_pylist(), damage_rows)
    )
    return write_table(storage, f"{DAMAGE_FOLDER}/{split}.parquet", schema, batches, GROUP_ROWS)


def _label_batches(storage: Storage, sidecar: Sidecar, columns: Sequence[str]) -> Iterator[pa.RecordBatch]:
    # read again, since a run does not keep the checksums of all shards
    facts = read_sidecar(storage, sidecar.shard).data
    with parquet_file(storage, facts.name, facts.crc32_per_64_kib) as file:
        yield from file.read(columns).to_batches()


def _damage_batches(
    config: Config, schema: pa.Schema, records: Sequence[Mapping[str, int]], damage_rows: DamageRows
) -> Iterator[pa.RecordBatch]:
    shared: list[Mapping[str, object]] = []
    owner: tuple[int, int] | None = None
    for record in records:
        # damage belongs to specimen and state: operating points and repeats of one state follow each other
        if owner != (record["specimen_id"], record["state_id"]):
            owner = (record["specimen_id"], record["state_id"])
            shared = list(damage_rows(config, record["record_id"]))
        if shared:
            rows = [{**row, "record_id": record["record_id"]} for row in shared]
            yield pa.RecordBatch.from_pylist(rows, schema=schema)
