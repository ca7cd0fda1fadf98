"""Sideband asymmetry: upper over lower sideband of a mesh harmonic, in decibels."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.sideband_amplitude import sideband_amplitude


def sideband_asymmetry_db(amplitude: np.ndarray, teeth: int, harmonic: int, order: int = 1) -> float:
    """Return 20 log10 A(h z + k) / A(h z - k).

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line.
    teeth : int
        Teeth on the shaft.
    harmonic, order : int
        Mesh harmonic h and sideband k, k below teeth / 2.

    Notes
    -----
    Pure amplitude or pure phase modulation: 0 dB; both together, in phase or not, and any resonance nearby, tilt it.
    NaN where a sideband is zero, unresolved or outside the band. Source: derived.
    """
    lower, upper = (sideband_amplitude(amplitude, teeth, harmonic, sign * order) for sign in (-1, 1))
    return 20.0 * math.log10(upper / lower) if lower > 0.0 and upper > 0.0 else math.nan
