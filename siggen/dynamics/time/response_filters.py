"""Filters that make delivered accelerations, bearing forces and readings of shafts of a structure's states."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.decimation import Decimator, second_difference_taps, value_taps


def acceleration_decimator(
    structure: Structure, motions: Sequence[str], fs_hz: float, steps_per_sample: int
) -> Decimator:
    """Return what turns displacements into low-passed accelerations of the named motions."""
    still = np.zeros(len(structure.coordinates))
    rows = np.array([np.concatenate([structure.motions[name], still]) for name in motions]).reshape(-1, 2 * still.size)
    second_rate = second_difference_taps(steps_per_sample) * (fs_hz * steps_per_sample) ** 2
    return Decimator(rows, second_rate, steps_per_sample)


class ValueDecimator:
    """Filters values first · q + second · q̇ about their static values: states count from the static deflection.

    Parameters
    ----------
    pairs : pairs of (n,), first and second
    static_deflection : (n,)
    steps_per_sample : int
    """

    def __init__(
        self, pairs: Iterable[tuple[FloatArray, FloatArray]], static_deflection: FloatArray, steps_per_sample: int
    ) -> None:
        kept = list(pairs)
        rows = np.array([np.concatenate(pair) for pair in kept]).reshape(-1, 2 * static_deflection.size)
        self._decimator = Decimator(rows, value_taps(steps_per_sample), steps_per_sample)
        self._at_rest = np.array([(first * static_deflection).sum() for first, _ in kept]).reshape(-1, 1)

    def take(self, states: FloatArray) -> FloatArray:
        """Filter the next states (steps, 2n) as far as the filter reaches; return the next samples (pairs, k)."""
        return np.asarray(self._decimator.take(states) + self._at_rest)
