"""The columns of a recorded file by name, whatever its format; nothing in a file is ever executed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from siggen.errors import UsageError


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
    """

    values: Mapping[str, np.ndarray]
    fs_hz: float | None = None
    full_scale: bool = False


def read_columns(path: Path, row: int | None = None) -> Columns:
    """Read a file by its suffix: .csv, .txt, .mat, .wav, .parquet, .npy or .npz.

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
    from diagnostics.recordings.csv_file import read_csv
    from diagnostics.recordings.mat_file import read_mat
    from diagnostics.recordings.numpy_file import read_numpy
    from diagnostics.recordings.parquet_file import read_parquet
    from diagnostics.recordings.wav_file import read_wav

    readers: dict[str, Callable[[Path], Columns]] = {
        ".csv": read_csv,
        ".txt": read_csv,
        ".mat": read_mat,
        ".wav": read_wav,
    }
    readers |= {".npy": read_numpy, ".npz": read_numpy, ".parquet": lambda file: read_parquet(file, row)}
    if path.is_dir():
        raise UsageError(f"{path}: is a folder; give the file of one recording")
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    if path.suffix.lower() not in readers:
        raise UsageError(
            f"{path}: received suffix {path.suffix!r}; allowed are {', '.join(readers)}. Convert the recording."
        )
    found = readers[path.suffix.lower()](path)
    if not found.values:
        raise UsageError(f"{path}: holds no column of numbers")
    return found


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
