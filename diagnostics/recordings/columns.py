"""The columns of a recorded file by its suffix; nothing in a file is ever executed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from diagnostics.recordings.csv_file import read_csv
from diagnostics.recordings.mat_file import read_mat
from diagnostics.recordings.numpy_file import read_numpy
from diagnostics.recordings.parquet_file import read_parquet
from diagnostics.recordings.recorded_columns import Columns
from diagnostics.recordings.wav_file import read_wav
from siggen.errors import UsageError


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
