"""SharedFunctions: which products of line functions a plate moves by, and which of them are one and the same.

Each component of a plate's displacement is a sum of products of line functions. A product has one function along each
axis of the box: along the plate's normal it is the value at that plate. So products of two plates with the same three
functions are the same coordinate: displacements are continuous along edges. At an edge both plates also turn alike, so
the slope of one's normal displacement is minus that of the other's. Where three plates meet no twist is left. Higher
bubbles serve normal displacements and edges that turn; motion in a plate's plane, which is far stiffer, keeps the
lower ones (derived).

One half of the modes moves both walls with bearings alike, the other half moves them against each other: along z all
functions are even or odd, and no half knows anything of the other.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.drivetrain.box import SIDES, Axis, plane_axes
from siggen.drivetrain.stiff_pencil import squares

# LineFunctions: polynomials along an edge of the box, those that neighbouring plates share and those within a plate.
#
# On 0 <= x <= l: the four cubics with unit value or unit slope at one end, and bubbles whose value and slope vanish at
# both ends. The second derivative of bubble k is the Legendre polynomial of degree k + 2, so that their stiffness in
# bending is diagonal (reference: standard literature, hierarchical finite elements). Along a mirrored line all
# functions are even or odd about its middle; then V and S stand for both ends at once.

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


PLATES = tuple(name for name in SIDES if name != "back")
"""Plates that are assembled; the back wall is the front's mirror image."""
Key = tuple[int, tuple[int, int, int]]
"""Component of displacement, and the functions along x, y, z."""


@dataclass(frozen=True, slots=True)
class Component:
    """Products (n,) of one component on one plate: functions along both axes, coordinate and sign of each."""

    first: IntArray
    second: IntArray
    coordinate: IntArray
    sign: FloatArray


@dataclass(frozen=True, slots=True)
class SharedFunctions:
    """All products of one half: (plate, component) -> Component, and the number of coordinates."""

    components: dict[tuple[str, Axis], Component]
    coordinates: int


@dataclass(frozen=True, slots=True)
class Degrees:
    """Numbers of bubbles along x, y, z.

    `bubbles` are those of the walls with bearings, whose bosses take finer shapes; `even` those of the other plates and
    of edges that turn, `in_plane` those of motion in the plane.
    """

    bubbles: tuple[int, int, int]
    even: tuple[int, int, int]
    in_plane: int


@lru_cache(maxsize=64)
def shared_functions(degrees: Degrees, odd: bool) -> SharedFunctions:
    """Return the products of the half that moves both walls alike, or (`odd`) against each other."""
    lines = tuple(names(count, axis == Axis.Z) for axis, count in zip(Axis, degrees.bubbles, strict=True))
    numbers: dict[Key, int] = {}
    found = {}
    for plate in PLATES:
        normal, end = SIDES[plate]
        for component in Axis:
            rows = list(_products(lines, degrees, normal, end, component, odd))
            placed = [(numbers.setdefault(key, len(numbers)), sign) for _, _, key, sign in rows]
            found[plate, component] = Component(
                first=np.array([row[0] for row in rows]),
                second=np.array([row[1] for row in rows]),
                coordinate=np.array([number for number, _ in placed]),
                sign=np.array([sign for _, sign in placed]),
            )
    return SharedFunctions(found, len(numbers))


def parity(component: Axis, odd: bool) -> int:
    """Return whether a component is even (0) or odd (1) along z."""
    return int(odd) ^ int(component == Axis.Z)


def _products(
    lines: tuple[FunctionNames, ...], degrees: Degrees, normal: Axis, end: int, component: Axis, odd: bool
) -> Iterator[tuple[int, int, Key, float]]:
    """Yield both functions, the key and the sign of every product of a component on a plate."""
    first, second = plane_axes(normal)
    even = parity(component, odd)
    at_plate = lines[normal].find(VALUE, end, even)
    for i, j in product(_functions(lines[first], even), _functions(lines[second], even)):
        functions = [0, 0, 0]
        functions[first], functions[second], functions[normal] = i, j, at_plate
        key = _shared(lines, component, functions, odd)
        if key is None:
            continue
        if _serves(lines, degrees, normal, component == normal, key[0]):
            yield i, j, *key


def _functions(line: FunctionNames, even: int) -> list[int]:
    return [i for i, own in enumerate(line.parity) if own in (-1, even)]


def _serves(lines: tuple[FunctionNames, ...], degrees: Degrees, normal: Axis, across: bool, key: Key) -> bool:
    """Return whether a product is kept: with higher bubbles only where a plate bends or an edge turns."""
    component, functions = key
    kinds = [lines[axis].kind[functions[axis]] for axis in Axis]
    orders = [lines[axis].order[functions[axis]] for axis in Axis]
    others = [kinds[axis] for axis in Axis if axis != component]
    at_value = kinds[component] == VALUE
    bends = across and at_value and others == [BUBBLE, BUBBLE]
    turns = at_value and SLOPE in others
    if bends and normal == Axis.Z:
        return True
    within = all(order <= most for order, most in zip(orders, degrees.even, strict=True))
    return ((bends or turns) and within) or max(orders) <= degrees.in_plane


def _shared(
    lines: tuple[FunctionNames, ...], component: Axis, functions: list[int], odd: bool
) -> tuple[Key, float] | None:
    """Return the key under which plates share a product, and its sign; None for a twist at a corner.

    Of both ways to write the turning of an edge, the one with the lower component counts.
    """
    kinds = [lines[axis].kind[functions[axis]] for axis in Axis]
    slopes = [axis for axis in Axis if axis != component and kinds[axis] == SLOPE]
    own = (functions[0], functions[1], functions[2])
    if kinds[component] != VALUE or not slopes or (component < slopes[0] and len(slopes) == 1):
        return (component, own), 1.0
    if len(slopes) == 2:
        return None
    other = slopes[0]
    turned = list(own)
    for axis, kind in ((component, SLOPE), (other, VALUE)):
        turned[axis] = lines[axis].find(kind, lines[axis].end[own[axis]], parity(other, odd))
    return (other, (turned[0], turned[1], turned[2])), -1.0


# HalfFunctions: the functions of one half of a box with their lengths, where they are evaluated and summed.


class Tables(NamedTuple):
    """Line functions of a plate at points, along both axes: (3, functions, points) of value and derivatives."""

    plate: str
    first: FloatArray
    second: FloatArray


@dataclass(frozen=True)
class HalfFunctions:
    """Functions of one half: sizes [m] along x, y, z, numbers of bubbles, and whether both walls move oppositely."""

    size_m: tuple[float, float, float]
    degrees: Degrees
    odd: bool

    @cached_property
    def lines(self) -> tuple[LineFunctions, ...]:
        """Functions along x, y, z."""
        pairs = zip(self.size_m, self.degrees.bubbles, Axis, strict=True)
        return tuple(LineFunctions(length, count, axis == Axis.Z) for length, count, axis in pairs)

    @cached_property
    def integrals(self) -> tuple[FloatArray, ...]:
        """Integrals of products along x, y, z, each (3, 3, functions, functions)."""
        return tuple(line.integrals() for line in self.lines)

    @cached_property
    def shared(self) -> SharedFunctions:
        """Products and their coordinates."""
        return shared_functions(self.degrees, self.odd)

    def component(self, plate: str, component: Axis) -> Component:
        """Return the products of a component on a plate."""
        return self.shared.components[plate, component]

    def tables(self, plate: str, places_m: tuple[FloatArray, FloatArray]) -> Tables:
        """Return the line functions of a plate at places (points,) along both of its axes."""
        first, second = plane_axes(SIDES[plate][0])
        return Tables(plate, self.lines[first].at(places_m[0]), self.lines[second].at(places_m[1]))

    def products(self, tables: Tables, component: Axis, derivatives: tuple[int, int] = (0, 0)) -> FloatArray:
        """Return the products (points, n) of a component, differentiated so often along either axis."""
        own = self.component(tables.plate, component)
        along, across = tables.first[derivatives[0]][own.first], tables.second[derivatives[1]][own.second]
        return np.ascontiguousarray((along * across * own.sign[:, None]).T)

    def rows(self, tables: Tables, component: Axis, derivatives: tuple[int, int] = (0, 0)) -> FloatArray:
        """Return what a component is per coordinate, (points, coordinates)."""
        found = np.zeros((tables.first.shape[2], self.shared.coordinates))
        found[:, self.component(tables.plate, component).coordinate] = self.products(tables, component, derivatives)
        return found

    def mirror_sign(self, component: Axis) -> float:
        """Return the sign that a component has at the mirror image: minus for what is odd along z."""
        return -1.0 if parity(component, self.odd) else 1.0

    def integral(
        self, plate: str, both: tuple[Axis, Axis], along: tuple[int, int], across: tuple[int, int]
    ) -> FloatArray:
        """Return ∫ f g dA (n, m) of two components' products over a plate, without their signs.

        `along` and `across` are the derivatives of f and g along the plate's first and second axis.
        """
        f, g = (self.component(plate, component) for component in both)
        first, second = plane_axes(SIDES[plate][0])
        on_first: FloatArray = self.integrals[first][along][f.first[:, None], g.first]
        on_second: FloatArray = self.integrals[second][across][f.second[:, None], g.second]
        return on_first * on_second

    def add(
        self, total: FloatArray, plate: str, both: tuple[Axis, Axis], block: FloatArray, signed: bool = True
    ) -> None:
        """Add a block (n, m) of two components of a plate to a matrix of all coordinates.

        Blocks of `products` carry their signs already (`signed` False).
        """
        f, g = (self.component(plate, component) for component in both)
        signs = f.sign[:, None] * g.sign if signed else 1.0
        total[f.coordinate[:, None], g.coordinate] += block * signs
