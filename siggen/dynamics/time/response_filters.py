"""Filters that make delivered accelerations and bearing forces of a structure's states."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

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


def force_decimator(structure: Structure, steps_per_sample: int) -> Decimator:
    """Return what filters bearing forces about their static values; a model without bearings has no rows."""
    pairs = [np.concatenate(pair) for pair in structure.bearing_forces.values()]
    rows = np.array(pairs).reshape(-1, 2 * len(structure.coordinates))
    return Decimator(rows, value_taps(steps_per_sample), steps_per_sample)
