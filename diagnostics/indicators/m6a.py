"""M6A: sixth normalised moment of the difference signal of a synchronous average."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.normalised_moment import normalised_moment
from diagnostics.indicators.rms import rms


def m6a(difference: np.ndarray, average: np.ndarray) -> float:
    """Return N^2 sum (d - mean)^6 / (sum (d - mean)^2)^3; NaN where d is below 1e-9 of the average.

    Parameters
    ----------
    difference : (n,) float64
        Average without shaft orders, mesh harmonics and their first-order sidebands.
    average : (n,) float64
        The average itself, which sets the guard.

    Notes
    -----
    Gaussian: 15; sine: 2.5. More sensitive to single peaks than FM4. MATLAB's `gearConditionMetrics` takes the
    difference signal too. Source: Martin 1989.
    """
    return normalised_moment(difference, 6, rms(average))
