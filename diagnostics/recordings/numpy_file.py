"""NumPy files: `.npy` with one array, `.npz` with named ones; pickled objects are refused."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, numbered
from siggen.errors import UsageError


def read_numpy(path: Path) -> Columns:
    """Read the arrays of a NumPy file.

    Raises
    ------
    UsageError
        If it is not one, or holds objects (which only unpickling could read) or arrays of more than two dimensions.
    """
    try:
        found = np.load(path, allow_pickle=False)
        if isinstance(found, np.ndarray):
            return Columns(numbered(found))
        with found as archive:
            arrays = {name: archive[name] for name in archive.files}
        values: dict[str, np.ndarray] = {}
        for name, array in arrays.items():
            if array.size > 1:  # a single number is a note, such as the rate, not a signal
                values |= numbered(array, name)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise UsageError(
            f"{path}: cannot be read as arrays of numbers ({error}); save float arrays with numpy.save or numpy.savez"
        ) from error
    return Columns(values)
