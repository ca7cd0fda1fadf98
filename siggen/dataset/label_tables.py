"""metadata/, damage/ and life/: the small tables of a set, written from the excerpts of its shards."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import ExitStack

from siggen.columns.record import SetColumns
from siggen.dataset.excerpt import Excerpt, excerpt_schemas
from siggen.dataset.shard import FileFacts, table_draft
from siggen.dataset.storage import Storage

GROUP_ROWS = 4096
"""Rows per row group; a few MB of labels or outlines."""


def write_tables(storage: Storage, columns: SetColumns, split: str, excerpts: Iterable[Excerpt]) -> list[FileFacts]:
    """Write the tables of a split: labels, damage of every record, lives of every gearbox of a set that has them.

    Parameters
    ----------
    excerpts : iterable of Excerpt
        Of all shards of the split, in their order.
    """
    with ExitStack() as stack:
        tables = {
            folder: stack.enter_context(table_draft(storage, f"{folder}/{split}.parquet", schema, GROUP_ROWS))
            for folder, schema in excerpt_schemas(columns).items()
        }
        for excerpt in excerpts:
            for folder, table in tables.items():
                table.add(excerpt[folder])
        return [table.finish() for table in tables.values()]
