"""Noise of a given power density as the spectrum of a stationary record, white or falling as 1/f.

The record is taken as periodic over its length N: each bin of the discrete spectrum is an independent complex normal
number with E|X|² = S N f_s / 2, S the one-sided density (derived from Parseval's theorem). Such noise is stationary by
construction, so that filters have no transient on it.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray


def noise_spectrum(
    density: float, length: int, fs_hz: float, rng: np.random.Generator, *, pink_corner_hz: float | None = None
) -> ComplexArray:
    """Return the spectrum (length // 2 + 1,), as of `numpy.fft.rfft`, of noise without a mean.

    Parameters
    ----------
    density : one-sided, in units per √Hz; at the corner if pink
    length, fs_hz : of the record
    pink_corner_hz : where 1/f noise has the density; None: white

    Raises
    ------
    ValueError
        If density, length or corner are outside their range.
    """
    if not (density >= 0.0 and length >= 2 and fs_hz > 0.0):
        raise ValueError(
            f"noise: received density {density}, {length} samples at {fs_hz} Hz; allowed: 0 or more, from 2"
        )
    if pink_corner_hz is not None and not pink_corner_hz > 0.0:
        raise ValueError(f"pink_corner_hz: received {pink_corner_hz}; allowed are values above 0")
    bins = length // 2 + 1
    parts = rng.standard_normal((bins, 2))
    spectrum: ComplexArray = parts.view(np.complex128)[:, 0] * (density * 0.5 * np.sqrt(length * fs_hz))
    if length % 2 == 0:
        spectrum[-1] = spectrum[-1].real * np.sqrt(2.0)
    spectrum[0] = 0.0
    if pink_corner_hz is not None:
        spectrum[1:] *= np.sqrt(pink_corner_hz * length / (fs_hz * np.arange(1, bins)))
    return spectrum
