"""Compiled test whether one damage hides another: the hidden one changes neither contact length nor depth field.

Derived. Sufficient conditions: a hidden row that is not recognised costs time only. Rows are those of
`siggen.gears.damage.flank_damage.pit_rows`.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit
from numpy.typing import NDArray

from siggen.arrays import FloatArray


@njit(cache=True)
def _sides_at(row: FloatArray, x: float) -> tuple[float, float]:
    share = (x - row[7]) / (row[8] - row[7])
    return row[9] + share * (row[11] - row[9]), row[10] + share * (row[12] - row[10])


@njit(cache=True)
def _contains_point(one: FloatArray, x: float, w: float) -> bool:
    u, v = (x - one[0]) / one[3], (w - one[1]) / one[2]
    return bool(u * u + v * v <= 1.0)


@njit(cache=True)
def _outline_contains(one: FloatArray, two: FloatArray) -> bool:
    """Whether the outline of row `one` holds that of row `two`; two ellipses of unlike shape only where it is plain."""
    if two[7] < one[7] or two[8] > one[8]:
        return False
    if one[6] == 0.0 and two[6] == 0.0:
        u, v = (two[0] - one[0]) / one[3], (two[1] - one[1]) / one[2]
        return bool(sqrt(u * u + v * v) + max(two[3] / one[3], two[2] / one[2]) <= 1.0)
    if one[6] == 0.0:
        low = _contains_point(one, two[7], two[9]) and _contains_point(one, two[7], two[10])
        return low and _contains_point(one, two[8], two[11]) and _contains_point(one, two[8], two[12])
    if two[6] == 0.0:
        left, right = _sides_at(one, two[0])
        span = one[8] - one[7]
        lean_left, lean_right = (one[11] - one[9]) / span * two[3], (one[12] - one[10]) / span * two[3]
        from_left = two[1] - left - sqrt(two[2] * two[2] + lean_left * lean_left)
        return bool(from_left >= 0.0 and right - two[1] - sqrt(two[2] * two[2] + lean_right * lean_right) >= 0.0)
    left_low, right_low = _sides_at(one, two[7])
    left_high, right_high = _sides_at(one, two[8])
    return bool(left_low <= two[9] and left_high <= two[11] and right_low >= two[10] and right_high >= two[12])


@njit(cache=True)
def _square_excess(one: FloatArray, two: FloatArray, x: float) -> float:
    """Return the difference of the squared depths of two dishes without curvature across the face."""
    u, v = (x - one[0]) / one[3], (x - two[0]) / two[3]
    excess: float = one[4] ** 2 * (1.0 - u) * (1.0 + u) - two[4] ** 2 * (1.0 - v) * (1.0 + v)
    return excess


@njit(cache=True)
def hides(one: FloatArray, two: FloatArray) -> bool:
    """Whether row `one` is at least as deep as row `two` everywhere inside the outline of `two`."""
    if one[4] < two[4] or not _outline_contains(one, two):
        return False
    if one[5] == 0.0 or two[5] == 0.0 or one[6] != two[6]:
        return bool(one[5] == 0.0)
    if one[6] == 0.0:
        # Concentric: the difference of squares is linear in the squared distances, so three corners decide.
        return bool(one[0] == two[0] and one[1] == two[1])
    # A quadratic of the height: its ends, and its vertex where it is convex.
    curve = two[4] ** 2 / two[3] ** 2 - one[4] ** 2 / one[3] ** 2
    if _square_excess(one, two, two[7]) < 0.0 or _square_excess(one, two, two[8]) < 0.0:
        return False
    if curve <= 0.0:
        return True
    vertex = (two[0] * two[4] ** 2 / two[3] ** 2 - one[0] * one[4] ** 2 / one[3] ** 2) / curve
    return not two[7] < vertex < two[8] or _square_excess(one, two, vertex) >= 0.0


@njit(cache=True)
def hidden_rows(rows: FloatArray) -> NDArray[np.bool_]:
    """Return which rows (n, 13), all different, another one hides (n,)."""
    count = rows.shape[0]
    out = np.zeros(count, np.bool_)
    for i in range(count):
        for k in range(count):
            # Of two that hide each other (outlines equal but for rounding) the first stays.
            if k != i and not out[k] and hides(rows[k], rows[i]) and (k < i or not hides(rows[i], rows[k])):
                out[i] = True
                break
    return out
