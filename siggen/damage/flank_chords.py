"""Chords of the damage along the profile, on lines across the face: where a contact finds land, where it finds a pit.

Derived. The face is cut into slices of equal width, each seen on its middle line, or where damage ends within it on
the middle of what damage covers. On a line the damage of a flank is
the exact union of its outlines (the rows of `pit_rows`), as intervals of the arc R_b ψ²/2 along the involute: the
length in which the mating flank sees a pit, unlike the height x and unlike the path s, in which 1 mm of arc near the
base circle is several. At a contact the intervals of both flanks lie on one tangent, whose coordinate grows with the
pinion's arc and falls with the gear's; where they touch they are one pit.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.damage.flank_damage import pit_rows
from siggen.damage.part import ToothDamage, has_extent
from siggen.damage.row_columns import (
    EDGE_RADIUS,
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
from siggen.damage.union import square_depth
from siggen.gears import involute
from siggen.gears.spur_gear import SpurGear

BEYOND_TIP = 1.5
"""Pits are followed up to this multiple of the tip's roll angle: a pit open at the tip has no edge there."""

WHOLE = 1e-6
"""Part of a slice that does not count: far more than rounding, far less than is felt."""


class LineRows(NamedTuple):
    """Rows that cross the line of every slice.

    `crossing` (slices,): how many; (slices, rows) each: their numbers `row`, and the heights `low_m`, `high_m` [m]
    between which they cover the line.
    """

    crossing: IntArray
    row: IntArray
    low_m: FloatArray
    high_m: FloatArray


class FlankChords(NamedTuple):
    """Pits of one flank on the line of every slice (a named tuple, since compiled code takes no dataclass).

    `low`, `high` (slices, most): merged intervals along the arc [m], ascending; `low_radius_m`, `high_radius_m`: radii
    of their edges [m], negative where the damage states none; `intervals` (slices,): how many; `face_m` (slices,): the
    lines; `covered` (slices,): part of a slice's width over which damage extends; `pits` (n, COLUMNS): rows of
    `pit_rows`; `lines`: those that cross each line; `base_radius_m`, `half_angle_rad`: the involute. Radius and arcs
    of a ring are negative.
    """

    low: FloatArray
    high: FloatArray
    low_radius_m: FloatArray
    high_radius_m: FloatArray
    intervals: IntArray
    face_m: FloatArray
    covered: FloatArray
    pits: FloatArray
    lines: LineRows
    base_radius_m: float
    half_angle_rad: float


def flank_chords(gear: SpurGear, pits: Iterable[ToothDamage], face_width_m: float, slices: int) -> FlankChords:
    """Return the chords of one flank; pits without extent in any direction are no pits.

    Parameters
    ----------
    gear : SpurGear
    pits : iterable of ToothDamage
        Pits of one tooth; their `gear` and `tooth` are not read.
    face_width_m : float
    slices : int
        Equal slices across the face, at least 1.
    """
    rows = pit_rows(one for one in pits if has_extent(one))
    face, covered = _covered(face_width_m, slices, rows)
    highest = float(gear.height_m(min(BEYOND_TIP * gear.last_roll_rad, 0.5 * pi)))
    lines = _line_rows(face, rows)
    found, count = _line_unions(lines, rows, highest)
    low, high, low_radius, high_radius = np.ascontiguousarray(found[:, :, : count.max()])
    arcs = _arcs(gear, low), _arcs(gear, high)
    if gear.signed_base_radius_m < 0.0:  # what is higher lies lower along the tangent
        arcs, low_radius, high_radius = arcs[::-1], high_radius, low_radius
    return FlankChords(
        low=arcs[0],
        high=arcs[1],
        low_radius_m=low_radius,
        high_radius_m=high_radius,
        intervals=count,
        face_m=face,
        covered=covered,
        pits=rows,
        lines=lines,
        base_radius_m=gear.signed_base_radius_m,
        half_angle_rad=gear.base_half_angle_rad,
    )


def one_line(flank: FlankChords, number: int) -> FlankChords:
    """Return the chords of one slice alone."""
    own = slice(number, number + 1)
    shared = {"pits", "lines", "base_radius_m", "half_angle_rad"}
    lines = LineRows(flank.lines.crossing[own], flank.lines.row[own], flank.lines.low_m[own], flank.lines.high_m[own])
    return flank._replace(lines=lines, **{k: v[own] for k, v in flank._asdict().items() if k not in shared})


@entry(cache=True)
def _covered(width: float, slices: int, pits: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the lines of the slices, and the parts of their widths over which damage extends at any height."""
    room, merged = np.zeros((4, pits.shape[0])), np.zeros((4, pits.shape[0]))
    face, covered = width * (np.arange(slices) + 0.5) / slices, np.zeros(slices)
    for j in range(slices):
        first, last = width * j / slices, width * (j + 1) / slices
        filled = 0
        for i in range(pits.shape[0]):
            low, high = max(_end(pits, i, -1.0), first), min(_end(pits, i, 1.0), last)
            if low < high:
                filled = insert_interval(low, high, 0.0, 0.0, room, filled)
        longest = 0.0
        for k in range(merge_intervals(room, filled, merged)):
            length = merged[1, k] - merged[0, k]
            covered[j] += length * slices / width
            if length > longest:
                longest, middle = length, 0.5 * (merged[0, k] + merged[1, k])
        if covered[j] > 1.0 - WHOLE:
            covered[j] = 1.0
        elif covered[j] < WHOLE:
            covered[j] = 0.0
        else:
            face[j] = middle
    return face, covered


@njit(cache=True)
def _end(pits: FloatArray, i: int, side: float) -> float:
    """Return how far row i reaches across the face, to the left (`side` -1) or to the right (1)."""
    if pits[i, TRAPEZOID] == 0.0:
        end: float = pits[i, FACE] + side * pits[i, SEMI_FACE]
    elif side < 0.0:
        end = min(pits[i, LEFT_LOW], pits[i, LEFT_HIGH])
    else:
        end = max(pits[i, RIGHT_LOW], pits[i, RIGHT_HIGH])
    return end


@entry(cache=True)
def _line_rows(face: FloatArray, pits: FloatArray) -> LineRows:
    """Return which rows cross the lines at `face` (slices,), and where."""
    shape = (face.size, pits.shape[0])
    lines = LineRows(np.zeros(face.size, np.int64), np.zeros(shape, np.int64), np.zeros(shape), np.zeros(shape))
    for j in range(face.size):
        for i in range(pits.shape[0]):
            low, high = _heights_on_line(face[j], pits, i)
            if low < high:
                k = lines.crossing[j]
                lines.row[j, k], lines.low_m[j, k], lines.high_m[j, k] = i, low, high
                lines.crossing[j] += 1
    return lines


@entry(cache=True)
def _line_unions(lines: LineRows, pits: FloatArray, highest: float) -> tuple[FloatArray, IntArray]:
    """Return merged intervals of height and the radii of their edges (4, slices, rows), clipped to 0 and `highest`.

    The second array is how many there are on every line.
    """
    found = np.zeros((4, *lines.row.shape))
    room = np.empty((4, pits.shape[0]))
    merged = np.zeros(lines.crossing.size, np.int64)
    for j in range(lines.crossing.size):
        filled = 0
        for k in range(lines.crossing[j]):
            radius = pits[lines.row[j, k], EDGE_RADIUS]
            first, last = max(lines.low_m[j, k], 0.0), min(lines.high_m[j, k], highest)
            if last > first:
                filled = insert_interval(first, last, radius, radius, room, filled)
        merged[j] = merge_intervals(room, filled, found[:, j])
    return found, merged


@njit(cache=True)
def insert_interval(
    low: float, high: float, low_radius: float, high_radius: float, room: FloatArray, filled: int
) -> int:
    """Insert an interval with the radii of its edges into a list (4, n) sorted by the low ends; return how many."""
    k = filled
    while k > 0 and room[0, k - 1] > low:
        for part in range(4):
            room[part, k] = room[part, k - 1]
        k -= 1
    room[0, k], room[1, k], room[2, k], room[3, k] = low, high, low_radius, high_radius
    return filled + 1


@njit(cache=True)
def _heights_on_line(face: float, pits: FloatArray, i: int) -> tuple[float, float]:
    """Return the heights between which row i covers the line at `face`; an empty interval where it does not."""
    if pits[i, TRAPEZOID] == 0.0:
        v = (face - pits[i, FACE]) / pits[i, SEMI_FACE]
        reach = pits[i, SEMI_HEIGHT] * sqrt(max((1.0 - v) * (1.0 + v), 0.0))
        return pits[i, HEIGHT] - reach, pits[i, HEIGHT] + reach
    # A trapezoid: from its lowest (0) to its highest point (1), where left side <= face <= right side, both straight.
    first, last = 0.0, 1.0
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        at_low, at_high = sign * (face - pits[i, LEFT_LOW + side]), sign * (face - pits[i, LEFT_HIGH + side])
        if at_low < 0.0 and at_high < 0.0:
            return 0.0, 0.0
        if at_low < 0.0:
            first = max(first, at_low / (at_low - at_high))
        elif at_high < 0.0:
            last = min(last, at_low / (at_low - at_high))
    height = pits[i, HIGHEST] - pits[i, LOWEST]
    return (
        pits[i, LOWEST] if first == 0.0 else pits[i, LOWEST] + first * height,
        pits[i, HIGHEST] if last == 1.0 else pits[i, LOWEST] + last * height,
    )


@njit(cache=True)
def merge_intervals(room: FloatArray, filled: int, out: FloatArray) -> int:
    """Write the union of sorted intervals (4, n) as separate intervals and return their number."""
    count = 0
    for k in range(filled):
        if count and room[0, k] <= out[1, count - 1]:
            if room[1, k] > out[1, count - 1]:
                out[1, count - 1], out[3, count - 1] = room[1, k], room[3, k]
        else:
            for part in range(4):
                out[part, count] = room[part, k]
            count += 1
    return count


def _arcs(gear: SpurGear, height_m: FloatArray) -> FloatArray:
    """Return the arc along the involute, R_b ψ²/2, at heights (slices, k), signed as R_b [m]."""
    roll = involute.rolls_at_heights(height_m.ravel(), gear.base_radius_m, gear.base_half_angle_rad)
    return np.ascontiguousarray((0.5 * gear.signed_base_radius_m * roll**2).reshape(height_m.shape))


@entry(cache=True)
def depth_on_line(
    j: int,
    height: float,
    face: FloatArray,
    pits: FloatArray,
    crossing: IntArray,
    row: IntArray,
    low: FloatArray,
    high: FloatArray,
) -> float:
    """Return the largest depth of the pits at a height on the middle line of slice j, 0 on a land.

    Arrays are those of `FlankChords` and its `lines`, one by one: to hand over the tuple costs more than the rest.
    """
    deepest = 0.0
    for k in range(crossing[j]):
        if low[j, k] < height < high[j, k]:
            deepest = max(deepest, square_depth(height, face[j], pits, row[j, k]))
    return sqrt(deepest)
