"""Average of a record over whole hunting periods: the angle after which the same two teeth meet again.

With coprime tooth numbers it takes z2 pinion revolutions; what is locked to either shaft or to a pair of teeth stays,
everything else falls as one over the number of periods. Source: standard literature.
"""

from __future__ import annotations

import math

import numpy as np

from siggen.errors import UsageError


def hunting_meshes(teeth: tuple[int, int]) -> int:
    """Return the mesh periods of one hunting period: the least common multiple of the tooth numbers."""
    return math.lcm(*teeth)


def hunting_average(angle_signal: np.ndarray, teeth: tuple[int, int], samples_per_tooth: int) -> np.ndarray:
    """Average an angle signal over all whole hunting periods it holds.

    Parameters
    ----------
    angle_signal : (n,) float64
        Record at equal angle steps, `samples_per_tooth` per mesh period.
    teeth : (int, int)
        Teeth of pinion and gear.
    samples_per_tooth : int
        Angle steps per mesh period.

    Returns
    -------
    (lcm(z1, z2) * samples_per_tooth,) float64
        One hunting period.

    Raises
    ------
    UsageError
        If the record is shorter than one hunting period; the message says how long it has to be.
    """
    period = hunting_meshes(teeth) * samples_per_tooth
    count = angle_signal.size // period
    if count < 1:
        raise UsageError(
            f"received {angle_signal.size / samples_per_tooth / teeth[0]:.1f} pinion revolutions; a hunting period of "
            f"{teeth[0]}/{teeth[1]} teeth takes {hunting_meshes(teeth) // teeth[0]}. Use longer records."
        )
    return np.asarray(angle_signal[: count * period].reshape(count, period).mean(axis=0))
