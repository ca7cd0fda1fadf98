"""Files of arrays and samples that say little about themselves: NumPy, MATLAB and WAV.

NumPy files: `.npy` with one array, `.npz` with named ones; pickled objects are refused.

MATLAB files up to version 7: every numeric vector or matrix is a set of columns.

WAV files: rate from the header; integers are shares of the recorder's full scale, floats are values.
"""

from __future__ import annotations

import warnings
import zipfile
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


def read_wav(path: Path) -> Columns:
    """Read the channels of a WAV file, called "1", "2" ...

    Raises
    ------
    UsageError
        If it is not one.
    """
    from scipy.io import wavfile

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # chunks of notes that are passed over
            fs_hz, samples = wavfile.read(path)
    except (ValueError, OSError, EOFError) as error:
        raise UsageError(f"{path}: cannot be read as WAV ({error})") from error
    if samples.dtype.kind == "f":
        return Columns(numbered(samples), float(fs_hz))
    middle = 128.0 if samples.dtype == np.uint8 else 0.0  # 8-bit WAV is unsigned
    # 24 bits come shifted up into 32, so that the type's range is the full scale in every case
    scale = 128.0 if samples.dtype == np.uint8 else float(np.iinfo(samples.dtype).max) + 1.0
    return Columns(numbered((samples.astype(np.float64) - middle) / scale), float(fs_hz), full_scale=True)


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
