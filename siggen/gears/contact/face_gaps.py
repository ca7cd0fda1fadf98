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
from siggen.compiled import entry, njit
from siggen.gears.contact.edge_law import NO_EDGE
from siggen.gears.damage.flank_chords import FlankChords, depth_on_line
from siggen.gears.geometry import involute
from siggen.gears.geometry.gear_pair import GearPair

SAME_M = 1e-12


class FaceGaps(NamedTuple):
    """What slices meet at positions, (positions, slices) each, in the terms of `two_edges.gap_sink` [m].

    `notch_m` is the depth in the middle of the gap, 0 at a tip; `floor_m` that below the normal, 0 on land; `covered`:
    the part of a slice that has the gap, 0 where there is none but those of the tips; `on_damage`: that part where the
    normal lies in damage, else 0; `tips_m` (positions, slices, 2): left and right
    of a slice without damage.
    """

    left_m: FloatArray
    right_m: FloatArray
    notch_m: FloatArray
    floor_m: FloatArray
    on_damage: FloatArray
    covered: FloatArray
    tips_m: FloatArray

    @property
    def nearest_tip_m(self) -> FloatArray:
        """The nearer one of both tips (positions, slices)."""
        return np.minimum(self.tips_m[..., 0], self.tips_m[..., 1])


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
    gaps = FaceGaps(*(np.zeros(shape) for shape in (*(6 * [shape]), (*shape, 2))))
    tips = tuple(0.5 * g.signed_base_radius_m * g.tip_roll_rad**2 for g in (pair.pinion, pair.gear))
    room = np.empty((2, pinion.low.shape[1] + gear.low.shape[1] + 2))
    _fill(pair.line_of_action_m, pinion, gear, tips[0], tips[1], np.ascontiguousarray(position_m), room, gaps)
    return gaps


@entry(cache=True)
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
    base_1, half_1 = pinion.base_radius_m, pinion.half_angle_rad
    base_2, half_2 = gear.base_radius_m, gear.half_angle_rad
    count_1, from_1, to_1, face_1, pits_1 = pinion.intervals, pinion.low, pinion.high, pinion.face_m, pinion.pits
    count_2, from_2, to_2, face_2, pits_2 = gear.intervals, gear.low, gear.high, gear.face_m, gear.pits
    crossing_1, row_1, low_1, high_1 = pinion.lines
    crossing_2, row_2, low_2, high_2 = gear.lines
    part_1, part_2 = pinion.covered, gear.covered
    left_m, right_m, notch_m, floor_m, on_damage, covered, tips_m = gaps
    for i in range(position.size):
        roll_1, roll_2 = position[i] / base_1, (line - position[i]) / base_2
        arc_1, arc_2 = 0.5 * base_1 * roll_1**2, 0.5 * base_2 * roll_2**2
        height_1, height_2 = _height(arc_1, base_1, half_1), _height(arc_2, base_2, half_2)
        room[0, 0], room[1, 0] = tip_1 - arc_1, NO_EDGE
        room[0, 1], room[1, 1] = -NO_EDGE, arc_2 - tip_2
        behind, ahead = _nearest(room, 2)
        for j in range(count_1.size):
            tips_m[i, j, 0], tips_m[i, j, 1] = -behind, ahead
            if count_1[j] == 0 and count_2[j] == 0:
                left_m[i, j], right_m[i, j] = -behind, ahead
                continue
            part = max(part_1[j] if count_1[j] else 0.0, part_2[j] if count_2[j] else 0.0)
            covered[i, j] = part
            filled = 0
            for k in range(count_1[j]):
                room[0, filled], room[1, filled] = from_1[j, k] - arc_1, to_1[j, k] - arc_1
                filled += 1
            for k in range(count_2[j]):
                room[0, filled], room[1, filled] = arc_2 - to_2[j, k], arc_2 - from_2[j, k]
                filled += 1
            damaged = filled
            room[0, filled], room[1, filled] = tip_1 - arc_1, NO_EDGE
            room[0, filled + 1], room[1, filled + 1] = -NO_EDGE, arc_2 - tip_2
            low, high = _nearest(room, filled + 2)
            left_m[i, j], right_m[i, j] = -low, high
            if low > -0.5 * NO_EDGE and high < 0.5 * NO_EDGE:
                middle = 0.5 * (low + high)
                if count_2[j] > 0 or abs(arc_1 + middle - known_at[j]) > SAME_M:
                    known_at[j] = arc_1 + middle
                    at_1, at_2 = _height(arc_1 + middle, base_1, half_1), _height(arc_2 - middle, base_2, half_2)
                    known[j] = depth_on_line(j, at_1, face_1, pits_1, crossing_1, row_1, low_1, high_1)
                    known[j] += depth_on_line(j, at_2, face_2, pits_2, crossing_2, row_2, low_2, high_2)
                notch_m[i, j] = known[j]
            for k in range(damaged):
                if room[0, k] < 0.0 < room[1, k]:
                    on_damage[i, j] = part
                    floor_m[i, j] = depth_on_line(j, height_1, face_1, pits_1, crossing_1, row_1, low_1, high_1)
                    if count_2[j] > 0:
                        floor_m[i, j] += depth_on_line(j, height_2, face_2, pits_2, crossing_2, row_2, low_2, high_2)
                    break


@entry(cache=True)
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
def _height(arc: float, base_radius: float, half_angle: float) -> float:
    """Return the height of a point of the flank at an arc, signed as the radius; NaN beside the involute [m]."""
    square = 2.0 * arc / base_radius
    if square <= 0.0:
        return np.nan
    return involute.height(sqrt(square), abs(base_radius), half_angle)
