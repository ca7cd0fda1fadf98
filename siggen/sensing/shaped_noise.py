"""ShapedNoise: noise of a given density without end, drawn in an order that blocks do not change.

White noise of variance f_s/2 has the one-sided density 1. It passes the filter of least phase with the wanted
amplitude, found from its cepstrum (reference: standard literature). Cut to so many taps, it smooths densities over
f_s/taps.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.sensing.spectral_filter import filter_length, frequencies

FADED_SHARE = 0.25
"""Last taps, over which a filter fades out."""
FINER = 4
"""Times finer is the grid of the cepstrum, so that it does not fold."""


def least_phase(density: FloatArray) -> ComplexArray:
    """Return the response (k,) of least phase with an amplitude (k,) > 0 from 0 to half the sampling rate, evenly."""
    size = 2 * (density.size - 1)
    cepstrum = np.fft.irfft(np.log(density), size)
    cepstrum[1 : size // 2] *= 2.0
    cepstrum[size // 2 + 1 :] = 0.0
    return np.asarray(np.exp(np.fft.rfft(cepstrum)))


def shape_taps(density: Callable[[FloatArray], FloatArray], taps: int, fs_hz: float) -> FloatArray:
    """Return the filter (taps,) with the amplitude that `density` gives at frequencies (k,) [Hz]."""
    size = FINER * taps
    pulse = np.fft.irfft(least_phase(density(frequencies(size, fs_hz))), size)[:taps]
    faded = int(FADED_SHARE * taps)
    pulse[-faded:] *= 0.5 + 0.5 * np.cos(np.pi * (np.arange(faded) + 0.5) / faded)
    return np.asarray(pulse)


class ShapedNoise:
    """Noise whose one-sided density is the squared amplitude of a filter (taps,) [unit per √Hz]."""

    def __init__(self, taps: FloatArray, fs_hz: float, rng: np.random.Generator) -> None:
        self._taps = taps * np.sqrt(0.5 * fs_hz)
        self._rng = rng
        self._before = rng.standard_normal(taps.size - 1)

    def take(self, count: int) -> FloatArray:
        """Return the next values (count,)."""
        values = np.concatenate([self._before, self._rng.standard_normal(count)])
        length = filter_length(values.size, 0)
        spectrum = np.fft.rfft(values, length)
        spectrum *= np.fft.rfft(self._taps, length)
        self._before = values[count:].copy()
        return np.asarray(np.fft.irfft(spectrum, length)[self._taps.size - 1 : values.size])
