"""A table in a file of its own, CSV or Parquet by the file's ending: what commands write beside data sets."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet

from siggen.dataset.spreadsheet import write_csv
from siggen.errors import UsageError
from siggen.file_writing import write_file

ENDINGS = (".csv", ".parquet")


def check_table_file(path: Path) -> Path:
    """Return the path if a table can go there; call it before long work.

    Raises
    ------
    UsageError
        If the ending is unknown or the path is a folder.
    """
    if path.suffix.lower() not in ENDINGS:
        raise UsageError(f"{path}: received the ending {path.suffix!r}; allowed are {', '.join(ENDINGS)}")
    if path.is_dir():
        raise UsageError(f"{path} is a folder; name a file in it, such as {path / 'table.parquet'}")
    return path


def write_table_file(table: pa.Table, path: Path) -> None:
    """Write a table; the file appears as a whole or not at all.

    Raises
    ------
    UsageError
        If the path cannot be written.
    """
    check_table_file(path)
    if path.suffix.lower() == ".csv":
        write_csv(table, path)
    else:
        write_file(path, lambda draft: pyarrow.parquet.write_table(table, draft))
