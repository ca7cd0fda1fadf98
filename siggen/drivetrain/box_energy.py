"""box_energy: stiffness and mass of a whole box in the coordinates of one half of its modes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.drivetrain.box import SIDES, Axis, Bolt, Box, Material, Rib, Seat, Strip, copies, plane_axes
from siggen.drivetrain.box_functions import PLATES, HalfFunctions, gauss_points
from siggen.drivetrain.stiff_pencil import own_squares, squares

# Energy of the plates of a box: bending and stretching of even plates, and where they are thicker or have a hole.
#
# Thin plate (Kirchhoff) with plane stress in its plane (reference: standard literature), B = E h³/12(1-ν²):
#
#     2 U = ∫ B [(w_aa + w_bb)² - 2 (1-ν) (w_aa w_bb - w_ab²)]
#             + E h/(1-ν²) [u_a² + v_b² + 2 ν u_a v_b + (1-ν)/2 (u_b + v_a)²]
#     2 T = ∫ ρ h (u² + v² + w²) + ρ h³/12 [1 + 2/(κ (1 - ν))] (w_a² + w_b²),   κ = 5/6
#
# The last term is the rotary inertia and, beside it, the shear of thick plates: with it an even plate has the
# frequencies of Mindlin's plate to first order in (k h)² (derived), and static deflections stay those of the thin
# plate.

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


# Points over bosses and bores of a wall, for sums over their areas.
#
# Gauss's rule along every ray from a shaft's middle, even steps around. A ray ends where another boss begins, so that
# every sum converges as fast as that over one ring. What a bore takes away must not exceed what the wall has there for
# any motion: with too few points it does, and the wall is no body any more.


def bore_area(seat: Seat, points_per_m: float) -> Area:
    """Return points of a bore; `points_per_m` are what a line of the wall needs for the square of a function."""
    return _ring(seat, 0.0, seat.bore_radius_m, (), points_per_m)


def boss_area(seat: Seat, others: Iterable[Seat], points_per_m: float) -> Area:
    """Return points of a boss; where bosses meet, each point belongs to the one whose middle is relatively nearer."""
    return _ring(seat, seat.bore_radius_m, seat.boss_radius_m, tuple(others), points_per_m)


def _ring(seat: Seat, inner_m: float, outer_m: float, others: tuple[Seat, ...], points_per_m: float) -> Area:
    angles, radii = (2 + int(np.ceil(points_per_m * way)) for way in (2.0 * np.pi * outer_m, outer_m - inner_m))
    angle = 2.0 * np.pi * (np.arange(angles) + 0.5) / angles
    shared = [border for other in others for border in _borders(seat, other, angle)]
    ends = np.sort(np.clip([np.full(angles, inner_m), *shared, np.full(angles, outer_m)], inner_m, outer_m), axis=0)
    place, share = gauss_points(0.0, 1.0, radii)
    length = np.diff(ends, axis=0)[..., None]
    radius, weight = ends[:-1, :, None] + length * place, length * share * 2.0 * np.pi / angles
    first, second = seat.x_m + radius * np.cos(angle)[:, None], seat.y_m + radius * np.sin(angle)[:, None]
    own = (weight > 0.0) & _nearest(seat, others, first, second)
    return Area(first[own], second[own], (weight * radius)[own])


def _nearest(seat: Seat, others: tuple[Seat, ...], x_m: FloatArray, y_m: FloatArray) -> NDArray[np.bool_]:
    def distance(of: Seat) -> FloatArray:
        return np.asarray(np.hypot(x_m - of.x_m, y_m - of.y_m) / of.boss_radius_m)

    own, nearest = distance(seat), np.full(x_m.shape, True)
    for other in others:
        nearest &= own <= distance(other)
    return nearest


def _borders(seat: Seat, other: Seat, angle: FloatArray) -> FloatArray:
    """Return where rays from a seat are relatively as near to another, (2, angles); infinite: nowhere.

    r² / R² = (r² - 2 b r + d²) / R'², with b the part of the distance d along the ray.
    """
    x, y = other.x_m - seat.x_m, other.y_m - seat.y_m
    along, apart = x * np.cos(angle) + y * np.sin(angle), x * x + y * y
    a = (other.boss_radius_m / seat.boss_radius_m) ** 2 - 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        # a r² + 2 b r - d² = 0, in the form that holds for bosses alike (a = 0) too.
        root = np.sqrt(along * along + a * apart)
        radii = np.array([apart / (along + root), apart / (along - root)])
    return np.where(np.isfinite(radii) & (radii > 0.0), radii, np.inf)


SQUARED = 2.0
"""Points of a boss and a bore over those of a line as long: functions are squared, and a bore takes away."""
ALONG, THROUGH = 10, 2
"""Points of a rib along its length and over its height."""
PATCH = 3
"""Points of a bolt's patch along either side."""


def box_energy(box: Box, half: HalfFunctions) -> tuple[Energies, FloatArray]:
    """Return stiffness and mass (n, n) with bolts, and the bolts' own stiffness (n, n)."""
    shape = (half.shared.coordinates, half.shared.coordinates)
    energies = Energies(np.zeros(shape), np.zeros(shape))
    for plate in PLATES:
        own = sheet(box.material, box.thickness.of(plate)).times(_walls(plate))
        add_even_plate(half, plate, box.material, own, energies)
    for seat in box.seats.values():
        _add_boss(box, half, seat, energies)
    for strip in box.strips:
        _add_strip(box, half, strip, energies)
    for rib in box.ribs:
        _add_rib(box, half, rib, energies)
    bolts = _bolts(box, half)
    return Energies(energies.stiffness + bolts, energies.mass), bolts


def bolt_rows(bolt: Bolt, half: HalfFunctions) -> dict[Axis, FloatArray]:
    """Return the mean motion of a bolt's patch along each axis per coordinate (coordinates,)."""
    along, _ = gauss_points(-0.5 * bolt.patch_m, 0.5 * bolt.patch_m, PATCH)
    x, z = (place.ravel() for place in np.meshgrid(bolt.x_m + along, bolt.z_m + along))
    _, weights = gauss_points(0.0, 1.0, PATCH)
    share = np.outer(weights, weights).ravel()[:, None]
    tables = half.tables("floor", (x, z))
    return {axis: (share * half.rows(tables, axis)).sum(axis=0) for axis in Axis}


def _walls(plate: str) -> float:
    """Return how many plates one stands for: the front wall also for the back."""
    return 2.0 if SIDES[plate][0] == Axis.Z else 1.0


def _add_boss(box: Box, half: HalfFunctions, seat: Seat, energies: Energies) -> None:
    wall = sheet(box.material, box.thickness.walls_m)
    ring = sheet(box.material, seat.boss_thickness_m).less(wall).times(2.0)
    others = [other for other in box.seats.values() if other is not seat]
    points_per_m = SQUARED * max((half.degrees.bubbles[axis] + 3) / half.size_m[axis] for axis in (Axis.X, Axis.Y))
    add_area(half, "front", box.material, boss_area(seat, others, points_per_m), ring, energies)
    add_area(half, "front", box.material, bore_area(seat, points_per_m), wall.times(-2.0), energies)


def _add_strip(box: Box, half: HalfFunctions, strip: Strip, energies: Energies) -> None:
    first, second = plane_axes(SIDES[strip.plate][0])
    a, along = gauss_points(*strip.first_m, _points(half, first, strip.first_m))
    b, across = gauss_points(*strip.second_m, _points(half, second, strip.second_m))
    grid_a, grid_b = np.meshgrid(a, b, indexing="ij")
    area = Area(grid_a.ravel(), grid_b.ravel(), np.outer(along, across).ravel())
    more = sheet(box.material, strip.thickness_m).less(sheet(box.material, box.thickness.of(strip.plate)))
    plate = "front" if strip.plate == "back" else strip.plate
    add_area(half, plate, box.material, area, more.times(copies(strip, box.size_m[Axis.Z])), energies)


def _points(half: HalfFunctions, axis: Axis, ends_m: tuple[float, float]) -> int:
    """Return how many points an extent takes: two, and for the whole line as many as it has functions."""
    share = (ends_m[1] - ends_m[0]) / half.size_m[axis]
    return 2 + int(np.ceil(share * (half.degrees.bubbles[axis] + 3)))


def _add_rib(box: Box, half: HalfFunctions, rib: Rib, energies: Energies) -> None:
    """Add a bar that stretches and turns with the wall's surface on which it stands; its own twist is a thin bar's."""
    y, along = gauss_points(*rib.y_m, ALONG)
    outwards, through = gauss_points(0.0, rib.height_m, THROUGH)
    material, tables = box.material, half.tables("front", (np.full_like(y, rib.x_m), y))
    turns = [half.rows(tables, Axis.Z, d) for d in ((1, 0), (0, 1))]
    moved = [half.rows(tables, axis) for axis in Axis]
    stretched, bent = half.rows(tables, Axis.Y, (0, 1)), half.rows(tables, Axis.Z, (0, 2))
    for depth, weight in zip(-0.5 * box.thickness.walls_m - outwards, through, strict=True):
        # Both walls; motion at the depth z is u - z ∂w/∂x, v - z ∂w/∂y, w.
        area = np.sqrt(2.0 * rib.width_m * weight * along)[:, None]
        strain = area * (stretched - depth * bent)
        energies.stiffness[:] += material.youngs_modulus_pa * own_squares(strain)
        for row in (moved[0] - depth * turns[0], moved[1] - depth * turns[1], moved[2]):
            energies.mass[:] += material.density_kg_m3 * own_squares(area * row)
    shear = material.youngs_modulus_pa / (2.0 * (1.0 + material.poisson_ratio))
    thin = np.sqrt(2.0 * shear * rib.height_m * rib.width_m**3 / 3.0 * along)[:, None]
    twist = thin * half.rows(tables, Axis.Z, (1, 1))
    energies.stiffness[:] += own_squares(twist)


def _bolts(box: Box, half: HalfFunctions) -> FloatArray:
    rows = [
        np.sqrt(2.0 * stiffness) * row
        for bolt in box.bolts
        for row, stiffness in zip(bolt_rows(bolt, half).values(), bolt.stiffness_n_per_m, strict=True)
    ]
    return own_squares(np.array(rows).reshape(-1, half.shared.coordinates))
