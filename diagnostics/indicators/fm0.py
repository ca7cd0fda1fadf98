"""FM0: peak-to-peak of the synchronous average over the sum of its mesh-line amplitudes."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.kurtosis import UNDEFINED_BELOW


def fm0(average: np.ndarray, amplitude: np.ndarray, teeth: int, harmonics: int) -> float:
    """Return (max x - min x) / sum of A(h z), h = 1 ... harmonics.

    Parameters
    ----------
    average : (n,) float64
        Synchronous average, one revolution.
    amplitude : (orders,) float64
        Its line amplitudes at whole shaft orders.
    teeth : int
        Teeth on the shaft.
    harmonics : int
        Mesh harmonics in the sum; the value depends on it.

    Notes
    -----
    One mesh line alone: 2. NaN where the lines are below 1e-9 of the peak-to-peak. MATLAB's `gearConditionMetrics`
    takes average and regular signal; how it forms the sum was not found stated, so its values may differ. Source:
    Stewart 1977.
    """
    swing = float(average.max() - average.min())
    lines = float(amplitude[teeth : harmonics * teeth + 1 : teeth].sum())
    return swing / lines if lines > UNDEFINED_BELOW * swing else math.nan
