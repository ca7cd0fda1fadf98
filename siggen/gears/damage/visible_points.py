"""Compiled test whether a point of a flank shows in the depth field or lies hidden under a deeper damage.

Derived. Where a third row strictly covers a crossing of two rows and is deeper there (flat ones: at least as deep),
neither the depth field nor the covered length changes its form at that crossing.
"""

from __future__ import annotations

from math import isnan

from siggen.arrays import FloatArray
from siggen.compiled import njit
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


@njit(cache=True)
def shows(x: float, w: float, square: float, pits: FloatArray, i: int, j: int) -> bool:
    """Whether no third row hides what rows i and j do at a point; a point without face coordinate (NaN) shows."""
    if isnan(w):
        return True
    for k in range(pits.shape[0]):  # noqa: SIM110 - compiled: a generator costs more than the loop
        if k not in (i, j) and hidden_by(x, w, square, pits, k):
            return False
    return True


@njit(cache=True)
def segment_shows(x: float, left: float, right: float, square: float, pits: FloatArray, i: int) -> bool:
    """Whether no other flat row hides the whole segment across the face on which row i ends (outlines are convex)."""
    for k in range(pits.shape[0]):
        both = k != i and pits[k, DISH] == 0.0 and hidden_by(x, left, square, pits, k)
        if both and hidden_by(x, right, square, pits, k):
            return False
    return True
