"""layout: the box that holds a pair of gears, from the gears' and bearings' sizes and the housing's proportions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from siggen.dynamics.housing.box import Bolt, Box, Material, Rib, Seat, Thicknesses
from siggen.names import Side


@dataclass(frozen=True, slots=True)
class Contents:
    """What a housing holds: lengths [m]; pairs are (gear, pinion)."""

    centre_distance_m: float
    tip_radius_m: tuple[float, float]
    face_width_m: float
    bearing_outer_m: tuple[float, float]


@dataclass(frozen=True, slots=True)
class Proportions:
    """What of a housing does not follow from its contents: lengths [m], ratios to the wall or the bearing.

    `side_m` is the distance of the gears' faces from either wall, bearings' share included; `bolt_inset` the distance
    of bolts from the floor's edges over its length and width; ribs stand below the seats.
    """

    end_m: float
    above_m: float
    sump_m: float
    side_m: float
    wall_m: float
    lid: float
    floor: float
    boss: float
    boss_thickness: float
    overhang_m: float
    bolt_inset: float
    bolt_n_per_m: tuple[float, float]
    rib_height: float = 0.0


WALLS_OF_PATCH = 3.0
"""Side of a bolt's patch over the wall's thickness, where there is room (assumed: a foot's pad)."""


def layout(contents: Contents, proportions: Proportions, material: Material) -> Box:
    """Return the box: gear on the side of x = 0, shafts at one height, four bolts in the floor's corners.

    Bosses end a wall's thickness before the edges. `bolt_n_per_m` is (shear, axial).
    """
    p, wall = proportions, proportions.wall_m
    gear, pinion = contents.tip_radius_m
    length = contents.centre_distance_m + gear + pinion + 2.0 * p.end_m + wall
    height = 2.0 * max(gear, pinion) + p.above_m + p.sump_m + 0.5 * (p.lid + p.floor) * wall
    width = contents.face_width_m + 2.0 * p.side_m + wall
    first = p.end_m + gear + 0.5 * wall
    level = max(gear, pinion) + p.sump_m + 0.5 * p.floor * wall
    places = (first, first + contents.centre_distance_m)
    seats = {
        name: _seat(x, level, outer, (length, height), p)
        for name, x, outer in zip((Side.DRIVEN.value, Side.DRIVER.value), places, contents.bearing_outer_m, strict=True)
    }
    shear, axial = p.bolt_n_per_m
    patch = min(WALLS_OF_PATCH * wall, 0.25 * width)
    inset = max(p.bolt_inset * length, 0.5 * patch)
    bolts = tuple(
        Bolt(x, max(p.bolt_inset * width, 0.5 * patch), (shear, axial, shear), patch) for x in (inset, length - inset)
    )
    thickness = Thicknesses(floor_m=p.floor * wall, lid_m=p.lid * wall, walls_m=wall, ends_m=wall)
    return Box((length, height, width), material, thickness, seats, bolts, ribs=_ribs(seats.values(), p))


def _seat(x_m: float, y_m: float, outer_m: float, wall_m: tuple[float, float], p: Proportions) -> Seat:
    room = min(x_m, wall_m[0] - x_m, y_m, wall_m[1] - y_m) - p.wall_m
    return Seat(x_m, y_m, 0.5 * outer_m, min(0.5 * p.boss * outer_m, room), p.boss_thickness * p.wall_m, p.overhang_m)


def _ribs(seats: Iterable[Seat], p: Proportions) -> tuple[Rib, ...]:
    if p.rib_height == 0.0:
        return ()
    return tuple(
        Rib(s.x_m, (0.5 * p.floor * p.wall_m, s.y_m - s.boss_radius_m), p.wall_m, p.rib_height * p.wall_m)
        for s in seats
    )
