"""Slow speed variation of a record, from its shaft pulses."""

from __future__ import annotations

import math

import numpy as np

SLOW_BELOW_HZ = 2.5
HALF_POWER = 0.443
"""A moving average of length T has lost half of the power at 0.443 / T."""


def speed_variation_percent(tacho_s: np.ndarray) -> float:
    """Return the standard deviation of the speed below 2.5 Hz over its mean [%]; NaN with fewer than three pulses.

    Parameters
    ----------
    tacho_s : (k,) float64
        Times of one pulse per revolution [s].

    Notes
    -----
    The mean speed of each revolution is smoothed by a moving average that halves the power at 2.5 Hz. Source: derived.
    """
    if len(tacho_s) < 3:
        return math.nan
    speed_hz = 1.0 / np.diff(np.asarray(tacho_s, dtype=np.float64))
    width = min(max(1, round(HALF_POWER / SLOW_BELOW_HZ * float(speed_hz.mean()))), speed_hz.size)
    slow = np.convolve(speed_hz, np.full(width, 1.0 / width), mode="valid")
    return 100.0 * float(slow.std() / speed_hz.mean())
