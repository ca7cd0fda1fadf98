"""Sideband level factor (SLF): the two first-order sidebands over the standard deviation of the average."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.sideband_index import sideband_index


def sideband_level_factor(amplitude: np.ndarray, average: np.ndarray, teeth: int, harmonic: int = 1) -> float:
    """Return [A(h z - 1) + A(h z + 1)] / std(average); NaN where the average does not vary.

    Parameters
    ----------
    amplitude : (orders,) float64
        Line amplitudes at whole orders of the shaft.
    average : (n,) float64
        Synchronous average of the same shaft.
    teeth : int
        Teeth on the shaft.
    harmonic : int
        Mesh harmonic h; the usual factor takes the first.

    Notes
    -----
    One mesh line with modulation index m: sqrt(2) m / sqrt(1 + m^2 / 2). Source: Szczepanik, as in standard literature.
    """
    spread = float(average.std())
    return 2.0 * sideband_index(amplitude, teeth, harmonic) / spread if spread > 0.0 else math.nan
