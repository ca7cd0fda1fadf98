"""The columns of a recorded file; nothing in it is ever executed. What makes a channel unusable, and the way out."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from diagnostics.recordings.columns_apart import columns_read_apart
from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.recorded_columns import LARGEST, Columns
from diagnostics.records.usable_records import LARGEST_CLIPPED_SHARE, clipped_share
from siggen.errors import UsageError

PULSE_SHARE = 0.5
"""A vibration that stands at its ends for more than half the time is none; pulses do so nearly always."""


def signal_problem(signal: np.ndarray, column: str) -> str:
    """Return why a channel (n,) of a column cannot be used, or nothing: not finite, too large, constant, clipped."""
    broken = int(np.count_nonzero(~np.isfinite(signal)))
    if broken:
        first = int(np.argmin(np.isfinite(signal))) + 1
        return (
            f"{broken} of {signal.size} samples are not finite, first row {first} of the data; delete all rows up to "
            "the last of them, or all from the first on"
        )
    if signal.size == 0 or signal.min() == signal.max():
        return f"constant over all {signal.size} samples; check sensor and cable, or name another column"
    largest = float(np.abs(signal).max())
    if largest > LARGEST:
        return (
            f"received values up to {largest:.3g}, allowed: up to {LARGEST:g}; the file is damaged, or its unit wrong"
        )
    share = clipped_share(signal)
    if share > PULSE_SHARE:
        return (
            f"{share:.2%} of the samples stand at {signal.min():g} or {signal.max():g}, as pulses do; if these are "
            f"those of the tacho, say so: {in_rig(f'tacho: {column}')}; else name the `channels` there"
        )
    if share > LARGEST_CLIPPED_SHARE:
        return (
            f"{share:.2%} of the samples stand clipped at {signal.min():g} or {signal.max():g}, up to "
            f"{LARGEST_CLIPPED_SHARE:.1%} is allowed; record again with a wider range"
        )
    return ""


def read_columns(path: Path, row: int | None = None) -> Columns:
    """Read a file by what it begins with, else by its suffix.

    Parameters
    ----------
    path : Path
        The file.
    row : int, optional
        Which row of a Parquet file with one record per row, from zero.

    Raises
    ------
    UsageError
        If it does not exist, cannot be read, or holds no column of numbers.
    """
    if path.is_dir():
        raise UsageError(f"{path}: is a folder; give the file of one recording")
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    found = columns_read_apart(path, row)
    if not found.values:
        raise UsageError(f"{path}: holds no column of numbers")
    return found
