"""A table in a file of its own, CSV or Parquet by the file's ending: what commands write beside data sets."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet

from siggen.dataset.spreadsheet import write_csv
from siggen.dataset.storage import LocalFolder
from siggen.errors import UsageError

WRITERS = {".csv": write_csv, ".parquet": pyarrow.parquet.write_table}


def check_table_file(path: Path) -> Path:
    """Return the path if a table can go there; call it before long work.

    Raises
    ------
    UsageError
        If the ending is unknown or the path is a folder.
    """
    if path.suffix.lower() not in WRITERS:
        raise UsageError(f"{path}: received the ending {path.suffix!r}; allowed are {', '.join(WRITERS)}")
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
    try:
        with LocalFolder(path.parent).draft(path.name) as draft:
            WRITERS[path.suffix.lower()](table, draft)
    except OSError as error:
        raise UsageError(f"{path} cannot be written: {error.strerror or error}") from error
