"""Heights at which the section of a damaged tooth changes its form: where its integrals must be split.

Derived. Section quantities are smooth in x between: the lowest and highest points of each outline, crossings of two
outlines, crossings of an outline with the ends of the face, and, where a dish meets another depth, the same points of
the curve of equal depth. Two ellipses with semi-axes along w of P_i = a_i^2 (1 - u_i^2) cross where (P_1 - P_2 +
D^2)^2 = 4 D^2 P_1, D = w_2 - w_1: a quartic. Points that a deeper damage hides are left out.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

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
from siggen.damage.straight_edges import Conic, corner_points, side_conic_points, side_side_points
from siggen.damage.union import Strips, edge_square, segment_shows, shows, square_depth, strips_of

MERGED_M = 1e-16
"""Kinks nearer than this are one: rounding of a crossing, and 1e-13 of the height of a tooth."""


@njit(cache=True)
def _value(poly: FloatArray, degree: int, t: float) -> float:
    total: float = poly[degree]
    for power in range(degree - 1, -1, -1):
        total = total * t + poly[power]
    return total


@njit(cache=True)
def _bisect(poly: FloatArray, degree: int, low: float, high: float) -> float:
    rising = _value(poly, degree, high) > 0.0
    for _ in range(70):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if (_value(poly, degree, middle) > 0.0) == rising:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


@entry(cache=True)
def roots_between(poly: FloatArray, low: float, high: float, touching: float) -> FloatArray:
    """Return the real roots of a polynomial (coefficients from power 0, degree <= 8) within [low, high], ascending.

    Between two neighbouring roots of the derivative a polynomial is monotone, so the roots of all derivatives,
    highest first, bracket every root: no complex arithmetic and no lost root. A turning point with abs(value) <=
    `touching` counts as a root.
    """
    degree = poly.size - 1
    derivative = poly.copy()
    ladder = np.zeros((degree + 1, degree + 1))
    ladder[degree, : degree + 1] = derivative
    for level in range(degree - 1, 0, -1):
        for power in range(level + 1):
            ladder[level, power] = ladder[level + 1, power + 1] * (power + 1)
    turns = np.empty(degree + 2)
    found = np.empty(2 * degree + 2)
    count = 0
    for level in range(1, degree + 1):
        marks = count
        for k in range(count):
            turns[k + 1] = found[k]
        turns[0], turns[marks + 1] = low, high
        count = 0
        for k in range(marks + 1):
            start, stop = turns[k], turns[k + 1]
            at_start = _value(ladder[level], level, start)
            at_stop = _value(ladder[level], level, stop)
            if (at_start > 0.0) != (at_stop > 0.0):
                found[count] = _bisect(ladder[level], level, start, stop)
                count += 1
            elif level == degree and k > 0 and abs(at_start) <= touching:
                found[count] = start
                count += 1
    return found[:count].copy()


class PitEllipse(NamedTuple):
    """Height and face coordinate of the centre, semi-axis across and semi-axis along the height [m]."""

    mu: float
    w: float
    a: float
    b: float


@njit(cache=True)
def _outline(row: FloatArray) -> PitEllipse:
    return PitEllipse(row[HEIGHT], row[FACE], row[SEMI_FACE], row[SEMI_HEIGHT])


@njit(cache=True)
def _ellipse_points(one: PitEllipse, two: PitEllipse, points: list[tuple[float, float]]) -> None:
    """Append the points where two ellipse outlines cross; in t = (x - mu)/b over their common height range."""
    (mu, w, a, b), (mu2, w2, a2, b2) = one, two
    low, high = max(mu - b, mu2 - b2), min(mu + b, mu2 + b2)
    gap = abs(w2 - w)
    if high <= low or gap >= a + a2:
        return
    shift, stretch = (mu - mu2) / b2, b / b2
    ratio = (a2 / a) ** 2
    distance = (w2 - w) / a
    # N(t) = (P1 - P2 + D^2)/a^2 with P1/a^2 = 1 - t^2 and P2/a^2 = ratio (1 - (shift + stretch t)^2)
    n0 = 1.0 - ratio * (1.0 - shift * shift) + distance * distance
    n1 = 2.0 * ratio * shift * stretch
    n2 = ratio * stretch * stretch - 1.0
    four = 4.0 * distance * distance
    quartic = np.array([n0 * n0 - four, 2.0 * n0 * n1, n1 * n1 + 2.0 * n0 * n2 + four, 2.0 * n1 * n2, n2 * n2])
    first, last = (low - mu) / b, (high - mu) / b
    size = abs(n0) + abs(n1) + abs(n2)
    for t in roots_between(quartic, first, last, 1e-12 * (size * size + four)):
        _points_at(t, one, two, points)
    # Columns one above the other: the quartic is (nearly) a square, whose roots rounding can hide. Extra kinks do no
    # harm.
    if abs(distance) < 1e-5:
        for t in roots_between(np.array([n0, n1, n2]), first, last, 1e-12 * size):
            _points_at(t, one, two, points)


@njit(cache=True)
def _points_at(t: float, one: PitEllipse, two: PitEllipse, points: list[tuple[float, float]]) -> None:
    """Append the points of a crossing's height where the outlines (nearly) meet; without face coordinate if none do."""
    (mu, w, a, b), (mu2, w2, a2, b2) = one, two
    x = mu + b * t
    u = (x - mu2) / b2
    reach, reach2 = a * sqrt(max((1.0 - t) * (1.0 + t), 0.0)), a2 * sqrt(max((1.0 - u) * (1.0 + u), 0.0))
    found = False
    for side in (-1.0, 1.0):
        at = w + side * reach
        # Steep near an ellipse's ends: a root's rounding becomes its square root.
        if min(abs(at - w2 - reach2), abs(at - w2 + reach2)) <= 1e-4 * (a + a2):
            points.append((x, at))
            found = True
    if not found:
        points.append((x, np.nan))


@njit(cache=True)
def _face_points(ellipse: PitEllipse, face_width: float, points: list[tuple[float, float]]) -> None:
    """Append the points where an ellipse outline leaves the face."""
    mu, w, a, b = ellipse
    for end in (0.0, face_width):
        v = (end - w) / a
        if abs(v) < 1.0:
            u = sqrt((1.0 - v) * (1.0 + v))
            points.append((mu - b * u, end))
            points.append((mu + b * u, end))


@njit(cache=True)
def _crossing_points(one: FloatArray, two: FloatArray, points: list[tuple[float, float]]) -> None:
    """Append the points where the outlines of two rows cross."""
    if one[TRAPEZOID] == 0.0 and two[TRAPEZOID] == 0.0:
        _ellipse_points(_outline(one), _outline(two), points)
    elif one[TRAPEZOID] != 0.0 and two[TRAPEZOID] != 0.0:
        side_side_points(one, two, points)
    else:
        ellipse, trapezoid = (one, two) if one[TRAPEZOID] == 0.0 else (two, one)
        _ellipse_side_points(_outline(ellipse), trapezoid, points)


@njit(cache=True)
def _ellipse_side_points(ellipse: PitEllipse, trapezoid: FloatArray, points: list[tuple[float, float]]) -> None:
    mu, w, a, b = ellipse
    low, high = max(mu - b, trapezoid[LOWEST]), min(mu + b, trapezoid[HIGHEST])
    square = (a / b) ** 2
    # (w - w_i)^2 + (a/b)^2 (x - mu)^2 - a^2 = 0 about the ellipse's centre
    side_conic_points(trapezoid, Conic(mu, w, 1.0, 0.0, -a * a, 0.0, square), low, high, points)


@njit(cache=True)
def _equal_depth_points(  # noqa: PLR0912 - one curve, all its kinds of points
    one: FloatArray, two: FloatArray, face_width: float, points: list[tuple[float, float]]
) -> None:
    """Append lowest, highest and edge points of the curve on which two rows, at least one a dish, are equally deep."""
    low, high = max(one[LOWEST], two[LOWEST]), min(one[HIGHEST], two[HIGHEST])
    if one[DISH] == 0.0 or two[DISH] == 0.0:
        dish, flat = (two, one) if one[DISH] == 0.0 else (one, two)
        if flat[DEPTH] >= dish[DEPTH]:
            return
        scale = sqrt(1.0 - (flat[DEPTH] / dish[DEPTH]) ** 2)
        ellipse = PitEllipse(dish[HEIGHT], dish[FACE], scale * dish[SEMI_FACE], scale * dish[SEMI_HEIGHT])
        mu, w, _, b = ellipse
        level = [(mu - b, w), (mu + b, w)]
        if dish[TRAPEZOID] != 0.0:
            level = [(mu - b, np.nan), (mu + b, np.nan)]
        else:
            _face_points(ellipse, face_width, level)
            if flat[TRAPEZOID] == 0.0:
                _ellipse_points(ellipse, _outline(flat), level)
            else:
                _ellipse_side_points(ellipse, flat, level)
        for point in level:
            # A kink outside the shared heights would split sections that the upper row must not touch.
            if low < point[0] < high:
                points.append(point)
        return
    # c2 w^2 + c1 w + c0(x) = 0, c0 = k0 + k1 x + k2 x^2 about the first centre: vertical tangents and the ends of the
    # face, and the sides of trapezoids, where a dish has a depth
    c2 = c1 = k0 = k1 = k2 = 0.0
    for sign, pit in ((1.0, one), (-1.0, two)):
        square = sign * pit[DEPTH] * pit[DEPTH]
        shift_w, shift_x = pit[FACE] - one[FACE], pit[HEIGHT] - one[HEIGHT]
        curve_w, curve_x = (
            square / pit[SEMI_FACE] ** 2 if pit[TRAPEZOID] == 0.0 else 0.0,
            square / pit[SEMI_HEIGHT] ** 2,
        )
        c2 -= curve_w
        c1 += 2.0 * curve_w * shift_w
        k2 -= curve_x
        k1 += 2.0 * curve_x * shift_x
        k0 += square - curve_w * shift_w**2 - curve_x * shift_x**2
    first, last = low - one[HEIGHT], high - one[HEIGHT]
    if c2 == 0.0 and c1 == 0.0:
        if k0 != 0.0 or k1 != 0.0 or k2 != 0.0:
            for x in roots_between(np.array([k0, k1, k2]), first, last, 0.0):
                points.append((one[HEIGHT] + x, np.nan))
        return
    if c2 != 0.0:
        turning = np.array([c1 * c1 - 4.0 * c2 * k0, -4.0 * c2 * k1, -4.0 * c2 * k2])
        for x in roots_between(turning, first, last, 0.0):
            points.append((one[HEIGHT] + x, one[FACE] - 0.5 * c1 / c2))
    for end in (0.0, face_width):
        v = end - one[FACE]
        for x in roots_between(np.array([c2 * v * v + c1 * v + k0, k1, k2]), first, last, 0.0):
            points.append((one[HEIGHT] + x, end))
    for row in (one, two):
        if row[TRAPEZOID] != 0.0:
            side_conic_points(row, Conic(one[HEIGHT], one[FACE], c2, c1, k0, k1, k2), low, high, points)


@njit(cache=True)
def _row_kinks(i: int, pits: FloatArray, strips: Strips, face_width: float, out: list[float]) -> None:
    """Append the heights where row i by itself begins, ends or leaves the face."""
    row = pits[i]
    points = [(0.0, 0.0)]
    points.pop()
    if row[TRAPEZOID] == 0.0:
        points.append((row[LOWEST], row[FACE]))
        points.append((row[HIGHEST], row[FACE]))
        _face_points(_outline(row), face_width, points)
    else:
        for x, left, right in (
            (row[LOWEST], row[LEFT_LOW], row[RIGHT_LOW]),
            (row[HIGHEST], row[LEFT_HIGH], row[RIGHT_HIGH]),
        ):
            if segment_shows(x, left, right, edge_square(x, left, pits, i), pits, strips, i):
                out.append(x)
        corner_points(row, face_width, points)
    for x, w in points:
        if shows(x, w, edge_square(x, w, pits, i), pits, strips, i, i):
            out.append(x)


def section_kinks(pits: FloatArray, face_width: float) -> FloatArray:
    """Return all heights where the section of a flank with `pits` (n, 14) changes its form, ascending (k,) [m]."""
    # numba's own unique costs a second of compilation
    return _merged(np.unique(_kinks(pits, strips_of(pits), face_width)))


@entry(cache=True)
def _kinks(pits: FloatArray, strips: Strips, face_width: float) -> FloatArray:
    """Return all kinks in any order, some of them twice."""
    out = [0.0]
    out.pop()
    points = [(0.0, 0.0)]
    for i in range(pits.shape[0]):
        one = pits[i]
        _row_kinks(i, pits, strips, face_width, out)
        for j in range(i):
            two = pits[j]
            apart = (
                max(one[LOWEST], two[LOWEST]) >= min(one[HIGHEST], two[HIGHEST])
                or abs(one[FACE] - two[FACE]) >= one[SEMI_FACE] + two[SEMI_FACE]
            )
            if apart:
                continue
            points.clear()
            _crossing_points(one, two, points)
            for x, w in points:
                if shows(x, w, max(edge_square(x, w, pits, i), edge_square(x, w, pits, j)), pits, strips, i, j):
                    out.append(x)
            if one[DISH] != 0.0 or two[DISH] != 0.0:
                points.clear()
                _equal_depth_points(one, two, face_width, points)
                for x, w in points:
                    if shows(x, w, square_depth(x, w, pits, i), pits, strips, i, j):
                        out.append(x)
    return np.array(out)


@entry(cache=True)
def _merged(kinks: FloatArray) -> FloatArray:
    """Return ascending kinks without those nearer than rounding to the one before."""
    keep = np.ones(kinks.size, np.bool_)
    last = -np.inf
    for k in range(kinks.size):
        keep[k] = kinks[k] - last > MERGED_M
        if keep[k]:
            last = kinks[k]
    return kinks[keep]
