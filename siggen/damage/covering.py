"""Compiled test whether one damage hides another: the hidden one changes neither contact length nor depth field.

Derived. Sufficient conditions: a hidden row that is not recognised costs time only. Rows are those of
`siggen.damage.flank_damage.pit_rows`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
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

Row: TypeAlias = tuple[float, ...]


@entry(cache=True)
def _sides_at(row: FloatArray, x: float) -> tuple[float, float]:
    share = (x - row[LOWEST]) / (row[HIGHEST] - row[LOWEST])
    return row[LEFT_LOW] + share * (row[LEFT_HIGH] - row[LEFT_LOW]), row[RIGHT_LOW] + share * (
        row[RIGHT_HIGH] - row[RIGHT_LOW]
    )


@njit(cache=True)
def _contains_point(one: FloatArray, x: float, w: float) -> bool:
    u, v = (x - one[HEIGHT]) / one[SEMI_HEIGHT], (w - one[FACE]) / one[SEMI_FACE]
    return bool(u * u + v * v <= 1.0)


@njit(cache=True)
def _outline_contains(one: FloatArray, two: FloatArray) -> bool:
    """Whether the outline of row `one` holds that of row `two`; two ellipses of unlike shape only where it is plain."""
    if two[LOWEST] < one[LOWEST] or two[HIGHEST] > one[HIGHEST]:
        return False
    if one[TRAPEZOID] == 0.0 and two[TRAPEZOID] == 0.0:
        u, v = (two[HEIGHT] - one[HEIGHT]) / one[SEMI_HEIGHT], (two[FACE] - one[FACE]) / one[SEMI_FACE]
        return bool(
            sqrt(u * u + v * v) + max(two[SEMI_HEIGHT] / one[SEMI_HEIGHT], two[SEMI_FACE] / one[SEMI_FACE]) <= 1.0
        )
    if one[TRAPEZOID] == 0.0:
        low = _contains_point(one, two[LOWEST], two[LEFT_LOW]) and _contains_point(one, two[LOWEST], two[RIGHT_LOW])
        return (
            low
            and _contains_point(one, two[HIGHEST], two[LEFT_HIGH])
            and _contains_point(one, two[HIGHEST], two[RIGHT_HIGH])
        )
    if two[TRAPEZOID] == 0.0:
        left, right = _sides_at(one, two[HEIGHT])
        span = one[HIGHEST] - one[LOWEST]
        lean_left, lean_right = (
            (one[LEFT_HIGH] - one[LEFT_LOW]) / span * two[SEMI_HEIGHT],
            (one[RIGHT_HIGH] - one[RIGHT_LOW]) / span * two[SEMI_HEIGHT],
        )
        from_left = two[FACE] - left - sqrt(two[SEMI_FACE] * two[SEMI_FACE] + lean_left * lean_left)
        return bool(
            from_left >= 0.0
            and right - two[FACE] - sqrt(two[SEMI_FACE] * two[SEMI_FACE] + lean_right * lean_right) >= 0.0
        )
    left_low, right_low = _sides_at(one, two[LOWEST])
    left_high, right_high = _sides_at(one, two[HIGHEST])
    return bool(
        left_low <= two[LEFT_LOW]
        and left_high <= two[LEFT_HIGH]
        and right_low >= two[RIGHT_LOW]
        and right_high >= two[RIGHT_HIGH]
    )


@njit(cache=True)
def _square_excess(one: FloatArray, two: FloatArray, x: float) -> float:
    """Return the difference of the squared depths of two dishes without curvature across the face."""
    u, v = (x - one[HEIGHT]) / one[SEMI_HEIGHT], (x - two[HEIGHT]) / two[SEMI_HEIGHT]
    return float(one[DEPTH] ** 2 * (1.0 - u) * (1.0 + u) - two[DEPTH] ** 2 * (1.0 - v) * (1.0 + v))


@entry(cache=True)
def hides(one: FloatArray, two: FloatArray) -> bool:
    """Whether row `one` is at least as deep as row `two` everywhere inside the outline of `two`."""
    if one[DEPTH] < two[DEPTH] or not _outline_contains(one, two):
        return False
    if one[DISH] == 0.0 or two[DISH] == 0.0 or one[TRAPEZOID] != two[TRAPEZOID]:
        return bool(one[DISH] == 0.0)
    if one[TRAPEZOID] == 0.0:
        # Concentric: the difference of squares is linear in the squared distances, so three corners decide.
        return bool(one[HEIGHT] == two[HEIGHT] and one[FACE] == two[FACE])
    # A quadratic of the height: its ends, and its vertex where it is convex.
    curve = two[DEPTH] ** 2 / two[SEMI_HEIGHT] ** 2 - one[DEPTH] ** 2 / one[SEMI_HEIGHT] ** 2
    if _square_excess(one, two, two[LOWEST]) < 0.0 or _square_excess(one, two, two[HIGHEST]) < 0.0:
        return False
    if curve <= 0.0:
        return True
    vertex = (
        two[HEIGHT] * two[DEPTH] ** 2 / two[SEMI_HEIGHT] ** 2 - one[HEIGHT] * one[DEPTH] ** 2 / one[SEMI_HEIGHT] ** 2
    ) / curve
    return not two[LOWEST] < vertex < two[HIGHEST] or _square_excess(one, two, vertex) >= 0.0


def cut_row(row: FloatArray, heights_m: FloatArray) -> list[FloatArray]:
    """Return a trapezoid as the pieces (14,) between heights; an ellipse, or what none of them cuts, as it is.

    A polygon is several trapezoids, of which none may hold all of another polygon: its pieces may lie in one each.
    """
    inside = np.unique(heights_m[(heights_m > row[LOWEST]) & (heights_m < row[HIGHEST])])
    if row[TRAPEZOID] == 0.0 or not inside.size:
        return [row]
    ends = [row[LOWEST], *inside, row[HIGHEST]]
    pieces = []
    for low, high in pairwise(ends):
        piece = row.copy()
        piece[LOWEST], piece[HIGHEST] = low, high
        piece[LEFT_LOW], piece[RIGHT_LOW] = _sides_at(row, low)
        piece[LEFT_HIGH], piece[RIGHT_HIGH] = _sides_at(row, high)
        pieces.append(piece)
    return pieces


def holds(own: Sequence[Row], other: Sequence[Row]) -> bool:
    """Return whether all of `other` lies inside rows of `own` that are nowhere less deep; False where it is unsure."""
    rows = np.array(own)
    ends = rows[:, (LOWEST, HIGHEST)].ravel()
    pieces = (piece for row in np.array(other) for piece in cut_row(row, ends))
    return all(any(hides(larger, piece) for larger in rows) for piece in pieces)


@entry(cache=True)
def hidden_rows(rows: FloatArray) -> NDArray[np.bool_]:
    """Return which rows (n, 14), all different, another one hides (n,)."""
    count = rows.shape[0]
    out = np.zeros(count, np.bool_)
    for i in range(count):
        for k in range(count):
            # What `hides` asks first, without taking rows out of the table.
            if (
                rows[k, LOWEST] > rows[i, LOWEST]
                or rows[k, HIGHEST] < rows[i, HIGHEST]
                or rows[k, DEPTH] < rows[i, DEPTH]
            ):
                continue
            # Of two that hide each other (outlines equal but for rounding) the first stays.
            if k != i and not out[k] and hides(rows[k], rows[i]) and (k < i or not hides(rows[i], rows[k])):
                out[i] = True
                break
    return out
