"""Analytic signal of a periodic signal: itself plus j times its Hilbert transform; its magnitude is the envelope.

Exact for one revolution of an average, which is periodic: negative orders are zeroed. Source: standard literature.
"""

from __future__ import annotations

import numpy as np


def analytic_signal(signal: np.ndarray) -> np.ndarray:
    """Return the analytic signal, (n,) complex128; the mean and, for even n, the last line keep their weight."""
    from scipy import fft

    spectrum = fft.fft(signal)
    half = (signal.size + 1) // 2
    spectrum[1:half] *= 2.0
    spectrum[signal.size // 2 + 1 :] = 0.0
    return np.asarray(fft.ifft(spectrum))


def envelope(signal: np.ndarray) -> np.ndarray:
    """Return |signal + j H(signal)|, (n,) float64; of A cos it is A."""
    amplitude: np.ndarray = np.abs(analytic_signal(signal))
    return amplitude
