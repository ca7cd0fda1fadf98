"""Rough land: the flank within a reach of damage is as rough as what broke out of it, not as the sound flank.

The reach is `REACH_M`, and of a break that is narrower along the profile its width: damage that vanishes leaves sound
flanks. Derived. A flank unrolls into the plane of the arc R_b ψ²/2 and the face, where distances are those on the
metal. Damage grown by a disc is cut by a line across the profile where chords of the lines beside it, dy away, grow by
√(r² - dy²).
So the land is found on lines a tenth of the reach apart, and the rough part of a slice is that of its lines.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import ceil, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.damage.flank_chords import flank_chords, insert_interval, merge_intervals
from siggen.damage.part import ToothDamage, goes_through
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear

REACH_M = 0.5e-3
"""How far land is rough from the edge of damage (judgement)."""
LINES_PER_REACH = 10


class RoughLand(NamedTuple):
    """Where one flank is rough, on equal numbers of lines in each slice (a named tuple, since compiled code takes it).

    `low`, `high` (lines, most): separate intervals along the arc [m], signed as the base radius; `intervals` (lines,):
    how many.
    """

    low: FloatArray
    high: FloatArray
    intervals: IntArray


def rough_land(gear: SpurGear, damage: Iterable[ToothDamage], face_width_m: float, slices: int) -> RoughLand:
    """Return the rough land of one flank; what is broken off through the tooth leaves none.

    Parameters
    ----------
    gear : SpurGear
    damage : iterable of ToothDamage
        Of one tooth; their `gear` and `tooth` are not read.
    face_width_m : float
    slices : int
        Equal slices across the face, at least 1.
    """
    lines = slices * ceil(face_width_m / slices * LINES_PER_REACH / REACH_M)
    chords = flank_chords(gear, (one for one in damage if not goes_through(one)), face_width_m, lines)
    middle = face_width_m * (np.arange(lines) + 0.5) / lines
    low, high, count = _grown(middle, chords.face_m, chords.low, chords.high, chords.intervals, REACH_M)
    most = count.max(initial=0)
    return RoughLand(np.ascontiguousarray(low[:, :most]), np.ascontiguousarray(high[:, :most]), count)


def rough_shares(pair: GearPair, pinion: RoughLand, gear: RoughLand, place_m: FloatArray) -> FloatArray:
    """Return the part of each of n slices that is rough on either flank (k, n), at places on the path (k, n) [m].

    Both lands have as many lines, a whole number in each slice.
    """
    share = np.zeros(place_m.shape)
    base = pair.pinion.base_radius_m, pair.gear.signed_base_radius_m
    _count_rough(np.ascontiguousarray(place_m), pair.line_of_action_m, base, pinion, gear, share)
    return share


@entry(cache=True)
def _grown(
    middle: FloatArray, face: FloatArray, low: FloatArray, high: FloatArray, intervals: IntArray, reach: float
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return the unions (lines, most) of the intervals of lines within reach, each grown by what its reach leaves."""
    lines, widest = middle.size, low.shape[1]
    near = 2 * int(reach / (middle[1] - middle[0])) + 3 if lines > 1 else 1
    room, merged = np.zeros((4, near * widest)), np.zeros((4, near * widest))
    out, count = np.zeros((2, lines, near * widest)), np.zeros(lines, np.int64)
    for i in range(lines):
        filled = 0
        for j in range(max(i - near // 2, 0), min(i + near // 2 + 1, lines)):
            for k in range(intervals[j]):
                square = min(reach, high[j, k] - low[j, k]) ** 2 - (face[j] - middle[i]) ** 2
                if square < 0.0:
                    continue
                more = sqrt(square)
                filled = insert_interval(low[j, k] - more, high[j, k] + more, 0.0, 0.0, room, filled)
        count[i] = merge_intervals(room, filled, merged)
        for k in range(near * widest):
            out[0, i, k], out[1, i, k] = merged[0, k], merged[1, k]
    return out[0], out[1], count


@entry(cache=True)
def _count_rough(
    place: FloatArray,
    line_of_action: float,
    base: tuple[float, float],
    pinion: RoughLand,
    gear: RoughLand,
    share: FloatArray,
) -> None:
    lines = pinion.intervals.size // place.shape[1]
    for i in range(place.shape[0]):
        for j in range(place.shape[1]):
            arc_1 = 0.5 * place[i, j] ** 2 / base[0]
            arc_2 = 0.5 * (line_of_action - place[i, j]) ** 2 / base[1]
            rough = 0
            for m in range(j * lines, (j + 1) * lines):
                rough += _inside(pinion, m, arc_1) or _inside(gear, m, arc_2)
            share[i, j] = rough / lines


@njit(cache=True)
def _inside(land: RoughLand, line: int, arc: float) -> bool:
    found = False
    for k in range(land.intervals[line]):
        found = found or land.low[line, k] <= arc <= land.high[line, k]
    return found
