"""Amplitude of one sideband relative to its mesh line."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.kurtosis import UNDEFINED_BELOW


def sideband_amplitude(amplitude: np.ndarray, teeth: int, harmonic: int, offset: int) -> float:
    """Return A(h z + offset) / A(h z).

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        Mesh harmonic h, from 1.
    offset : int
        Sideband, negative below the mesh line; |offset| < teeth / 2, so that it belongs to this harmonic.

    Notes
    -----
    Amplitude modulation of index m by a sine gives m/2 on both sides. NaN where the sideband lies outside the band,
    nearer to another mesh line, is unresolved, or the mesh line is below 1e-9 of the strongest line. Source: standard
    literature.
    """
    line, order = harmonic * teeth, harmonic * teeth + offset
    if 2 * abs(offset) >= teeth or order >= amplitude.size or line >= amplitude.size:
        return math.nan
    carrier = float(amplitude[line])
    return float(amplitude[order]) / carrier if carrier > UNDEFINED_BELOW * float(np.nanmax(amplitude)) else math.nan
