"""MATLAB files up to version 7: every numeric vector or matrix is a set of columns."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, numbered
from siggen.errors import UsageError


def read_mat(path: Path) -> Columns:
    """Read the numeric vectors and matrices of a MAT file; structures, cells and text are passed over.

    Raises
    ------
    UsageError
        If it cannot be read, or is of version 7.3, which is another format.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        found = loadmat(path)
    except NotImplementedError as error:
        raise UsageError(f"{path}: is a MAT file of version 7.3; save it with `save(..., '-v7')`") from error
    except (MatReadError, ValueError, OSError) as error:
        raise UsageError(f"{path}: cannot be read as a MAT file ({error})") from error
    values: dict[str, np.ndarray] = {}
    for name, array in found.items():
        is_array = not name.startswith("__") and isinstance(array, np.ndarray)
        if is_array and array.ndim == 2 and array.dtype.kind in "biuf" and array.size > 1:
            values |= numbered(array, name)
    return Columns(values)
