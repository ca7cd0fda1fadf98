"""A record between its samples: a quintic B-spline on the twice oversampled record.

Oversampling, spline prefilter and band limit are one multiplication in the frequency domain. The coefficients at the
samples and half a sample behind them are two transforms of the record's length; one of twice the length costs twice as
much. Source: the prefilter follows Unser 1999, the rest derived.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

OVERSAMPLING = 2
BAND_TAPER = 0.1
"""Share of the output band over which the anti-alias limit falls from one to zero."""

EVEN_WEIGHTS = ((1682.0, -880.0, 160.0), (237.0, 840.0, -240.0), (1.0, 40.0, 80.0))
ODD_WEIGHTS = ((1540.0, -1120.0, 320.0), (750.0, 240.0, -160.0), (10.0, 80.0, 32.0))
WEIGHTS_SCALE = 3840.0
"""Weights of the three pairs of coefficients round a place, from the inner to the outer one, as polynomials of its
distance v to their middle: of their sum in 1, v^2 and v^4, of their difference in v, v^3 and v^5; times the scale."""

BLOCK = 16384
"""Places that are taken at once: some ten arrays of so many numbers stay in the second cache."""


def spline_coefficients(signal: np.ndarray, limit: float) -> np.ndarray:
    """Return the coefficients of the spline through a periodic signal, two per sample, (2 n,) float64.

    Parameters
    ----------
    signal : (n,) float64
        Fades to zero at both ends, or is periodic.
    limit : float
        Cycles per sample above which the band is empty; 0.5 keeps all.
    """
    from scipy import fft

    spectrum = fft.rfft(signal)
    if limit < 0.5:
        start = limit * (1.0 - BAND_TAPER)
        # below the taper the factor is one
        first = min(int(start * signal.size), spectrum.size)
        cycles = np.arange(first, spectrum.size) / signal.size
        spectrum[first:] *= 0.5 + 0.5 * np.cos(np.pi * np.clip((cycles - start) / (limit - start), 0.0, 1.0))
    gain, between_gain = _gains(signal.size)
    found = np.empty(OVERSAMPLING * signal.size)
    found[1::2] = fft.irfft(spectrum * between_gain, n=signal.size, overwrite_x=True)
    spectrum *= gain
    found[::2] = fft.irfft(spectrum, n=signal.size, overwrite_x=True)
    return found


@lru_cache(maxsize=2)
def _gains(samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Return what a spectrum is multiplied by for coefficients at samples and between; records of a set are alike."""
    angle = np.pi * np.arange(samples // 2 + 1) / samples
    gain = 120.0 / (66.0 + 52.0 * np.cos(angle) + 2.0 * np.cos(2.0 * angle))
    if samples % 2 == 0:
        gain[-1] *= 2.0  # the last line and its mirror image, apart after oversampling
    between = gain * np.exp(1j * angle)
    gain.flags.writeable = between.flags.writeable = False
    return gain, between


def spline_values(coefficients: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the spline at places (m,) in samples, (m,) float64; beyond its ends it keeps its value there.

    Parameters
    ----------
    coefficients : (2 n,) float64
        As of `spline_coefficients`.
    place : (m,) float64
    """
    found = np.empty(place.size)
    for first in range(0, place.size, BLOCK):
        block = slice(first, first + BLOCK)
        found[block] = _block_values(coefficients, OVERSAMPLING * place[block])
    return found


def _block_values(coefficients: np.ndarray, place: np.ndarray) -> np.ndarray:
    np.clip(place, 2.0, coefficients.size - 4.0, out=place)
    outermost = place.astype(np.intp)
    apart = place - (outermost + 0.5)
    outermost -= 2
    square = apart * apart
    even, odd = np.zeros(place.size), np.zeros(place.size)
    left, right, total = np.empty(place.size), np.empty(place.size), np.empty(place.size)
    for pair in range(3):
        # all places are inside: "clip" spares the check
        coefficients[2 - pair :].take(outermost, out=left, mode="clip")
        coefficients[3 + pair :].take(outermost, out=right, mode="clip")
        np.add(left, right, out=total)
        np.subtract(right, left, out=right)
        even += _weighted(total, square, EVEN_WEIGHTS[pair], left)
        odd += _weighted(right, square, ODD_WEIGHTS[pair], left)
    odd *= apart
    odd += even
    odd /= WEIGHTS_SCALE
    return odd


def _weighted(
    values: np.ndarray, square: np.ndarray, weights: tuple[float, float, float], out: np.ndarray
) -> np.ndarray:
    """Return values times a polynomial of the square, in `out`."""
    np.multiply(square, weights[2], out=out)
    out += weights[1]
    out *= square
    out += weights[0]
    out *= values
    return out
