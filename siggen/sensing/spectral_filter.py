"""Lengths of transforms and their frequencies."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray


def filter_length(history: int, samples: int) -> int:
    """Return the number of samples over which to transform: at least both, a product of small primes."""
    from scipy.fft import next_fast_len

    return int(next_fast_len(history + samples, real=True))


def frequencies(length: int, fs_hz: float) -> FloatArray:
    """Return the frequencies (length // 2 + 1,) [Hz] of a spectrum."""
    return np.arange(length // 2 + 1, dtype=np.float64) * (fs_hz / length)
