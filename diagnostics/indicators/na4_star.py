"""NA4*: NA4 whose mean variance stops growing at the last healthy record."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from diagnostics.indicators.na4 import central_moments, na4_of_moments


def na4_star(residuals: Sequence[np.ndarray], healthy: int) -> float:
    """Return mu_4 of the last residual over the squared mean variance of the healthy records among them.

    Parameters
    ----------
    residuals : sequence of (n,) float64
        Residual signals of one machine in chronological order, the last one judged.
    healthy : int
        The first so many are healthy; the denominator holds no later one. Decker freezes it where the variance leaves
        its statistical limits; in a simulated set it is known which records are healthy.

    Notes
    -----
    Gaussian, healthy: 3. A residual that is c times as strong gives 3 c^4, where NA4 levels off. NaN without a healthy
    record. Source: Decker, Handschuh & Zakrajsek 1994.
    """
    kept = residuals[: min(healthy, len(residuals))]
    return na4_of_moments(central_moments(residuals[-1])[0], [central_moments(residual)[1] for residual in kept])
