"""Sideband power: power of the k-th sidebands of all mesh harmonics over the power of the mesh lines."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.kurtosis import UNDEFINED_BELOW


def sideband_power(amplitude: np.ndarray, teeth: int, order: int, harmonics: int) -> float:
    """Return sum_h [A(h z - k)^2 + A(h z + k)^2] / sum_h A(h z)^2, h = 1 ... harmonics.

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line and makes the ratio undefined.
    teeth : int
        Teeth on the shaft.
    order : int
        k, below teeth / 2.
    harmonics : int
        Mesh harmonics in both sums; the value depends on it.

    Notes
    -----
    Amplitude modulation of index m at shaft order k: m^2 / 2. NaN where no mesh line stands above 1e-9 of the strongest
    line, or a sideband lies outside the band or nearer to another mesh line. Source: derived from Parseval's theorem.
    """
    lines = teeth * np.arange(1, harmonics + 1)
    if 2 * order >= teeth or lines[-1] + order >= amplitude.size:
        return math.nan
    carrier = float(np.sum(amplitude[lines] ** 2))
    if not math.sqrt(carrier) > UNDEFINED_BELOW * float(np.nanmax(amplitude)):
        return math.nan
    return float(np.sum(amplitude[lines - order] ** 2 + amplitude[lines + order] ** 2)) / carrier
