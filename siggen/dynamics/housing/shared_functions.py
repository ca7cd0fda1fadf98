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
from functools import lru_cache
from itertools import product

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.dynamics.housing.box import SIDES, Axis, plane_axes
from siggen.dynamics.housing.line_functions import BUBBLE, SLOPE, VALUE, FunctionNames, names

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
