"""Synchronous signal-to-noise ratio: variance of averages over ten revolutions against what they leave.

An average over m revolutions keeps 1/m of the variance of the rest, which is taken off: without that correction pure
noise would show 1/(m - 1). Source: derived.
"""

from __future__ import annotations

import math

import numpy as np

REVOLUTIONS_AVERAGED = 10


def synchronous_ratio_db(turns: np.ndarray, averaged: int = REVOLUTIONS_AVERAGED) -> float:
    """Return 10 log10 of synchronous over remaining variance [dB]; NaN where nothing is synchronous or nothing remains.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        Signal at equal angle steps, one row per revolution.
    averaged : int
        Revolutions per average; a shorter record is averaged as a whole.
    """
    size = min(averaged, turns.shape[0])
    if size < 2:
        return math.nan
    groups = turns[: turns.shape[0] // size * size].reshape(-1, size, turns.shape[1])
    average = groups.mean(axis=1)
    # sum of squares about the average = whole sum minus size * average^2, without a copy of the record
    rest = (float(np.square(groups).sum()) - size * float(np.square(average).sum())) / (average.size * (size - 1))
    signal = float(np.mean(np.square(average - average.mean(axis=1, keepdims=True)))) - rest / size
    if signal <= 0.0 or rest <= 1e-24 * signal:
        return math.nan
    return 10.0 * math.log10(signal / rest)
