"""Sideband index (SI): mean amplitude of the two first-order sidebands of a mesh harmonic."""

from __future__ import annotations

import math

import numpy as np


def sideband_index(amplitude: np.ndarray, teeth: int, harmonic: int = 1) -> float:
    """Return [A(h z - 1) + A(h z + 1)] / 2 in the unit of the signal, not divided by the mesh line.

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole orders of the shaft; NaN marks an unresolved line.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        Mesh harmonic h; the usual index takes the first.

    Notes
    -----
    Modulation of index m of a mesh line of amplitude A: A m / 2. Source: Szczepanik, as in standard literature.
    """
    line = harmonic * teeth
    if line + 1 >= amplitude.size:
        return math.nan
    return 0.5 * float(amplitude[line - 1] + amplitude[line + 1])
