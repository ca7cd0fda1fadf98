"""Compiled crossings of a trapezoid's straight sides with the face's ends, with other sides and with conics.

Derived. A side is w = p + m (x - x_low); put into a conic it leaves a quadratic of the height.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.damage.row_columns import HIGHEST, LEFT_HIGH, LEFT_LOW, LOWEST


@njit(cache=True)
def _side(row: FloatArray, right: int) -> tuple[float, float]:
    """Return p and m of the left (0) or right (1) side of a trapezoid."""
    start = row[LEFT_LOW + right]
    return start, (row[LEFT_HIGH + right] - start) / (row[HIGHEST] - row[LOWEST])


@njit(cache=True)
def corner_points(row: FloatArray, face_width: float, points: list[tuple[float, float]]) -> None:
    """Append the points where the sides of a trapezoid leave the face."""
    for right in range(2):
        start, slope = _side(row, right)
        if slope == 0.0:
            continue
        for end in (0.0, face_width):
            x = row[LOWEST] + (end - start) / slope
            if row[LOWEST] < x < row[HIGHEST]:
                points.append((x, end))


@njit(cache=True)
def side_side_points(one: FloatArray, two: FloatArray, points: list[tuple[float, float]]) -> None:
    """Append the points where the sides of two trapezoids cross."""
    low, high = max(one[LOWEST], two[LOWEST]), min(one[HIGHEST], two[HIGHEST])
    for right in range(2):
        start, slope = _side(one, right)
        for other in range(2):
            start2, slope2 = _side(two, other)
            if slope == slope2:
                continue
            # About the first one's lowest point: no difference of large products.
            x = one[LOWEST] + (start2 + slope2 * (one[LOWEST] - two[LOWEST]) - start) / (slope - slope2)
            if low <= x <= high:
                points.append((x, start + slope * (x - one[LOWEST])))


class Conic(NamedTuple):
    """The curve c2 v^2 + c1 v + k0 + k1 t + k2 t^2 = 0 with t = x - x0 and v = w - w0."""

    x0: float
    w0: float
    c2: float
    c1: float
    k0: float
    k1: float
    k2: float


@njit(cache=True)
def side_conic_points(
    row: FloatArray, conic: Conic, low: float, high: float, points: list[tuple[float, float]]
) -> None:
    """Append the points between two heights where the sides of a trapezoid cross a conic."""
    x0, w0, c2, c1, k0, k1, k2 = conic
    for right in range(2):
        start, slope = _side(row, right)
        offset = start + slope * (x0 - row[LOWEST]) - w0
        a = c2 * slope * slope + k2
        b = 2.0 * c2 * slope * offset + c1 * slope + k1
        c = c2 * offset * offset + c1 * offset + k0
        discriminant = b * b - 4.0 * a * c
        if discriminant < 0.0 or (a == 0.0 and b == 0.0):
            continue
        q = -0.5 * (b + (sqrt(discriminant) if b >= 0.0 else -sqrt(discriminant)))
        for top, bottom in ((q, a), (c, q)):
            if bottom != 0.0 and low <= x0 + top / bottom <= high:
                t = top / bottom
                points.append((x0 + t, start + slope * (x0 + t - row[LOWEST])))
