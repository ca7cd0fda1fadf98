"""HalfFunctions: the functions of one half of a box with their lengths, where they are evaluated and summed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.box import SIDES, Axis, plane_axes
from siggen.dynamics.housing.line_functions import LineFunctions
from siggen.dynamics.housing.shared_functions import Component, Degrees, SharedFunctions, parity, shared_functions


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
