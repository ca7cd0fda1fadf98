"""LineFunctions: polynomials along an edge of the box, those that neighbouring plates share and those within a plate.

On 0 <= x <= l: the four cubics with unit value or unit slope at one end, and bubbles whose value and slope vanish at
both ends. The second derivative of bubble k is the Legendre polynomial of degree k + 2, so that their stiffness in
bending is diagonal (reference: standard literature, hierarchical finite elements). Along a mirrored line all functions
are even or odd about its middle; then V and S stand for both ends at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.ordered_sums import squares

VALUE, SLOPE, BUBBLE = 0, 1, 2
"""Kinds of functions."""


@dataclass(frozen=True, slots=True)
class FunctionNames:
    """What the functions of a line are, each (functions,): kind, end (0, 1), parity (-1: neither), number of bubble.

    `end` is 0 on a mirrored line; `order` is 0 for all that are no bubbles.
    """

    kind: tuple[int, ...]
    end: tuple[int, ...]
    parity: tuple[int, ...]
    order: tuple[int, ...]

    def find(self, kind: int, end: int, parity: int) -> int:
        """Return the function of a kind at an end; on a mirrored line that of the parity."""
        wanted = (kind, end, parity if self.parity[0] >= 0 else -1)
        return next(i for i, name in enumerate(zip(self.kind, self.end, self.parity, strict=True)) if name == wanted)


def names(bubbles: int, mirrored: bool) -> FunctionNames:
    """Return what the functions of a line with so many bubbles are."""
    ends, parities = ((0, 0, 0, 0), (0, 1, 0, 1)) if mirrored else ((0, 1, 0, 1), (-1,) * 4)
    within = tuple(k % 2 if mirrored else -1 for k in range(bubbles))
    return FunctionNames(
        kind=(VALUE, VALUE, SLOPE, SLOPE, *(BUBBLE,) * bubbles),
        end=(*ends, *(0,) * bubbles),
        parity=(*parities, *within),
        order=(0, 0, 0, 0, *range(1, bubbles + 1)),
    )


@dataclass(frozen=True, slots=True)
class LineFunctions:
    """Functions along a line of the length [m], 4 + bubbles of them."""

    length_m: float
    bubbles: int
    mirrored: bool

    @property
    def names(self) -> FunctionNames:
        """What the functions are."""
        return names(self.bubbles, self.mirrored)

    def at(self, place_m: FloatArray) -> FloatArray:
        """Return values, first and second derivatives (3, functions, points) at places (points,) [1, 1/m, 1/m^2]."""
        found = np.concatenate(
            [_cubics(self.length_m, place_m), _bubbles(self.length_m, self.bubbles, place_m)], axis=1
        )
        if self.mirrored:
            v0, v1, s0, s1 = found[:, 0], found[:, 1], found[:, 2], found[:, 3]
            found[:, :4] = np.stack([v0 + v1, v0 - v1, s0 - s1, s0 + s1], axis=1)
        return found

    def integrals(self) -> FloatArray:
        """Return ∫ f_i^(a) f_k^(b) dx as (a, b, i, k) of the derivatives a, b = 0, 1, 2, exact for polynomials."""
        nodes, weights = _gauss(self.bubbles + 5)
        values = self.at(0.5 * self.length_m * (nodes + 1.0))
        left = [np.ascontiguousarray(rows.T) for rows in values]
        right = [(0.5 * self.length_m * weights)[:, None] * rows for rows in left]
        return np.array([[squares(f, g) for g in right] for f in left])


@lru_cache(maxsize=64)
def _gauss(count: int) -> tuple[FloatArray, FloatArray]:
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights


def gauss_points(low: float, high: float, count: int) -> tuple[FloatArray, FloatArray]:
    """Return places and weights (count,) of Gauss's rule between two ends, in their unit."""
    nodes, weights = _gauss(count)
    return low + 0.5 * (high - low) * (nodes + 1.0), 0.5 * (high - low) * weights


def _cubics(length_m: float, place_m: FloatArray) -> FloatArray:
    """Return the cubics with unit value at either end, then those with unit slope, (3, 4, points)."""
    s = place_m / length_m
    one = np.ones_like(s)
    end = (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s), 6.0 * one - 12.0 * s)
    first = (s * (1.0 - s) * (1.0 - s), (1.0 - s) * (1.0 - 3.0 * s), -4.0 * one + 6.0 * s)
    last = (s * s * (s - 1.0), s * (3.0 * s - 2.0), 6.0 * s - 2.0 * one)
    begin = (1.0 - end[0], -end[1], -end[2])
    rows = [np.stack([begin[d], end[d], length_m * first[d], length_m * last[d]]) / length_m**d for d in range(3)]
    return np.stack(rows)


def _bubbles(length_m: float, count: int, place_m: FloatArray) -> FloatArray:
    """Return the bubbles (3, count, points): double integrals of the Legendre polynomials of degree 2, 3, ..."""
    t = 2.0 * place_m / length_m - 1.0
    p = _legendre(count + 4, t)
    rows = np.empty((3, count, t.size))
    for k in range(count):
        n = k + 2
        size = np.sqrt(2.0 * n + 1.0) * n**1.5
        rows[0, k] = size / (2 * n + 1) * ((p[n + 2] - p[n]) / (2 * n + 3) - (p[n] - p[n - 2]) / (2 * n - 1))
        rows[1, k] = size / (2 * n + 1) * (p[n + 1] - p[n - 1]) * (2.0 / length_m)
        rows[2, k] = size * p[n] * (2.0 / length_m) ** 2
    return rows


def _legendre(most: int, t: FloatArray) -> list[FloatArray]:
    found = [np.ones_like(t), t]
    for n in range(1, most):
        found.append(((2 * n + 1) * t * found[n] - n * found[n - 1]) / (n + 1))
    return found
