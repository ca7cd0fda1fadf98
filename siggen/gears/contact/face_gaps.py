"""Gaps that the slices of a face meet at contact positions: damage of both flanks and the tips of both teeth.

Derived. On the tangent at the contact the coordinate grows with the pinion's arc R_b ψ²/2 and falls with the gear's
(see `flank_chords`). A tooth ends at its tip: the pinion's leaves a gap that has no edge beyond, the gear's
one that has none before. Gaps that touch are one. A slice meets the gap that holds the normal, else the nearest one.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.gears.contact.edge_law import NO_EDGE
from siggen.gears.damage.flank_chords import FlankChords, depth_on_line
from siggen.gears.geometry import involute
from siggen.gears.geometry.gear_pair import GearPair

SAME_M = 1e-12


class FaceGaps(NamedTuple):
    """What slices meet at positions, (positions, slices) each, in the terms of `two_edges.gap_sink` [m].

    `notch_m` is the depth in the middle of the gap, 0 at a tip; `floor_m` that below the normal, 0 on land;
    `on_damage`: 1 where the normal lies in damage, else 0.
    """

    left_m: FloatArray
    right_m: FloatArray
    notch_m: FloatArray
    floor_m: FloatArray
    on_damage: FloatArray


def face_gaps(pair: GearPair, pinion: FlankChords, gear: FlankChords, position_m: FloatArray) -> FaceGaps:
    """Return the gaps at contact positions s (k,) [m], which may lie beyond the path of contact.

    Parameters
    ----------
    pair : GearPair
    pinion, gear : FlankChords
        Of as many slices.
    position_m : (k,)

    Raises
    ------
    ValueError
        If the flanks have different numbers of slices.
    """
    if pinion.intervals.size != gear.intervals.size:
        raise ValueError(
            f"flanks of {pinion.intervals.size} and {gear.intervals.size} slices; allowed: as many on both"
        )
    shape = (position_m.size, pinion.intervals.size)
    gaps = FaceGaps(*(np.zeros(shape) for _ in range(5)))
    tips = tuple(0.5 * g.base_radius_m * g.tip_roll_rad**2 for g in (pair.pinion, pair.gear))
    room = np.empty((2, pinion.low.shape[1] + gear.low.shape[1] + 2))
    _fill(pair.line_of_action_m, pinion, gear, tips[0], tips[1], np.ascontiguousarray(position_m), room, gaps)
    return gaps


@njit(cache=True)
def _fill(
    line: float,
    pinion: FlankChords,
    gear: FlankChords,
    tip_1: float,
    tip_2: float,
    position: FloatArray,
    room: FloatArray,
    gaps: FaceGaps,
) -> None:
    # The floor in the middle of a gap stays the same while the contact moves over a pit of the pinion alone.
    known_at, known = np.full(pinion.intervals.size, np.inf), np.zeros(pinion.intervals.size)
    for i in range(position.size):
        roll_1, roll_2 = position[i] / pinion.base_radius_m, (line - position[i]) / gear.base_radius_m
        arc_1, arc_2 = 0.5 * pinion.base_radius_m * roll_1**2, 0.5 * gear.base_radius_m * roll_2**2
        height_1, height_2 = _height(pinion, arc_1), _height(gear, arc_2)
        room[0, 0], room[1, 0] = tip_1 - arc_1, NO_EDGE
        room[0, 1], room[1, 1] = -NO_EDGE, arc_2 - tip_2
        behind, ahead = _nearest(room, 2)
        for j in range(pinion.intervals.size):
            if pinion.intervals[j] == 0 and gear.intervals[j] == 0:
                gaps.left_m[i, j], gaps.right_m[i, j] = -behind, ahead
                continue
            filled = 0
            for k in range(pinion.intervals[j]):
                room[0, filled], room[1, filled] = pinion.low[j, k] - arc_1, pinion.high[j, k] - arc_1
                filled += 1
            for k in range(gear.intervals[j]):
                room[0, filled], room[1, filled] = arc_2 - gear.high[j, k], arc_2 - gear.low[j, k]
                filled += 1
            damaged = filled
            room[0, filled], room[1, filled] = tip_1 - arc_1, NO_EDGE
            room[0, filled + 1], room[1, filled + 1] = -NO_EDGE, arc_2 - tip_2
            low, high = _nearest(room, filled + 2)
            gaps.left_m[i, j], gaps.right_m[i, j] = -low, high
            if low > -0.5 * NO_EDGE and high < 0.5 * NO_EDGE:
                middle = 0.5 * (low + high)
                if gear.intervals[j] > 0 or abs(arc_1 + middle - known_at[j]) > SAME_M:
                    known_at[j] = arc_1 + middle
                    known[j] = _depth(pinion, gear, j, _height(pinion, arc_1 + middle), _height(gear, arc_2 - middle))
                gaps.notch_m[i, j] = known[j]
            for k in range(damaged):
                if room[0, k] < 0.0 < room[1, k]:
                    gaps.on_damage[i, j] = 1.0
                    gaps.floor_m[i, j] = _depth(pinion, gear, j, height_1, height_2)


@njit(cache=True)
def _nearest(room: FloatArray, count: int) -> tuple[float, float]:
    """Return the gap that holds 0, else the nearest one, grown by all intervals that it touches."""
    first, least = 0, np.inf
    for k in range(count):
        away = max(room[0, k], -room[1, k])
        if away < least:
            first, least = k, away
    low, high = room[0, first], room[1, first]
    grown = True
    while grown:
        grown = False
        for k in range(count):
            if room[0, k] <= high and room[1, k] >= low and (room[0, k] < low or room[1, k] > high):
                low, high = min(low, room[0, k]), max(high, room[1, k])
                grown = True
    return low, high


@njit(cache=True)
def _height(flank: FlankChords, arc: float) -> float:
    """Return the height of a point of the flank at an arc, NaN beside the involute [m]."""
    if arc <= 0.0:
        return np.nan
    return involute.height(sqrt(2.0 * arc / flank.base_radius_m), flank.base_radius_m, flank.half_angle_rad)


@njit(cache=True)
def _depth(pinion: FlankChords, gear: FlankChords, j: int, height_1: float, height_2: float) -> float:
    """Return the depth of both flanks together at a point of the tangent of slice j."""
    total = 0.0
    if pinion.intervals[j] > 0 and not np.isnan(height_1):
        total += depth_on_line(pinion, j, height_1)
    if gear.intervals[j] > 0 and not np.isnan(height_2):
        total += depth_on_line(gear, j, height_2)
    return total
