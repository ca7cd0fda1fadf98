"""A number with its interval from leaving recordings out one by one.

Source: standard literature (jackknife); limits by Student's t with as many degrees of freedom as recordings less one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.9
FEWEST_RECORDINGS = 3
"""Fewer give no interval: two have one difference, which is small by chance too often to tell a spread."""


@dataclass(frozen=True, slots=True)
class Fitted:
    """A number, and limits that hold it with a confidence of 90 %, infinite from fewer than three recordings."""

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3g} [{self.low:.3g}, {self.high:.3g}]"


def jackknife(values: np.ndarray, statistic: Callable[[np.ndarray], float] = np.mean) -> Fitted:
    """Return a statistic of recordings (n,) with its interval."""
    from scipy.stats import t

    known = np.asarray(values, dtype=np.float64)
    known = known[np.isfinite(known)]
    if not known.size:
        return Fitted(math.nan, -math.inf, math.inf)
    whole = float(statistic(known))
    if known.size < FEWEST_RECORDINGS:
        return Fitted(whole, -math.inf, math.inf)
    without = np.array([statistic(np.delete(known, k)) for k in range(known.size)])
    error = math.sqrt((known.size - 1) / known.size * float(np.square(without - without.mean()).sum()))
    reach = float(t.ppf(0.5 + 0.5 * CONFIDENCE, known.size - 1)) * error
    return Fitted(whole, whole - reach, whole + reach)
