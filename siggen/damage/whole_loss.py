"""Whether damage leaves a pair without contact length anywhere on the path of contact, by one flank or by two together.

Derived. Between kinks of one flank its union opens or closes only where two of its own outlines cross, which is a kink
too: a closed stretch reaches from kink to kink. On two flanks an outline's end of one also crosses one of the other,
anywhere between. Such a stretch is bracketed: over a range of positions every row covers at most the face between its
extreme ends, which are known exactly (an ellipse is widest where it is nearest its centre, sides are straight), and
where even that leaves a gap no position of the range is closed. Other ranges are halved, and their middles tried.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.damage.kinks import section_kinks
from siggen.damage.row_columns import (
    FACE,
    HEIGHT,
    HIGHEST,
    LEFT_HIGH,
    LEFT_LOW,
    LOWEST,
    RIGHT_HIGH,
    RIGHT_LOW,
    SEMI_FACE,
    SEMI_HEIGHT,
    TRAPEZOID,
)
from siggen.damage.union import Intervals, active_pits, add_intervals, covered_length, interval_room
from siggen.gears import involute
from siggen.gears.gear_pair import GearPair

WHOLE_FACE = 1e-12
"""Remaining share of the face width below which a contact counts as lost: rounding of the union's ends."""
MARGIN = 1e-9
"""Of the face width: far above the rounding of a sum of widths."""
NARROWEST = 1e-8
"""Closed stretches shorter than this share of the path of contact are not looked for: 0.2 nm of usual gears."""


def takes_whole_contact(pair: GearPair, pinion_rows: FloatArray, gear_rows: FloatArray) -> bool:
    """Return whether the rows (n, 14) of two mating flanks, either of them none, cover the whole face somewhere.

    Source: derived, see this module.
    """
    pinion, gear, width = pair.pinion, pair.gear, pair.face_width_m
    if _widths_m(pinion_rows) + _widths_m(gear_rows) < width * (1.0 - MARGIN):
        return False  # compiles nothing: a configuration is checked with single pits, before anything is told
    flanks = (
        (pinion_rows, pinion.base_radius_m, pinion.base_half_angle_rad),
        (gear_rows, gear.signed_base_radius_m, gear.base_half_angle_rad),
    )
    rolls = [
        involute.rolls_at_heights(section_kinks(rows, width), abs(radius), half_angle) * radius
        for rows, radius, half_angle in flanks
    ]
    ends = np.array([pair.contact_start_m, pair.contact_end_m])
    cuts = np.clip(np.concatenate([rolls[0], pair.line_of_action_m - rolls[1], ends]), *ends)
    return bool(_closes(np.unique(cuts), pair.line_of_action_m, *flanks, width))


def _widths_m(rows: FloatArray) -> float:
    """Return the sum of the largest widths of all rows [m]: no position has a longer union."""
    ends = np.maximum(rows[:, RIGHT_LOW], rows[:, RIGHT_HIGH]) - np.minimum(rows[:, LEFT_LOW], rows[:, LEFT_HIGH])
    return float(np.where(rows[:, TRAPEZOID] != 0.0, ends, 2.0 * rows[:, SEMI_FACE]).sum())


@entry(cache=True)
def _closes(
    cuts: FloatArray,
    line: float,
    pinion: tuple[FloatArray, float, float],
    gear: tuple[FloatArray, float, float],
    face_width: float,
) -> bool:
    room = pinion[0].shape[0] + gear[0].shape[0]
    intervals, active = interval_room(room), np.empty(room, np.int64)
    together = pinion[0].shape[0] > 0 and gear[0].shape[0] > 0
    narrowest = NARROWEST * (cuts[-1] - cuts[0])
    stack = [(0.0, 0.0)]
    for k in range(cuts.size - 1):
        stack.clear()
        stack.append((cuts[k], cuts[k + 1]))
        while len(stack) > 0:
            low, high = stack.pop()
            middle = 0.5 * (low + high)
            if _is_closed(middle, line, pinion, gear, face_width, intervals, active):
                return True
            if not together or high - low <= narrowest:
                continue
            if _may_close(low, high, line, pinion, gear, face_width, intervals):
                stack.append((low, middle))
                stack.append((middle, high))
    return False


@njit(cache=True)
def _is_closed(
    position: float,
    line: float,
    pinion: tuple[FloatArray, float, float],
    gear: tuple[FloatArray, float, float],
    face_width: float,
    intervals: Intervals,
    active: IntArray,
) -> bool:
    filled = 0
    for travel, flank in ((position, pinion), (line - position, gear)):
        x = involute.height(travel / flank[1], abs(flank[1]), flank[2])
        count = active_pits(x, flank[0], active)
        filled = add_intervals(x, flank[0], active, count, face_width, intervals, filled)
    return covered_length(intervals, filled) >= face_width * (1.0 - WHOLE_FACE)


@njit(cache=True)
def _may_close(
    low: float,
    high: float,
    line: float,
    pinion: tuple[FloatArray, float, float],
    gear: tuple[FloatArray, float, float],
    face_width: float,
    intervals: Intervals,
) -> bool:
    """Return whether the extreme ends of all rows between two positions leave no gap."""
    filled = 0
    for start, stop, flank in ((low, high, pinion), (line - high, line - low, gear)):
        one = involute.height(start / flank[1], abs(flank[1]), flank[2])
        two = involute.height(stop / flank[1], abs(flank[1]), flank[2])
        filled = _add_extremes(min(one, two), max(one, two), flank[0], face_width, intervals, filled)
    return covered_length(intervals, filled) >= face_width * (1.0 - WHOLE_FACE)


@njit(cache=True)
def _add_extremes(
    bottom: float, top: float, rows: FloatArray, face_width: float, intervals: Intervals, filled: int
) -> int:
    """Insert the extreme ends of each row between two heights into lists sorted by `left`; return their number."""
    left, right, _ = intervals
    for i in range(rows.shape[0]):
        if rows[i, LOWEST] > top or rows[i, HIGHEST] < bottom:
            continue
        if rows[i, TRAPEZOID] != 0.0:
            span = rows[i, HIGHEST] - rows[i, LOWEST]
            one = (max(bottom, rows[i, LOWEST]) - rows[i, LOWEST]) / span
            two = (min(top, rows[i, HIGHEST]) - rows[i, LOWEST]) / span
            lean_left, lean_right = rows[i, LEFT_HIGH] - rows[i, LEFT_LOW], rows[i, RIGHT_HIGH] - rows[i, RIGHT_LOW]
            first = rows[i, LEFT_LOW] + min(one * lean_left, two * lean_left)
            last = rows[i, RIGHT_LOW] + max(one * lean_right, two * lean_right)
        else:
            u = (min(max(rows[i, HEIGHT], bottom), top) - rows[i, HEIGHT]) / rows[i, SEMI_HEIGHT]
            reach = rows[i, SEMI_FACE] * sqrt(max((1.0 - u) * (1.0 + u), 0.0))
            first, last = rows[i, FACE] - reach, rows[i, FACE] + reach
        first, last = max(first, 0.0), min(last, face_width)
        if last <= first:
            continue
        k = filled
        while k > 0 and left[k - 1] > first:
            left[k], right[k] = left[k - 1], right[k - 1]
            k -= 1
        left[k], right[k] = first, last
        filled += 1
    return filled
