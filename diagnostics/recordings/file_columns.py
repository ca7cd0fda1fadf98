"""The columns of a recorded file, read in this process by the reader of its suffix."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from diagnostics.recordings.plain_files import read_csv, read_mat, read_numpy, read_parquet, read_wav
from diagnostics.recordings.recorded_columns import Columns
from diagnostics.recordings.recorder_files import read_hdf5, read_tdms, read_universal
from siggen.errors import UsageError

READERS: dict[str, Callable[[Path], Columns]] = {
    ".csv": read_csv,
    ".txt": read_csv,
    ".mat": read_mat,
    ".wav": read_wav,
    ".npy": read_numpy,
    ".npz": read_numpy,
    ".parquet": read_parquet,
    ".tdms": read_tdms,
    ".uff": read_universal,
    ".unv": read_universal,
    ".h5": read_hdf5,
    ".hdf5": read_hdf5,
}


def file_columns(path: Path, row: int | None = None) -> Columns:
    """Return the columns of a file whose suffix is one of `READERS`; `row` as for `read_columns`.

    Raises
    ------
    UsageError
        If it cannot be read, whatever the libraries below say to what is in it.
    """
    try:
        suffix = path.suffix.lower()
        return read_parquet(path, row) if suffix == ".parquet" else READERS[suffix](path)
    except UsageError:
        raise
    except MemoryError as error:
        raise UsageError(f"{path}: cannot be read: it asks for more memory than a file of its size may take") from error
    except Exception as error:  # a damaged file finds every way out of a parser that there is
        kind = type(error).__name__
        raise UsageError(
            f"{path}: cannot be read as {suffix[1:]}, it is damaged or no such file ({kind}: {_one_line(error)})"
        ) from error


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]
