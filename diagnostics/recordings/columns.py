"""The columns of a recorded file by its suffix; nothing in a file is ever executed."""

from __future__ import annotations

from pathlib import Path

from diagnostics.recordings.file_columns import READERS
from diagnostics.recordings.reading_process import columns_read_apart
from diagnostics.recordings.recorded_columns import Columns
from siggen.errors import UsageError


def read_columns(path: Path, row: int | None = None) -> Columns:
    """Read a file by its suffix, one of `READERS`.

    Parameters
    ----------
    path : Path
        The file.
    row : int, optional
        Which row of a Parquet file with one record per row, from zero.

    Raises
    ------
    UsageError
        If it does not exist, has another suffix, cannot be read, or holds no column of numbers.
    """
    if path.is_dir():
        raise UsageError(f"{path}: is a folder; give the file of one recording")
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    if path.suffix.lower() not in READERS:
        raise UsageError(
            f"{path}: received suffix {path.suffix!r}; allowed are {', '.join(READERS)}. Convert the recording."
        )
    found = columns_read_apart(path, row)
    if not found.values:
        raise UsageError(f"{path}: holds no column of numbers")
    return found
