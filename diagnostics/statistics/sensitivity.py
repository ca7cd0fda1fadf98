"""What moves an indicator in healthy records: share of variance that speed, load, sensor, noise, specimen explain.

Each cause alone, adjusted for its degrees of freedom, on ranks (so that one wild record does not decide). Causes may
share variance, so shares need not add up to one. Source: adjusted R^2 of a linear model, standard literature.
"""

from __future__ import annotations

import math

import numpy as np

DEGREE = 2
"""Speed, load and noise enter as a parabola: amplitudes pass resonances."""


def explained_share(values: np.ndarray, cause: np.ndarray, *, groups: bool) -> float:
    """Return the adjusted share of rank variance that a cause explains, 0 to 1; NaN where it cannot be judged.

    Parameters
    ----------
    values : (n,) float64
        Indicator in healthy records, without NaN.
    cause : (n,)
        Number (speed ...) or group (sensor ...).
    groups : bool
        Whether the cause is a group; else a parabola is fitted.

    Notes
    -----
    1 - (1 - R^2)(n - 1)/(n - p - 1) with p fitted numbers besides the mean, cut off below zero. NaN with a single
    level of the cause, with n - p - 1 < 1, or where the indicator does not vary.
    """
    from scipy.stats import rankdata

    levels, index = np.unique(cause, return_inverse=True)
    fitted = levels.size - 1 if groups else min(DEGREE, levels.size - 1)
    free = values.size - fitted - 1
    if levels.size < 2 or free < 1:
        return math.nan
    ranks = rankdata(values)
    centred = ranks - ranks.mean()
    total = float(centred @ centred)
    if not total > 0.0:
        return math.nan
    if groups:
        model = (np.bincount(index, centred) / np.bincount(index))[index]
    else:
        scaled = (cause - cause.mean()) / np.ptp(cause)
        model = np.polyval(np.polyfit(scaled, centred, fitted), scaled)
    share = 1.0 - float(np.square(centred - model).sum()) / total
    return max(1.0 - (1.0 - share) * (values.size - 1) / free, 0.0)
