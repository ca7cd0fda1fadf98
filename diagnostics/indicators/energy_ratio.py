"""Energy ratio: standard deviation of the difference signal over that of the regular signal."""

from __future__ import annotations

import math

import numpy as np


def energy_ratio(difference: np.ndarray, regular: np.ndarray) -> float:
    """Return std(d) / std(g); NaN where the regular signal does not vary.

    Parameters
    ----------
    difference, regular : (n,) float64
        The two parts of one synchronous average.

    Notes
    -----
    Below 1 in a serviceable gearbox as a rule. MATLAB's `gearConditionMetrics` takes difference and regular signal too.
    Source: Swansson, as in standard literature.
    """
    kept = float(regular.std())
    return float(difference.std()) / kept if kept > 0.0 else math.nan
