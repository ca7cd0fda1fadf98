"""Real cepstrum at a few quefrencies, of log spectra without their mesh lines.

c = IFFT(log |X|): sidebands or harmonics at a common spacing collect into one peak (rahmonic) at its inverse. Source:
Randall 2017, standard literature.
"""

from __future__ import annotations

import math

import numpy as np

HALF_WIDTH = 2
"""Bins replaced on each side of a line."""
FLOOR = 1e-9
"""Amplitudes below this share of the strongest line count as that much: the logarithm of an empty bin says nothing."""


def log_amplitude(amplitude: np.ndarray, count: int) -> np.ndarray:
    """Return the natural logarithm of the first amplitudes of a spectrum, (count,), floored at 1e-9 of its top."""
    found: np.ndarray = np.log(np.maximum(amplitude[:count], FLOOR * amplitude.max() + 1e-300))
    return found


def cepstrum_at(log_spectrum: np.ndarray, quefrency: np.ndarray) -> np.ndarray:
    """Return the real cepstrum of a one-sided log amplitude spectrum at a few quefrencies, as a sum of cosines.

    A transform of a length with a large prime factor, as a whole number of revolutions often gives, costs several
    times more than one of a round length; a sum does not.

    Parameters
    ----------
    log_spectrum : (k,) float64
        Natural logarithm of amplitude in equal steps from zero; the last bin counts as the end of the band.
    quefrency : (m,) int or float64
        In steps of 1 / (2 (k - 1)) of the inverse bin width; between whole steps the value is the band-limited
        interpolation.

    Returns
    -------
    (m,) float64
        Dimensionless. An echo of share a after q samples gives a/2 at q.
    """
    length = 2 * (log_spectrum.size - 1)
    block = math.isqrt(log_spectrum.size) + 1
    weighted = np.zeros(block * block)
    weighted[: log_spectrum.size] = 2.0 * log_spectrum
    weighted[[0, log_spectrum.size - 1]] = log_spectrum[[0, -1]]
    # bin a * block + b: the phases of a and b add up, so that 2 sqrt(k) phases per quefrency do for all bins
    step = np.arange(block)[:, None]
    fine = np.exp(2j * np.pi * (step * quefrency % length) / length)
    coarse = np.exp(2j * np.pi * (step * block * quefrency % length) / length)
    rows = weighted.reshape(block, block)
    found: np.ndarray = ((rows @ fine.real) * coarse.real - (rows @ fine.imag) * coarse.imag).sum(axis=0) / length
    return found


def without_lines(log_spectrum: np.ndarray, spacing: int) -> np.ndarray:
    """Return the log spectrum with every line at multiples of `spacing` replaced by a straight line over it.

    Mesh lines would else collect at the pinion's quefrency too, a whole number of mesh periods. The two neighbours
    beyond two bins (the Hann main lobe) carry the straight line.

    Parameters
    ----------
    log_spectrum : (k,) float64
        One-sided log amplitude.
    spacing : int
        Bins between the lines.
    """
    replaced = log_spectrum.copy()
    first = np.arange(spacing - HALF_WIDTH, log_spectrum.size, spacing)
    before = log_spectrum[first - 1]
    behind = first + 2 * HALF_WIDTH + 1
    # beyond the last bin the line is level
    rise = np.where(behind < log_spectrum.size, log_spectrum[np.minimum(behind, log_spectrum.size - 1)] - before, 0.0)
    for step in range(2 * HALF_WIDTH + 1):
        inside = first + step < log_spectrum.size
        share = (step + 1.0) / (2 * HALF_WIDTH + 2.0)
        replaced[first[inside] + step] = (before + share * rise)[inside]
    return replaced
