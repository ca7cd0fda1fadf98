"""Compiled union of pits and spalls in one section of a tooth: covered length across the face and depth moments.

Derived. At a height x every row (ellipse or trapezoid, see `siggen.damage.flank_damage.pit_rows`) covers an
interval of the face; the depth field is the largest depth of the rows that cover a point:

    D(w) = max_i D_i(w),   u = (x - mu_i)/b_i,   v = (w - w_i)/a_i
    D_i = delta_i (flat),  delta_i sqrt(1 - u^2 - v^2) (dish, ellipse),  delta_i sqrt(1 - u^2) (dish, trapezoid)

Nothing is rasterised: the face is cut where pits start, end or become the deepest, and each piece is integrated in
closed form.
"""

from __future__ import annotations

from math import atan2, isnan, pi, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.damage.row_columns import (
    DEPTH,
    DISH,
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


class Intervals(NamedTuple):
    """Room for intervals of rows across the face, sorted by their left ends: both ends [m], and the row of each."""

    left: FloatArray
    right: FloatArray
    owner: IntArray


EDGE = 1e-13
"""Ends of an interval this near to a dish's edge, in its semi-axes, are the edge: rounding of face coordinates."""


@njit(cache=True)
def interval_room(rows: int) -> Intervals:
    """Return room for the intervals of so many rows."""
    return Intervals(np.empty(rows), np.empty(rows), np.empty(rows, np.int64))


@njit(cache=True)
def active_pits(x: float, pits: FloatArray, active: IntArray) -> int:
    """Write the rows whose height range holds x into `active` and return their number.

    A trapezoid holds its lowest height and not its highest, so that the trapezoids of a polygon leave no height out.
    """
    count = 0
    for i in range(pits.shape[0]):
        if pits[i, LOWEST] < x < pits[i, HIGHEST] or (x == pits[i, LOWEST] and pits[i, TRAPEZOID] != 0.0):
            active[count] = i
            count += 1
    return count


@njit(cache=True)
def add_intervals(
    x: float, pits: FloatArray, active: IntArray, count: int, face_width: float, intervals: Intervals, filled: int
) -> int:
    """Insert the active rows' intervals, clipped to the face, into lists sorted by `left`; return their number.

    A trapezoid's sides go on beyond its ends: at the end of a piece its interval is the limit from inside.
    """
    left, right, owner = intervals
    for position in range(count):
        i = active[position]
        if pits[i, TRAPEZOID] != 0.0:
            share = (x - pits[i, LOWEST]) / (pits[i, HIGHEST] - pits[i, LOWEST])
            low = max(pits[i, LEFT_LOW] + share * (pits[i, LEFT_HIGH] - pits[i, LEFT_LOW]), 0.0)
            high = min(pits[i, RIGHT_LOW] + share * (pits[i, RIGHT_HIGH] - pits[i, RIGHT_LOW]), face_width)
        else:
            mu, w, a, b = pits[i, HEIGHT], pits[i, FACE], pits[i, SEMI_FACE], pits[i, SEMI_HEIGHT]
            if not mu - b < x < mu + b:
                continue
            u = (x - mu) / b
            reach = a * sqrt(max((1.0 - u) * (1.0 + u), 0.0))
            low, high = max(w - reach, 0.0), min(w + reach, face_width)
        if high <= low:
            continue
        k = filled
        while k > 0 and left[k - 1] > low:
            left[k], right[k], owner[k] = left[k - 1], right[k - 1], owner[k - 1]
            k -= 1
        left[k], right[k], owner[k] = low, high, i
        filled += 1
    return filled


@njit(cache=True)
def covered_length(intervals: Intervals, count: int) -> float:
    """Return the length of the union of intervals that are sorted by `left`."""
    left, right, _ = intervals
    length = 0.0
    end = -np.inf
    for k in range(count):
        if left[k] > end:
            length += right[k] - left[k]
            end = right[k]
        elif right[k] > end:
            length += right[k] - end
            end = right[k]
    return length


@njit(cache=True)
def curved(pits: FloatArray, i: int) -> bool:
    """Whether the depth of row i changes across the face."""
    return bool(pits[i, DISH] != 0.0 and pits[i, TRAPEZOID] == 0.0)


@njit(cache=True)
def level_depth(x: float, pits: FloatArray, i: int) -> float:
    """Return the depth at height x of a row whose depth does not change across the face [m]."""
    if pits[i, DISH] == 0.0:
        return float(pits[i, DEPTH])
    u = (x - pits[i, HEIGHT]) / pits[i, SEMI_HEIGHT]
    return float(pits[i, DEPTH] * sqrt(max((1.0 - u) * (1.0 + u), 0.0)))


@njit(cache=True)
def square_depth(x: float, w: float, pits: FloatArray, i: int) -> float:
    """Return the squared depth of row i at a point inside its outline [m2]."""
    square = pits[i, DEPTH] * pits[i, DEPTH]
    if pits[i, DISH] == 0.0:
        return float(square)
    u, v = (x - pits[i, HEIGHT]) / pits[i, SEMI_HEIGHT], (w - pits[i, FACE]) / pits[i, SEMI_FACE]
    if pits[i, TRAPEZOID] != 0.0:
        v = 0.0
    dished: float = square * max((1.0 - u) * (1.0 + u) - v * v, 0.0)
    return dished


@njit(cache=True)
def _add_piece(x: float, low: float, high: float, pits: FloatArray, i: int, moments: FloatArray) -> None:
    """Add int D dw, int D^2 dw, int D^3 dw of row i over [low, high]."""
    depth = pits[i, DEPTH]
    if not curved(pits, i):
        depth = level_depth(x, pits, i)
        span = high - low
        moments[0] += depth * span
        moments[1] += depth * depth * span
        moments[2] += depth * depth * depth * span
        return
    u, scale = (x - pits[i, HEIGHT]) / pits[i, SEMI_HEIGHT], depth * pits[i, SEMI_FACE]
    square = max((1.0 - u) * (1.0 + u), 0.0)
    reach = sqrt(square)
    if reach == 0.0:
        return
    for sign, end in ((1.0, high), (-1.0, low)):
        v = (end - pits[i, FACE]) / pits[i, SEMI_FACE]
        if abs(v) > reach - EDGE:
            # The edge itself: what is left out beside it is the 1.5th power of its distance.
            v, root = (reach, 0.0) if v > 0.0 else (-reach, 0.0)
            cap = 0.25 * pi * square if v > 0.0 else -0.25 * pi * square
        else:
            root = sqrt((reach - v) * (reach + v))
            # The angle from v and root: asin(v / reach) would lose half the digits at a dish's edge.
            cap = 0.5 * (v * root + square * atan2(v, root))
        moments[0] += sign * scale * cap
        moments[1] += sign * scale * depth * (square * v - v * v * v / 3.0)
        moments[2] += sign * scale * depth * depth * (0.25 * v * root * root * root + 0.75 * square * cap)


@entry(cache=True)
def _depth_crossings(x: float, pits: FloatArray, i: int, j: int) -> tuple[float, float]:
    """Return the face coordinates where rows i and j are equally deep, ascending; NaN where there are none.

    Roots of a quadratic about the centre of i.
    """
    c2 = c1 = c0 = 0.0
    for sign, k in ((1.0, i), (-1.0, j)):
        square = sign * pits[k, DEPTH] * pits[k, DEPTH]
        if pits[k, DISH] == 0.0:
            c0 += square
        elif pits[k, TRAPEZOID] != 0.0:
            u = (x - pits[k, HEIGHT]) / pits[k, SEMI_HEIGHT]
            c0 += square * (1.0 - u) * (1.0 + u)
        else:
            u, shift = (x - pits[k, HEIGHT]) / pits[k, SEMI_HEIGHT], pits[k, FACE] - pits[i, FACE]
            curve = square / (pits[k, SEMI_FACE] * pits[k, SEMI_FACE])
            c2 -= curve
            c1 += 2.0 * curve * shift
            c0 += square * (1.0 - u) * (1.0 + u) - curve * shift * shift
    if c2 == 0.0:
        return (pits[i, FACE] - c0 / c1, np.nan) if c1 != 0.0 else (np.nan, np.nan)
    discriminant = c1 * c1 - 4.0 * c2 * c0
    if discriminant <= 0.0:
        return np.nan, np.nan
    q = -0.5 * (c1 + (sqrt(discriminant) if c1 >= 0.0 else -sqrt(discriminant)))
    if q == 0.0:
        return pits[i, FACE], np.nan
    one, two = pits[i, FACE] + q / c2, pits[i, FACE] + c0 / q
    return min(one, two), max(one, two)


@njit(cache=True)
def stretch_room(pits: int) -> FloatArray:
    """Return the working room that `depth_moments` needs for so many rows: start, end and deepest row of stretches.

    Twice, and 16 stretches for each row: curves that cross twice at most (Davenport and Schinzel, order 4) make fewer
    for any number of rows that a computer holds.
    """
    return np.empty((6, 16 * pits + 64))


@njit(cache=True)
def _append(x: float, pits: FloatArray, low: float, high: float, i: int, stretches: FloatArray, count: int) -> int:
    """Append a stretch whose deepest row is i, or lengthen the last one where its depth goes on; return how many."""
    if high <= low:
        return count
    if count > 0:
        j = int(stretches[2, count - 1])
        if i == j or (not (curved(pits, i) or curved(pits, j)) and level_depth(x, pits, i) == level_depth(x, pits, j)):
            stretches[1, count - 1] = high
            return count
    if count >= stretches.shape[1]:
        raise IndexError("more stretches of depth in one section than any union of ellipses and trapezoids has")
    stretches[0, count], stretches[1, count], stretches[2, count] = low, high, i
    return count + 1


@njit(cache=True)
def _append_deeper(
    x: float, pits: FloatArray, low: float, high: float, i: int, j: int, stretches: FloatArray, count: int
) -> int:
    """Append [low, high] split where rows i and j are equally deep, each part to the deeper one; return how many."""
    curved_i, curved_j = curved(pits, i), curved(pits, j)
    if not curved_i and (not curved_j or level_depth(x, pits, i) >= pits[j, DEPTH]):
        deeper = j if not curved_j and level_depth(x, pits, j) >= level_depth(x, pits, i) else i
        return _append(x, pits, low, high, deeper, stretches, count)
    if not curved_j and level_depth(x, pits, j) >= pits[i, DEPTH]:
        return _append(x, pits, low, high, j, stretches, count)
    one, two = _depth_crossings(x, pits, i, j)
    start = low
    for cut in (one, two, high):
        stop = cut if low < cut < high else (high if cut == high else start)
        if stop > start:
            middle = 0.5 * (start + stop)
            deeper = i if square_depth(x, middle, pits, i) > square_depth(x, middle, pits, j) else j
            count = _append(x, pits, start, stop, deeper, stretches, count)
            start = stop
    return count


@njit(cache=True)
def _add_cluster(
    x: float, pits: FloatArray, intervals: Intervals, first: int, last: int, stretches: FloatArray, moments: FloatArray
) -> None:
    """Add the moments of intervals first..last-1, an overlapping chain, stretch by stretch of its deepest row.

    Intervals come sorted by their left ends, so each one meets only the last few stretches of those before.
    """
    left, right, owner = intervals
    count = 0
    for k in range(first, last):
        low, high, i = left[k], right[k], owner[k]
        start = count
        while start > 0 and stretches[1, start - 1] > low:
            start -= 1
        met = count - start
        end = stretches[1, count - 1] if count > 0 else low
        for q in range(met):
            for part in range(3):
                stretches[3 + part, q] = stretches[part, start + q]
        count = start
        for q in range(met):
            head, tail, j = stretches[3, q], stretches[4, q], int(stretches[5, q])
            begin, stop = max(head, low), min(tail, high)
            count = _append(x, pits, head, min(tail, begin), j, stretches, count)
            if stop > begin:
                count = _append_deeper(x, pits, begin, stop, i, j, stretches, count)
            count = _append(x, pits, max(stop, begin), tail, j, stretches, count)
        count = _append(x, pits, max(end, low), high, i, stretches, count)
    for q in range(count):
        _add_piece(x, stretches[0, q], stretches[1, q], pits, int(stretches[2, q]), moments)


@njit(cache=True)
def depth_moments(
    x: float, pits: FloatArray, intervals: Intervals, count: int, stretches: FloatArray, moments: FloatArray
) -> None:
    """Write int D dw [m2], int D^2 dw [m3] and int D^3 dw [m4] of the union of the intervals into `moments` (3,).

    `stretches` is working room, `stretch_room(number of rows)`.
    """
    left, right, owner = intervals
    moments[:] = 0.0
    uniform = True
    depth = level_depth(x, pits, owner[0]) if count > 0 else 0.0
    for k in range(count):
        if curved(pits, owner[k]) or level_depth(x, pits, owner[k]) != depth:
            uniform = False
            break
    if count > 0 and uniform:
        length = covered_length(intervals, count)
        moments[0] = depth * length
        moments[1] = depth * depth * length
        moments[2] = depth * depth * depth * length
        return
    first = 0
    while first < count:
        last, end = first + 1, right[first]
        while last < count and left[last] < end:
            end = max(end, right[last])
            last += 1
        if last == first + 1:
            _add_piece(x, left[first], right[first], pits, owner[first], moments)
        else:
            _add_cluster(x, pits, intervals, first, last, stretches, moments)
        first = last


@entry(cache=True)
def lengths_covered(
    heights_one: FloatArray, pits_one: FloatArray, heights_two: FloatArray, pits_two: FloatArray, face_width: float
) -> FloatArray:
    """Return the face length that the pits of two mating flanks cover together at each contact (k,) [m].

    The two flanks share the face coordinate; give one of them no rows (0, 13) for the loss of a single flank.
    """
    room = pits_one.shape[0] + pits_two.shape[0]
    intervals, active = interval_room(room), np.empty(room, np.int64)
    out = np.zeros(heights_one.size)
    for i in range(heights_one.size):
        count = active_pits(heights_one[i], pits_one, active)
        filled = add_intervals(heights_one[i], pits_one, active, count, face_width, intervals, 0)
        count = active_pits(heights_two[i], pits_two, active)
        filled = add_intervals(heights_two[i], pits_two, active, count, face_width, intervals, filled)
        out[i] = covered_length(intervals, filled)
    return out


# Compiled test whether a point of a flank shows in the depth field or lies hidden under a deeper damage.
#
# Derived. Where a third row strictly covers a crossing of two rows and is deeper there (flat ones: at least as deep),
# neither the depth field nor the covered length changes its form at that crossing.

INSIDE = 1e-6
"""How far inside an outline, relative to its size, a point counts as covered: what is nearer stays a kink."""
DEEPER = 1e-6
"""By how much of its square a dish must be deeper: its depth varies about the point."""


@njit(cache=True)
def strictly_inside(x: float, w: float, row: FloatArray) -> bool:
    """Whether a point lies inside the outline of a row and not near it."""
    if row[TRAPEZOID] == 0.0:
        u, v = (x - row[HEIGHT]) / row[SEMI_HEIGHT], (w - row[FACE]) / row[SEMI_FACE]
        return bool(u * u + v * v < 1.0 - INSIDE)
    span = row[HIGHEST] - row[LOWEST]
    share, margin = (x - row[LOWEST]) / span, INSIDE * row[SEMI_FACE]
    if not INSIDE < share < 1.0 - INSIDE:
        return False
    left, right = (
        row[LEFT_LOW] + share * (row[LEFT_HIGH] - row[LEFT_LOW]),
        row[RIGHT_LOW] + share * (row[RIGHT_HIGH] - row[RIGHT_LOW]),
    )
    return bool(left + margin < w < right - margin)


@njit(cache=True)
def edge_square(x: float, w: float, pits: FloatArray, i: int) -> float:
    """Return the squared depth of row i at a point of its outline, seen from inside: an elliptic dish has none [m2]."""
    return 0.0 if curved(pits, i) else square_depth(x, w, pits, i)


@njit(cache=True)
def hidden_by(x: float, w: float, square: float, pits: FloatArray, k: int) -> bool:
    """Whether row k hides what has the squared depth `square` at a point."""
    if not strictly_inside(x, w, pits[k]):
        return False
    own = square_depth(x, w, pits, k)
    return own >= square if pits[k, DISH] == 0.0 else own > square * (1.0 + DEEPER) + DEEPER * pits[k, DEPTH] ** 2


class Strips(NamedTuple):
    """Rows by strips of the face from `low_m` on, `width_m` each; strip s has rows[first[s] : first[s + 1]]."""

    rows: IntArray
    first: IntArray
    low_m: float
    width_m: float


@entry(cache=True)
def strips_of(pits: FloatArray) -> Strips:
    """Return which rows reach into strips of the face, as many strips as rows."""
    left, right = np.empty(pits.shape[0]), np.empty(pits.shape[0])
    for i in range(pits.shape[0]):
        row = pits[i]
        left[i], right[i] = row[FACE] - row[SEMI_FACE], row[FACE] + row[SEMI_FACE]
        if row[TRAPEZOID] != 0.0:
            left[i], right[i] = min(row[LEFT_LOW], row[LEFT_HIGH]), max(row[RIGHT_LOW], row[RIGHT_HIGH])
    count = max(pits.shape[0], 1)
    low, high = (left.min(), right.max()) if left.size > 0 else (0.0, 1.0)
    strips = Strips(np.empty(0, np.int64), np.zeros(count + 1, np.int64), low, (high - low) / count)
    for i in range(pits.shape[0]):
        for strip in range(strip_at(strips, left[i]), strip_at(strips, right[i]) + 1):
            strips.first[strip + 1] += 1
    for strip in range(count):
        strips.first[strip + 1] += strips.first[strip]
    rows, filled = np.empty(strips.first[count], np.int64), strips.first.copy()
    for i in range(pits.shape[0]):
        for strip in range(strip_at(strips, left[i]), strip_at(strips, right[i]) + 1):
            rows[filled[strip]] = i
            filled[strip] += 1
    return Strips(rows, strips.first, low, strips.width_m)


@njit(cache=True)
def strip_at(strips: Strips, w: float) -> int:
    """Return the strip that holds a place across the face; places beside all strips count to the nearest one."""
    last = strips.first.size - 2
    place = (w - strips.low_m) / strips.width_m if strips.width_m > 0.0 else 0.0
    return int(min(max(place, 0.0), float(last)))


@njit(cache=True)
def shows(x: float, w: float, square: float, pits: FloatArray, strips: Strips, i: int, j: int) -> bool:
    """Whether no third row hides what rows i and j do at a point; a point without face coordinate (NaN) shows."""
    if isnan(w):
        return True
    strip = strip_at(strips, w)
    for place in range(strips.first[strip], strips.first[strip + 1]):
        k = strips.rows[place]
        if k not in (i, j) and hidden_by(x, w, square, pits, k):
            return False
    return True


@njit(cache=True)
def segment_shows(x: float, left: float, right: float, square: float, pits: FloatArray, strips: Strips, i: int) -> bool:
    """Whether no other flat row hides the whole segment across the face on which row i ends (outlines are convex)."""
    strip = strip_at(strips, left)
    for place in range(strips.first[strip], strips.first[strip + 1]):
        k = strips.rows[place]
        both = k != i and pits[k, DISH] == 0.0 and hidden_by(x, left, square, pits, k)
        if both and hidden_by(x, right, square, pits, k):
            return False
    return True
