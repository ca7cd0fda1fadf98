"""Pulses of the pinion at a speed that a comb of mesh lines shows, and which of several speeds are the same."""

from __future__ import annotations

import numpy as np

from diagnostics.signal.tacholess_angle import tacholess_pulses

SAME_SPEED = 0.01


def pulses_around(signal: np.ndarray, fs_hz: float, teeth: int, speeds_hz: np.ndarray) -> np.ndarray:
    """Return pulse times [s] of a pinion whose speed over time (k,) [Hz] is known to two per cent."""
    margin = 0.02 * float(speeds_hz.mean())
    limits = (float(speeds_hz.min()) - margin, float(speeds_hz.max()) + margin)
    # In so narrow a range the lines' own skirts are the median that clarity counts from; half and double are compared
    # by the caller.
    return tacholess_pulses(signal, fs_hz, teeth, limits, least_clarity=0.0, doubts=False)


def mean_speed(pulses_s: np.ndarray) -> float:
    """Return the mean speed [Hz] over pulses (n,) [s]."""
    return float((pulses_s.size - 1) / (pulses_s[-1] - pulses_s[0]))


def distinct_speeds(speeds: list[np.ndarray]) -> list[np.ndarray]:
    """Return the speeds, those within one per cent of each other once."""
    distinct: list[np.ndarray] = []
    for speed in speeds:
        if all(abs(np.median(speed) / np.median(known) - 1.0) > SAME_SPEED for known in distinct):
            distinct.append(speed)
    return distinct
