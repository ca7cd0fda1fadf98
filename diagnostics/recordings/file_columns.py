"""The columns of a recorded file, read in this process by the reader of its format: by its beginning, not its name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from diagnostics.recordings.plain_files import read_mat, read_numpy, read_parquet, read_wav
from diagnostics.recordings.recorded_columns import Columns
from diagnostics.recordings.recorder_files import read_hdf5, read_mdf, read_tdms, read_universal
from diagnostics.recordings.text_files import read_text
from siggen.errors import UsageError

READERS: dict[str, Callable[[Path], Columns]] = {
    **dict.fromkeys((".csv", ".txt", ".tsv", ".asc", ".dat", ".lvm"), read_text),
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
    ".mf4": read_mdf,
    ".mdf": read_mdf,
}
"""By the ending of a name, where a file does not begin as its format does."""

BEGINNINGS: tuple[tuple[bytes, str], ...] = (
    (b"RIFF", ".wav"),
    (b"TDSm", ".tdms"),
    (b"PAR1", ".parquet"),
    (b"\x93NUMPY", ".npy"),
    (b"MDF     ", ".mf4"),
    (b"\x89HDF\r\n", ".h5"),
    (b"MATLAB 5.0", ".mat"),
    (b"MATLAB 7.3", ".mat"),
    (b"    -1", ".uff"),
)


def file_columns(path: Path, row: int | None = None) -> Columns:
    """Return the columns of a file; `row` as for `read_columns`.

    Raises
    ------
    UsageError
        If it cannot be read, whatever the libraries below say to what is in it.
    """
    kind = file_kind(path)
    try:
        return read_parquet(path, row) if kind == ".parquet" else READERS[kind](path)
    except UsageError as error:
        raise error if str(error).startswith(str(path)) else UsageError(f"{path}: {error}") from error
    except MemoryError as error:
        raise UsageError(f"{path}: cannot be read: it asks for more memory than a file of its size may take") from error
    except Exception as error:  # a damaged file finds every way out of a parser that there is
        name = type(error).__name__
        raise UsageError(
            f"{path}: cannot be read as {kind[1:]}, it is damaged or no such file ({name}: {_one_line(error)})"
        ) from error


def file_kind(path: Path) -> str:
    """Return the ending in `READERS` that a file should have: by its first bytes, then by its name, else text."""
    with path.open("rb") as file:
        head = file.read(16)
    suffix = path.suffix.lower()
    kind = next((kind for mark, kind in BEGINNINGS if head.startswith(mark)), None)
    if kind == ".uff" and READERS.get(suffix) is read_text:
        kind = suffix  # a column whose first number is -1
    return kind or (suffix if suffix in READERS else ".txt")


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]
