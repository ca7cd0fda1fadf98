"""FM4: kurtosis of the difference signal of a synchronous average."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.kurtosis import kurtosis
from diagnostics.indicators.rms import rms


def fm4(difference: np.ndarray, average: np.ndarray) -> float:
    """Return mu_4(d) / mu_2(d)^2; NaN ("undefined") where the difference signal is below 1e-9 of the average.

    Parameters
    ----------
    difference : (n,) float64
        Average without shaft orders, mesh harmonics and their first-order sidebands.
    average : (n,) float64
        The average itself, which sets the guard: perfect gears make FM4 a ratio of rounding errors.

    Notes
    -----
    Gaussian: 3. Not monotone in severity: pitting over many teeth lowers it again. MATLAB's `gearConditionMetrics`
    takes the difference signal too. Source: Stewart 1977.
    """
    return kurtosis(difference, reference_rms=rms(average))
