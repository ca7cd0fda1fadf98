"""Filtering a stationary record in the frequency domain, its history before the first sample included.

Overlap-save (reference: standard literature): the product of spectra is a periodic convolution; what wraps around the
end falls into the history, whose filtered values are thrown away. Exact if the filter's memory fits into the history.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray, FloatArray


def filter_length(history: int, samples: int) -> int:
    """Return the number of samples over which to transform: a product of small primes, at least history + samples."""
    from scipy.fft import next_fast_len

    return int(next_fast_len(history + samples, real=True))


def record_spectrum(history: FloatArray, record: FloatArray, length: int) -> ComplexArray:
    """Return the spectrum (length // 2 + 1,) of a record about its mean, with its history before it.

    What is missing at the front is filled with the mean.

    Raises
    ------
    ValueError
        If both together are longer than `length`.
    """
    given = history.size + record.size
    if given > length:
        raise ValueError(f"length: received {length}; allowed is at least {given}, history and record")
    values = np.zeros(length)
    values[length - given : length - record.size] = history
    values[length - record.size :] = record
    values[length - given :] -= record.mean()
    return np.asarray(np.fft.rfft(values), dtype=np.complex128)


def frequencies(length: int, fs_hz: float) -> FloatArray:
    """Return the frequencies (length // 2 + 1,) [Hz] of a spectrum."""
    return np.arange(length // 2 + 1, dtype=np.float64) * (fs_hz / length)


def record_of(spectrum: ComplexArray, length: int, samples: int) -> FloatArray:
    """Return the last `samples` values of the signal with this spectrum: the record without its history."""
    signal: FloatArray = np.fft.irfft(spectrum, length)
    return signal[length - samples :]
