"""Energy of the plates of a box: bending and stretching of even plates, and where they are thicker or have a hole.

Thin plate (Kirchhoff) with plane stress in its plane (reference: standard literature), B = E h³/12(1-ν²):

    2 U = ∫ B [(w_aa + w_bb)² - 2 (1-ν) (w_aa w_bb - w_ab²)]
            + E h/(1-ν²) [u_a² + v_b² + 2 ν u_a v_b + (1-ν)/2 (u_b + v_a)²]
    2 T = ∫ ρ h (u² + v² + w²) + ρ h³/12 [1 + 2/(κ (1 - ν))] (w_a² + w_b²),   κ = 5/6

The last term is the rotary inertia and, beside it, the shear of thick plates: with it an even plate has the frequencies
of Mindlin's plate to first order in (k h)² (derived), and static deflections stay those of the thin plate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.box import SIDES, Axis, Material, plane_axes
from siggen.dynamics.housing.half_functions import HalfFunctions
from siggen.dynamics.housing.ordered_sums import own_squares, squares

SHEAR_FACTOR = 5.0 / 6.0


class Energies(NamedTuple):
    """Stiffness [N/m] and mass [kg] of all coordinates, (n, n), to which plates are added."""

    stiffness: FloatArray
    mass: FloatArray


class Area(NamedTuple):
    """Points of a plate with weights: places along both axes [m] and areas [m²], each (points,)."""

    first_m: FloatArray
    second_m: FloatArray
    weight_m2: FloatArray

    @property
    def places_m(self) -> tuple[FloatArray, FloatArray]:
        """Places along both axes."""
        return self.first_m, self.second_m


class Sheet(NamedTuple):
    """What a plate resists and weighs with: bending [N m], stretching [N/m], mass [kg/m²], rotary inertia [kg]."""

    bending: float
    stretching: float
    mass: float
    rotary: float

    def times(self, factor: float) -> Sheet:
        """Return so many of them."""
        return Sheet(*(factor * number for number in self))

    def less(self, other: Sheet) -> Sheet:
        """Return the difference to another."""
        return Sheet(*(a - b for a, b in zip(self, other, strict=True)))


def sheet(material: Material, thickness_m: float) -> Sheet:
    """Return the numbers of a plate of one thickness; zero for a hole."""
    elastic = material.youngs_modulus_pa / (1.0 - material.poisson_ratio**2)
    shear = 1.0 + 2.0 / (SHEAR_FACTOR * (1.0 - material.poisson_ratio))
    mass = material.density_kg_m3 * thickness_m
    cube = thickness_m**3 / 12.0
    return Sheet(elastic * cube, elastic * thickness_m, mass, material.density_kg_m3 * cube * shear)


def add_even_plate(half: HalfFunctions, plate: str, material: Material, own: Sheet, energies: Energies) -> None:
    """Add a plate of one thickness over its whole area."""
    normal = SIDES[plate][0]
    ratio = material.poisson_ratio
    _add_bending(half, plate, (normal, normal), own, ratio, energies)
    _add_stretching(half, plate, own, ratio, energies.stiffness)
    for axis in Axis:
        mass = own.mass * half.integral(plate, (axis, axis), (0, 0), (0, 0))
        half.add(energies.mass, plate, (axis, axis), mass)


def _add_bending(
    half: HalfFunctions, plate: str, normals: tuple[Axis, Axis], own: Sheet, ratio: float, energies: Energies
) -> None:
    def of(along: tuple[int, int], across: tuple[int, int]) -> FloatArray:
        return half.integral(plate, normals, along, across)

    curved = of((2, 2), (0, 0)) + of((0, 0), (2, 2)) + ratio * (of((2, 0), (0, 2)) + of((0, 2), (2, 0)))
    half.add(energies.stiffness, plate, normals, own.bending * (curved + 2.0 * (1.0 - ratio) * of((1, 1), (1, 1))))
    half.add(energies.mass, plate, normals, own.rotary * (of((1, 1), (0, 0)) + of((0, 0), (1, 1))))


def _add_stretching(half: HalfFunctions, plate: str, own: Sheet, ratio: float, stiffness: FloatArray) -> None:
    u, v = plane_axes(SIDES[plate][0])
    shear = 0.5 * (1.0 - ratio)
    alike = {
        u: half.integral(plate, (u, u), (1, 1), (0, 0)) + shear * half.integral(plate, (u, u), (0, 0), (1, 1)),
        v: half.integral(plate, (v, v), (0, 0), (1, 1)) + shear * half.integral(plate, (v, v), (1, 1), (0, 0)),
    }
    for axis, block in alike.items():
        half.add(stiffness, plate, (axis, axis), own.stretching * block)
    mixed = ratio * half.integral(plate, (u, v), (1, 0), (0, 1)) + shear * half.integral(plate, (u, v), (0, 1), (1, 0))
    half.add(stiffness, plate, (u, v), own.stretching * mixed)
    half.add(stiffness, plate, (v, u), own.stretching * mixed.T)


def add_area(half: HalfFunctions, plate: str, material: Material, area: Area, own: Sheet, energies: Energies) -> None:
    """Add what an area of a plate has beyond the plate itself; negative where material is missing."""
    normal = SIDES[plate][0]
    ratio, tables = material.poisson_ratio, half.tables(plate, area.places_m)
    weights = np.sqrt(area.weight_m2)[:, None]

    def of(axis: Axis, along: int, across: int) -> FloatArray:
        return weights * half.products(tables, axis, (along, across))

    # (1+ν)/2 (a+b)² + (1-ν)/2 (a-b)² = a² + b² + 2 ν a b
    sums, differences = np.sqrt(0.5 * (1.0 + ratio)), np.sqrt(0.5 * (1.0 - ratio))
    aa, bb, ab = of(normal, 2, 0), of(normal, 0, 2), of(normal, 1, 1)
    curved = np.concatenate([sums * (aa + bb), differences * (aa - bb), 2.0 * differences * ab])
    half.add(energies.stiffness, plate, (normal, normal), own.bending * own_squares(curved), signed=False)
    turned = np.concatenate([of(normal, 1, 0), of(normal, 0, 1)])
    half.add(energies.mass, plate, (normal, normal), own.rotary * own_squares(turned), signed=False)
    u, v = plane_axes(normal)
    ua, vb, ub, va = of(u, 1, 0), of(v, 0, 1), of(u, 0, 1), of(v, 1, 0)
    strained = {
        u: np.concatenate([sums * ua, differences * ua, differences * ub]),
        v: np.concatenate([sums * vb, -differences * vb, differences * va]),
    }
    for axis in (u, v):
        block = own.stretching * own_squares(strained[axis])
        half.add(energies.stiffness, plate, (axis, axis), block, signed=False)
    mixed = own.stretching * squares(strained[u], strained[v])
    half.add(energies.stiffness, plate, (u, v), mixed, signed=False)
    half.add(energies.stiffness, plate, (v, u), mixed.T, signed=False)
    for axis in Axis:
        moved = of(axis, 0, 0)
        half.add(energies.mass, plate, (axis, axis), own.mass * own_squares(moved), signed=False)
