"""Energy operator (Lebold): kurtosis of x_(i+1)^2 - x_i^2."""

from __future__ import annotations

import numpy as np

from diagnostics.indicators.kurtosis import kurtosis


def energy_operator_lebold(residual: np.ndarray) -> float:
    """Return the kurtosis of x_(i+1)^2 - x_i^2 of a residual signal; NaN where that difference does not vary.

    Parameters
    ----------
    residual : (n,) float64
        One revolution without shaft orders and mesh harmonics; periodic.

    Notes
    -----
    This is the operator as the review's text states it, not Teager's. Sine: 1.5 (the difference is a sine of twice the
    order). Source: Lebold et al. 2000.
    """
    squared = residual * residual
    return kurtosis(np.roll(squared, -1) - squared)
