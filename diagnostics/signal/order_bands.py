"""Bands of shaft orders of one averaged revolution, and how unevenly their energy is spread over the angle.

A short event on a few degrees spreads over a wide band of orders and stands out where the rest of the average is weak;
which band that is depends on gears, housing and speed. So octaves that overlap by half are taken one by one. Source:
kurtosis in bands after Antoni 2006; bands in shaft orders and the localised energy derived.
"""

from __future__ import annotations

import math

import numpy as np

EDGES = (9, 13, 19, 27, 38, 53, 75, 106, 150, 212, 300, 424, 600)
"""Shaft orders, half an octave apart: 75 times a power of the square root of 2."""

ORDER_BANDS = tuple(zip(EDGES[:-2], EDGES[2:], strict=True))
"""Octaves [low, high) that overlap by half."""

FEWEST_SHARE = 0.5
"""A band of which the record carries less than this share of the orders is left undefined."""


def band_name(low: int, high: int) -> str:
    """Return what columns call a band of shaft orders: `o75_150`."""
    return f"o{low}_{high}"


def band_signals(part: np.ndarray, highest_order: float = math.inf) -> np.ndarray:
    """Return the analytic signals of `ORDER_BANDS`, bands of whole shaft orders, of one averaged revolution.

    The real part is the part of the average in a band, the magnitude its envelope. Orders are whole bins of the
    revolution, so bands have sharp edges and nothing rings over the ends.

    Parameters
    ----------
    part : (n,) float64
        One revolution at equal angle steps: an average, its residual, or its difference to a healthy one.
    highest_order : float
        Highest order that the record carries (half its sampling rate over the shaft's speed); bands end there.

    Returns
    -------
    (bands, n) complex128
        NaN throughout where record or angle steps carry less than half of a band.
    """
    from scipy import fft

    lines, highest = 2.0 * fft.rfft(part), math.floor(min(highest_order, (part.size - 1) / 2.0)) + 1
    kept = np.zeros((len(ORDER_BANDS), part.size), dtype=np.complex128)
    for row, (low, high) in zip(kept, ORDER_BANDS, strict=True):
        row[low : min(high, highest)] = lines[low : min(high, highest)]
    found = np.asarray(fft.ifft(kept, axis=1))
    found[[min(high, highest) - low < FEWEST_SHARE * (high - low) for low, high in ORDER_BANDS]] = np.nan
    return found


def localised_energy(band: np.ndarray, teeth: int) -> float:
    """Return the largest energy of a band within one tooth pitch over its mean energy per tooth pitch.

    Parameters
    ----------
    band : (n,) complex128
        Analytic signal of one revolution.
    teeth : int
        Teeth on the shaft; n is a multiple of it.

    Notes
    -----
    A steady tone: 1. A burst within one pitch: the number of teeth. NaN where the band is empty or undefined. Source:
    derived.
    """
    energy = np.square(band.real) + np.square(band.imag)
    mean = float(energy.mean())
    if not mean > 0.0:
        return math.nan
    pitch = band.size // teeth
    running = np.cumsum(np.concatenate([[0.0], energy, energy[: pitch - 1]]))
    return float((running[pitch:] - running[:-pitch]).max()) / (pitch * mean)
