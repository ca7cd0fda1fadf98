"""A stranger's file of predictions, read in the process apart: within bounds, and only columns that a task can take."""

from __future__ import annotations

import re
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import csv, ipc, parquet

from siggen.errors import UsageError, counted

MOST_VALUES, MOST_TEXT_BYTES = 20_000_000, 100_000_000
"""Of a table, many times what a set has records and classifiers have columns; a small file can claim any number."""

BATCH_ROWS = 65_536
TABLE = "table.arrow"


def keep_table(path: Path, folder: Path) -> None:
    """Leave the table of a file in a folder.

    Raises
    ------
    UsageError
        If it cannot be read, or claims to be larger than any predictions are.
    """
    if not path.exists():
        raise UsageError(f"{path}: no such file; allowed are .parquet and .csv")
    pa.set_memory_pool(pa.system_memory_pool())  # others reserve more than the limit of this process
    try:
        table = csv.read_csv(path) if path.suffix.lower() == ".csv" else _parquet(path)
        table.validate(full=True)
        _check_size(path, table.num_rows, table.num_columns)
        with pa.OSFile(str(folder / TABLE), "wb") as sink, ipc.new_file(sink, table.schema) as writer:
            writer.write_table(table)
    except UsageError:
        raise
    except Exception as error:  # a damaged file finds every way out of a parser that there is
        raise UsageError(f"{path}: {_unreadable(path, str(error))}") from error


def _unreadable(path: Path, said: str) -> str:
    """Return what is wrong with a file that is no table, and what is allowed; `said`: what the parser says."""
    if not path.stat().st_size:
        return "is empty (0 bytes); allowed: a row per record, with record_id and the columns of a task"
    if "UTF" in said:
        return "holds a text that is not UTF-8; save it as UTF-8"
    if path.suffix.lower() != ".csv":
        return "is no Parquet file, or a damaged one; allowed are .parquet and .csv"
    line = re.search(r"Expected (\d+) columns, got (\d+)(?:: (.{,80}))?", said)
    found = f"; received {line[2]} values under {line[1]} names{f': {line[3]}' if line[3] else ''}" if line else ""
    return f"is no table{found}; allowed: names in the first line, and a line per record with a value for each name"


def kept_table(folder: Path) -> pa.Table:
    """Return the table that was left in a folder."""
    with pa.OSFile(str(folder / TABLE), "rb") as source:
        return ipc.open_file(source).read_all()


def _parquet(path: Path) -> pa.Table:
    """Return the table, batch by batch; texts stay apart until their length is known, nested columns become empty."""
    file = parquet.ParquetFile(path)
    schema = file.schema_arrow
    _check_size(path, file.metadata.num_rows, file.metadata.num_columns)
    if len(set(schema.names)) < len(schema.names):
        return schema.empty_table()  # whoever asks refuses doubled names
    texts = [field.name for field in schema if _is_text(field.type)]
    flat = [field.name for field in schema if pa.types.is_primitive(field.type) or field.name in texts]
    batches, rows = [], 0
    for batch in parquet.ParquetFile(path, read_dictionary=texts).iter_batches(BATCH_ROWS, columns=flat):
        batches.append(batch)
        rows += batch.num_rows
        _check_size(path, rows, len(flat))
    found = pa.Table.from_batches(batches) if batches else schema.empty_table().select(flat)
    columns = {name: found[name] for name in flat}
    columns |= {name: _text(path, name, column) for name, column in columns.items() if name in texts}
    ordered = {name: columns.get(name, pa.nulls(found.num_rows)) for name in schema.names}
    return pa.table(ordered).replace_schema_metadata(schema.metadata)


def _is_text(kind: pa.DataType) -> bool:
    own = kind.value_type if pa.types.is_dictionary(kind) else kind
    return bool(pa.types.is_string(own) or pa.types.is_large_string(own))


def _text(path: Path, name: str, column: pa.ChunkedArray) -> pa.ChunkedArray:
    """Return a column of texts, if all of them together are no longer than any names are."""
    total = 0
    for chunk in column.chunks:
        if isinstance(chunk, pa.DictionaryArray):
            total += pc.sum(pc.take(pc.binary_length(chunk.dictionary), chunk.indices)).as_py() or 0
            if total > MOST_TEXT_BYTES:
                raise UsageError(f"{path}: the texts of the column {name[:60]} are longer than any names")
    return column.cast(pa.string())


def _check_size(path: Path, rows: int, columns: int) -> None:
    if rows * max(columns, 1) > MOST_VALUES:
        raise UsageError(
            f"{path}: {counted(rows, 'row')} of {counted(columns, 'column')}; allowed: {MOST_VALUES} values together"
        )
