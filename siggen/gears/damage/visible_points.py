"""Compiled test whether a point of a flank shows in the depth field or lies hidden under a deeper damage.

Derived. Where a third row strictly covers a crossing of two rows and is deeper there (flat ones: at least as deep),
neither the depth field nor the covered length changes its form at that crossing.
"""

from __future__ import annotations

from math import isnan
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.gears.damage.row_columns import (
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
from siggen.gears.damage.union import curved, square_depth

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
