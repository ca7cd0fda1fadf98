"""Unloaded static transmission error of a gear pair: the approach at which the first pair of teeth touches.

Reference: standard literature. Without load teeth do not deflect, so the gears come to rest where the pair that misses
least touches: min_n e_n(s_n) over the pairs in reach, e_n what the teeth of pair n miss together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial, MissingTables


def unloaded_transmission_error_m(pair: GearPair, missing: MissingMaterial, pitches: FloatArray) -> FloatArray:
    """Return the approach (k,) [m] at which the first pair touches, at pinion angles in base pitches (k,).

    Pair n is pinion tooth n mod z_1 with gear tooth n mod z_2; it enters the path of contact at the angle n. Positive
    where the driven gear lags. Pairs beyond the tables' ends are not looked at.
    """
    before = (pair.contact_start_m - missing.start_m) / pair.base_pitch_m
    after = (missing.end_m - pair.contact_start_m) / pair.base_pitch_m
    newest = np.floor(np.asarray(pitches) + before).astype(np.int64)
    least = np.full(newest.shape, np.inf)
    for older in range(int(np.floor(before + after)) + 1):
        number = newest - older
        place = pitches - number
        together = _missing(missing, missing.pinion, pair, number, place)
        together += _missing(missing, missing.gear, pair, number, place)
        least = np.where(place < after, np.minimum(least, together), least)
    return least


def _missing(
    missing: MissingMaterial, teeth: MissingTables, pair: GearPair, number: NDArray[np.int64], place: FloatArray
) -> FloatArray:
    """Return what one gear's tooth of every pair misses (k,), `place` base pitches after entering contact [m]."""
    tooth = number % teeth.kind_of_tooth.size
    points = teeth.profile_m.shape[1]
    position = pair.contact_start_m + place * pair.base_pitch_m
    at = np.clip((position - missing.start_m) / (missing.end_m - missing.start_m) * (points - 1), 0.0, points - 1.0)
    index = np.minimum(at.astype(np.int64), points - 2)
    rows, share = teeth.kind_of_tooth[tooth], at - index
    profile = teeth.profile_m[rows, index] * (1.0 - share) + teeth.profile_m[rows, index + 1] * share
    return np.asarray(profile + teeth.offset_m[tooth])
