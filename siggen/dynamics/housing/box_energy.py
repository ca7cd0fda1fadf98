"""box_energy: stiffness and mass of a whole box in the coordinates of one half of its modes."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.housing.boss_area import bore_area, boss_area
from siggen.dynamics.housing.box import SIDES, Axis, Bolt, Box, Rib, Seat, Strip, copies, plane_axes
from siggen.dynamics.housing.half_functions import HalfFunctions
from siggen.dynamics.housing.line_functions import gauss_points
from siggen.dynamics.housing.ordered_sums import own_squares
from siggen.dynamics.housing.plate_energy import Area, Energies, add_area, add_even_plate, sheet
from siggen.dynamics.housing.shared_functions import PLATES

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
