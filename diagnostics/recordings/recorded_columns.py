"""Columns: the columns of a recorded file by name, whatever its format."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from siggen.errors import UsageError

OWN_TACHO = "tacho_s"
"""Column of pulse times of a shaft, as siggen's own records have it."""

LARGEST = 1e12
"""No recorder gives such a number, in whatever unit; from the damaged file that does, the squares would overflow."""

MOST_COLUMNS = 4_000
"""Of a file: no recorder has as many channels, and every column costs time wherever it is looked at."""


@dataclass(frozen=True, slots=True)
class Columns:
    """What a file holds.

    Attributes
    ----------
    values : mapping of str to (n,) float64
        Column by name; columns without a name are called by their position, from "1" on.
    fs_hz : float or None
        Sampling frequency where the file states it.
    full_scale : bool
        Whether values are shares of the recorder's full scale, as integer WAV files hold them.
    simulated : bool
        Whether the file says that siggen wrote it.
    units : mapping of str to str
        Unit of columns where the file states it, as spelled there.
    own : mapping of str to str
        Channel -> its column, where the file says so of its columns, as those of siggen do.
    layout : mapping of str to str
        What a text file was taken for: format, encoding, separator, decimal mark; of others the format.
    notes : tuple of str
        What was left out, cut or shifted.
    hint_hz : float or None
        A rate that words of the header may mean; offered, never taken.
    """

    values: Mapping[str, np.ndarray]
    fs_hz: float | None = None
    full_scale: bool = False
    simulated: bool = False
    units: Mapping[str, str] = field(default_factory=dict)
    own: Mapping[str, str] = field(default_factory=dict)
    layout: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    hint_hz: float | None = None


def as_numbers(array: Any) -> np.ndarray:
    """Return a pyarrow array of numbers or truth values as float64, (n,); NaN where it holds none.

    By the protocol that passes memory on: `to_numpy` imports pandas where that is installed, which takes ten times as
    long as reading a file, in the process of every file.
    """
    import pyarrow as pa

    if pa.types.is_boolean(array.type):
        array = array.cast(pa.int8())
    if array.null_count:
        array = array.cast(pa.float64()).fill_null(math.nan)
    return np.asarray(np.from_dlpack(array), dtype=np.float64)


def numbered(array: np.ndarray, prefix: str = "") -> dict[str, np.ndarray]:
    """Return the columns of an array by position from 1 on: the longer axis is time; one alone has the prefix's name.

    Raises
    ------
    ValueError
        If the array is not one- or two-dimensional and real.
    """
    if array.dtype.kind not in "biuf" or array.ndim not in (1, 2):
        raise ValueError(f"received {array.ndim} dimensions of {array.dtype}; allowed are one or two of real numbers")
    rows = np.atleast_2d(array.astype(np.float64))
    if array.ndim == 2 and rows.shape[0] > rows.shape[1]:
        rows = rows.T
    if len(rows) == 1:
        return {prefix or "1": rows[0]}
    return {f"{prefix}:{k}" if prefix else str(k): row for k, row in enumerate(rows, start=1)}


def refuse_many(path: Path, columns: int) -> None:
    """Refuse a file of very many columns.

    Raises
    ------
    UsageError
        If it has more than `MOST_COLUMNS`.
    """
    if columns > MOST_COLUMNS:
        raise UsageError(
            f"{path}: received {columns} columns; allowed are at most {MOST_COLUMNS}, with one row per sample. Are "
            "rows and columns exchanged?"
        )


def refuse_twice(path: Path, names: Sequence[str]) -> None:
    """Refuse a file in which a name stands for several columns: nobody could say which of them is meant.

    Raises
    ------
    UsageError
        If there is such a name; columns without a name are not counted.
    """
    counts = Counter(name for name in names if name)
    if again := sorted(name for name, count in counts.items() if count > 1):
        raise UsageError(f"{path}: {counts[again[0]]} columns are called {again[0]}; rename them in the file")
