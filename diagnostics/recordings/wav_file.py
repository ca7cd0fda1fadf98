"""WAV files: rate from the header; integers are shares of the recorder's full scale, floats are values."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, numbered
from siggen.errors import UsageError


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
