"""M8A: eighth normalised moment of the difference signal of a synchronous average."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.normalised_moment import normalised_moment
from diagnostics.indicators.rms import rms


def m8a(difference: np.ndarray, average: np.ndarray) -> float:
    """Return N^3 sum (d - mean)^8 / (sum (d - mean)^2)^4; NaN where d is below 1e-9 of the average.

    Parameters
    ----------
    difference : (n,) float64
        Average without shaft orders, mesh harmonics and their first-order sidebands.
    average : (n,) float64
        The average itself, which sets the guard.

    Notes
    -----
    Gaussian: 105; sine: 4.375. The factor is N^3; with N^2, as some code has it, the value falls with the number of
    samples. MATLAB's `gearConditionMetrics` takes the difference signal too. Source: Martin 1989.
    """
    return normalised_moment(difference, 8, rms(average))
