"""The columns of a recorded file by its suffix; nothing in a file is ever executed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from diagnostics.recordings.file_columns import READERS
from diagnostics.recordings.reading_process import columns_read_apart
from diagnostics.recordings.recorded_columns import OWN_TACHO, Columns
from diagnostics.recordings.time_column import clocks, say
from siggen.errors import UsageError

TIMES_ALIKE = 1e-3
"""Rates of two time columns of one file that are the same, rounded differently; an angle that rises evenly is not."""


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
    return _with_clocks(found)


def _with_clocks(found: Columns) -> Columns:
    """Return what a file holds with its times and counters, and the rate where times agree on one."""
    known = clocks(found.values, found.units, OWN_TACHO)
    rates = {name: rate for name, rate in known.items() if rate is not None}
    if found.fs_hz is not None or not rates:
        return replace(found, clocks=known)
    if max(rates.values()) > min(rates.values()) * (1.0 + TIMES_ALIKE):
        return replace(found, clocks=known)
    name, rate = next(iter(rates.items()))
    say(name, rate)
    return replace(found, fs_hz=rate, clocks=known)
