"""Box: the geometry of a housing, six plates with bearing seats, ribs, flanges and bolts.

Lengths run between the middle surfaces of opposite plates. x counts along the housing from the gear's end to the
pinion's, y upwards from the floor, z along the shafts from the front wall. The housing is symmetric to the plane in the
middle between the walls that carry the bearings: both have the same seats, and bolts stand in pairs.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from itertools import combinations
from math import acos, hypot, pi, sqrt

from siggen.names import Side


class Axis(IntEnum):
    """Directions of the box, which number its coordinates."""

    X = 0
    Y = 1
    Z = 2


SIDES = {
    "floor": (Axis.Y, 0),
    "lid": (Axis.Y, 1),
    "gear_end": (Axis.X, 0),
    "pinion_end": (Axis.X, 1),
    "front": (Axis.Z, 0),
    "back": (Axis.Z, 1),
}
"""Plate -> its normal, and whether it stands at the beginning (0) or the end (1) of that axis."""


def plane_axes(normal: Axis) -> tuple[Axis, Axis]:
    """Return both axes in the plane of a plate, in ascending order."""
    first, second = (axis for axis in Axis if axis != normal)
    return first, second


@dataclass(frozen=True, slots=True)
class Material:
    """An isotropic material."""

    youngs_modulus_pa: float
    poisson_ratio: float
    density_kg_m3: float


@dataclass(frozen=True, slots=True)
class Thicknesses:
    """Thicknesses [m] of the plates; `walls` are the two with the bearings, `ends` the other two upright ones."""

    floor_m: float
    lid_m: float
    walls_m: float
    ends_m: float

    def of(self, plate: str) -> float:
        """Return the thickness of a plate of `SIDES` [m]."""
        walls = {"front": self.walls_m, "back": self.walls_m, "gear_end": self.ends_m, "pinion_end": self.ends_m}
        return {"floor": self.floor_m, "lid": self.lid_m, **walls}[plate]


@dataclass(frozen=True, slots=True)
class Seat:
    """The bearing seats of one shaft in both walls: a bore in a boss, which is thicker than the wall.

    Parameters
    ----------
    x_m, y_m : float
        Place of the shaft.
    bore_radius_m, boss_radius_m : float
        Of the bearing's outer ring, and of the boss around it.
    boss_thickness_m : float
        Wall and boss together, symmetric to the wall's middle surface.
    overhang_m : float
        Distance of the bearing's middle from the wall's middle surface, positive outwards.
    """

    x_m: float
    y_m: float
    bore_radius_m: float
    boss_radius_m: float
    boss_thickness_m: float
    overhang_m: float = 0.0


@dataclass(frozen=True, slots=True)
class Strip:
    """A rectangle of a plate that is thicker: a flange, a foot. Ranges [m] run along the plate's axes in order.

    Where z is one of them, the mirror image is thicker too.
    """

    plate: str
    first_m: tuple[float, float]
    second_m: tuple[float, float]
    thickness_m: float


@dataclass(frozen=True, slots=True)
class Rib:
    """An upright rib outside on both walls with bearings: a bar of this width [m] that stands out by its height [m]."""

    x_m: float
    y_m: tuple[float, float]
    width_m: float
    height_m: float


@dataclass(frozen=True, slots=True)
class Bolt:
    """A bolt in the floor and its mirror image, each with stiffness [N/m] along x, y, z, on a square patch [m]."""

    x_m: float
    z_m: float
    stiffness_n_per_m: tuple[float, float, float]
    patch_m: float


@dataclass(frozen=True, slots=True)
class Box:
    """A housing.

    Parameters
    ----------
    size_m : (length, height, width), between middle surfaces
    material, thickness : Material, Thicknesses
    seats : dict of Seat by shaft
    bolts, strips, ribs : tuples of Bolt, Strip, Rib

    Raises
    ------
    ValueError
        If a seat does not lie within its wall, or a boss is smaller than its bore.
    """

    size_m: tuple[float, float, float]
    material: Material
    thickness: Thicknesses
    seats: dict[str, Seat]
    bolts: tuple[Bolt, ...]
    strips: tuple[Strip, ...] = ()
    ribs: tuple[Rib, ...] = ()

    def __post_init__(self) -> None:
        length, height, width = self.size_m
        for name, seat in self.seats.items():
            room = min(seat.x_m, length - seat.x_m, seat.y_m, height - seat.y_m)
            if not 0.0 < seat.bore_radius_m < seat.boss_radius_m <= room:
                received = f"seat {name}: received bore {seat.bore_radius_m} m and boss {seat.boss_radius_m} m"
                raise ValueError(f"{received}; allowed: 0 < bore < boss <= {room} m, the distance to the next edge")
        for strip in self.strips:
            _check_strip(strip, width)

    @property
    def mass_kg(self) -> float:
        """Mass of plates, bosses, strips and ribs [kg]."""
        volume = sum(self.thickness.of(plate) * self.area_m2(plate) for plate in SIDES)
        for seat in self.seats.values():
            ring = pi * (seat.boss_radius_m**2 - seat.bore_radius_m**2) * seat.boss_thickness_m
            volume += 2.0 * (ring - pi * seat.boss_radius_m**2 * self.thickness.walls_m)
        for a, b in combinations(self.seats.values(), 2):
            # Where bosses meet, both rings were counted.
            more = 0.5 * (a.boss_thickness_m + b.boss_thickness_m) - self.thickness.walls_m
            volume -= 2.0 * common_area_m2(a, b) * more
        for strip in self.strips:
            area = (strip.first_m[1] - strip.first_m[0]) * (strip.second_m[1] - strip.second_m[0])
            volume += copies(strip, self.size_m[2]) * area * (strip.thickness_m - self.thickness.of(strip.plate))
        volume += sum(2.0 * rib.width_m * rib.height_m * (rib.y_m[1] - rib.y_m[0]) for rib in self.ribs)
        return self.material.density_kg_m3 * volume

    def area_m2(self, plate: str) -> float:
        """Return the area of a plate between middle surfaces [m^2]."""
        first, second = plane_axes(SIDES[plate][0])
        return self.size_m[first] * self.size_m[second]


def common_area_m2(a: Seat, b: Seat) -> float:
    """Return the area that the bosses of two seats share [m^2] (two circles: reference: standard literature)."""
    r, s, apart = a.boss_radius_m, b.boss_radius_m, hypot(a.x_m - b.x_m, a.y_m - b.y_m)
    if apart >= r + s:
        return 0.0
    if apart <= abs(r - s):
        return pi * min(r, s) ** 2
    along = 0.5 * (apart + (r * r - s * s) / apart)
    height = sqrt(r * r - along * along)
    return r * r * acos(along / r) + s * s * acos((apart - along) / s) - apart * height


def copies(strip: Strip, width_m: float) -> int:
    """Return how often a strip is there: 2 with its mirror image, 1 where it is its own."""
    if SIDES[strip.plate][0] == Axis.Z:
        return 2
    return 2 if strip.second_m[1] <= 0.5 * width_m else 1


def _check_strip(strip: Strip, width_m: float) -> None:
    if SIDES[strip.plate][0] == Axis.Z:
        return
    low, high = strip.second_m
    if high > 0.5 * width_m and abs(low + high - width_m) > 1e-9 * width_m:
        raise ValueError(f"strip: received z {strip.second_m} m; allowed: within the front half or symmetric to it")


# layout: the box that holds a pair of gears, from the gears' and bearings' sizes and the housing's proportions.


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
