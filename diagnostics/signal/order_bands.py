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


def band_signal(part: np.ndarray, low: int, high: int, highest_order: float = math.inf) -> np.ndarray:
    """Return the analytic signal of a band of whole shaft orders of one averaged revolution.

    Its real part is the part of the average in the band, its magnitude the envelope. Orders are whole bins of the
    revolution, so the band has sharp edges and nothing rings over the ends.

    Parameters
    ----------
    part : (n,) float64
        One revolution at equal angle steps: an average, its residual, or its difference to a healthy one.
    low, high : int
        Orders low ... high - 1 are kept.
    highest_order : float
        Highest order that the record carries (half its sampling rate over the shaft's speed); the band ends there.

    Returns
    -------
    (n,) complex128
        NaN throughout where record or angle steps carry less than half of the band.
    """
    from scipy import fft

    end = min(high, math.floor(min(highest_order, (part.size - 1) / 2.0)) + 1)
    if end - low < FEWEST_SHARE * (high - low):
        return np.full(part.size, np.nan, dtype=np.complex128)
    kept = np.zeros(part.size, dtype=np.complex128)
    kept[low:end] = 2.0 * fft.rfft(part)[low:end]
    return np.asarray(fft.ifft(kept))


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
