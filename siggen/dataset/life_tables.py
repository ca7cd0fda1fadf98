"""life/: tables of gearboxes that run to failure, beside damage/; derived from the configuration alone."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.life_columns import LIFE_TABLES, NULLABLE
from siggen.columns.record import schema_metadata
from siggen.dataset.manifest import LIFE_FOLDER
from siggen.dataset.shard import FileFacts, write_table
from siggen.dataset.sidecar import Sidecar
from siggen.dataset.storage import Storage

if TYPE_CHECKING:
    from siggen.config import Config

LifeRows = Callable[["Config", int], Mapping[str, Sequence[Mapping[str, object]]]]
"""(config, specimen) -> rows by the name of their table, as siggen.record gives them."""

GROUP_ROWS = 4096
"""Rows per row group."""


def write_life(
    storage: Storage, config: Config, split: str, sidecars: Sequence[Sidecar], life_rows: LifeRows
) -> list[FileFacts]:
    """Write all tables of the gearboxes of a split; none for a set of states."""
    if config.life is None:
        return []
    specimens = [i for one in sidecars for first, last in one.specimens for i in range(first, last + 1)]
    rows: dict[str, list[Mapping[str, object]]] = {name: [] for name in LIFE_TABLES}
    for specimen in specimens:
        for name, found in life_rows(config, specimen).items():
            rows[name].extend({**row, "split": split} for row in found)
    return [
        write_table(storage, f"{LIFE_FOLDER}/{name}/{split}.parquet", schema, _batches(schema, rows[name]), GROUP_ROWS)
        for name, schema in ((name, life_schema(config, name)) for name in LIFE_TABLES)
    ]


def life_schema(config: Config, table: str) -> pa.Schema:
    """Return the schema of a table of `life/`."""
    fields = [column.field().with_nullable(column.name in NULLABLE) for column in LIFE_TABLES[table]]
    return pa.schema(fields, metadata=schema_metadata(config))


def _batches(schema: pa.Schema, rows: Sequence[Mapping[str, object]]) -> list[pa.RecordBatch]:
    return [pa.RecordBatch.from_pylist(list(rows), schema=schema)] if rows else []
