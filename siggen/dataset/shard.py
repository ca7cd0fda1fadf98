"""Parquet files of a set: written row group by row group, with encodings that are checked in the footer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from siggen.dataset.checked_file import checksums
from siggen.dataset.storage import Storage
from siggen.errors import DatasetError, counted

LIST_LEAF = ".list.element"
"""What Parquet appends to a list column; an encoding asked for without it is accepted and ignored."""

ZSTD_LEVEL = 1
SPLIT_BYTES = "BYTE_STREAM_SPLIT"


@dataclass(frozen=True, slots=True)
class FileFacts:
    """What a committed file promises; `crc32_per_64_kib` are the checksums of its blocks (`checked_file`)."""

    name: str
    bytes: int
    sha256: str
    crc32_per_64_kib: str
    rows: int


class TableFile:
    """One Parquet object with `group_rows` rows per row group, written batch by batch.

    At most one row group and one batch are in memory. The bytes depend on the rows alone, not on how the batches
    cut them.
    """

    def __init__(self, draft: Path, name: str, schema: pa.Schema, group_rows: int) -> None:
        self._path, self._name, self._schema, self._group_rows = draft, name, schema, group_rows
        self._pending = schema.empty_table()
        self._rows = 0
        self._writer = pq.ParquetWriter(draft, schema, **_options(schema))

    def add(self, batch: pa.RecordBatch) -> None:
        """Write the row groups that a batch completes."""
        self._pending = pa.concat_tables([self._pending, pa.Table.from_batches([batch], self._schema)])
        while self._pending.num_rows >= self._group_rows:
            self._write(self._pending.slice(0, self._group_rows))
            self._pending = self._pending.slice(self._group_rows)

    def finish(self) -> FileFacts:
        """Write the rest and return what the file holds.

        Raises
        ------
        DatasetError
            If the footer is not what was asked for.
        """
        if self._pending.num_rows:
            self._write(self._pending)
        self.close()
        check_footer(self._path, self._schema, self._rows)
        with self._path.open("rb") as file:
            return FileFacts(self._name, self._path.stat().st_size, *checksums(file), self._rows)

    def close(self) -> None:
        """Close the file, whole or not."""
        self._writer.close()

    def _write(self, group: pa.Table) -> None:
        # one contiguous piece: page borders would otherwise follow the borders of the batches
        self._writer.write_table(group.combine_chunks(), row_group_size=self._group_rows)
        self._rows += group.num_rows


@contextmanager
def table_draft(storage: Storage, name: str, schema: pa.Schema, group_rows: int) -> Iterator[TableFile]:
    """Give a table to fill and finish; nothing is committed if the block raises."""
    with storage.draft(name) as path, closing(TableFile(path, name, schema, group_rows)) as table:
        yield table


def write_table(
    storage: Storage, name: str, schema: pa.Schema, batches: Iterable[pa.RecordBatch], group_rows: int
) -> FileFacts:
    """Write batches as one Parquet object, see `TableFile`.

    Nothing is committed if the batches raise, or if the footer shows other encodings than asked for.

    Raises
    ------
    DatasetError
        If the footer is not what was asked for.
    """
    with table_draft(storage, name, schema, group_rows) as table:
        for batch in batches:
            table.add(batch)
        return table.finish()


def _options(schema: pa.Schema) -> dict[str, object]:
    leaves = {field.name: leaf(field) for field in schema}
    numeric_lists = [leaves[field.name] for field in schema if _is_series(field)]
    return {
        "compression": "zstd",
        "compression_level": ZSTD_LEVEL,
        "use_dictionary": [leaves[field.name] for field in schema if pa.types.is_string(field.type)],
        "column_encoding": dict.fromkeys(numeric_lists, SPLIT_BYTES),
        "write_statistics": [leaves[field.name] for field in schema if not _is_series(field)],
        "write_page_index": True,
        "write_page_checksum": True,
    }


def leaf(field: pa.Field) -> str:
    """Return the path of the values of a column in Parquet."""
    name: str = field.name
    return name + LIST_LEAF if isinstance(field.type, pa.ListType | pa.FixedSizeListType) else name


def _is_series(field: pa.Field) -> bool:
    """Tell whether a column holds series of floating-point numbers: signals, pulse times, outlines."""
    is_list = isinstance(field.type, pa.ListType | pa.FixedSizeListType)
    return is_list and pa.types.is_floating(field.type.value_type)


def check_footer(path: Path, schema: pa.Schema, rows: int) -> None:
    """Read a file's footer back and compare rows, encodings, compression and statistics with what was asked for.

    Raises
    ------
    DatasetError
        If the writer ignored an option, as it silently does for paths it does not know.
    """
    footer = pq.read_metadata(path)
    problems = [] if footer.num_rows == rows else [f"{counted(footer.num_rows, 'row')} instead of {rows}"]
    series = {leaf(field) for field in schema if _is_series(field)}
    for group in range(footer.num_row_groups):
        for index in range(footer.num_columns):
            column = footer.row_group(group).column(index)
            problems += [f"row group {group}, {column.path_in_schema}: {p}" for p in _column_problems(column, series)]
    if problems:
        raise DatasetError(
            f"{path}: the Parquet writer did not do as asked ({'; '.join(problems[:3])}); another pyarrow?"
        )


def _column_problems(column: pq.ColumnChunkMetaData, series: set[str]) -> list[str]:
    is_series = column.path_in_schema in series
    problems = []
    if is_series and column.num_values and (SPLIT_BYTES not in column.encodings or "PLAIN" in column.encodings):
        problems.append(f"encodings {column.encodings}")
    if is_series and column.has_dictionary_page:
        problems.append("has a dictionary")
    if column.compression != "ZSTD":
        problems.append(f"compression {column.compression}")
    if is_series == column.is_stats_set:
        problems.append("statistics" if is_series else "no statistics")
    if not column.has_offset_index:
        problems.append("no page index")
    return problems
