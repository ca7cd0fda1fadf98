"""The box of one specimen, from gears, shafts and `siggen.gearbox.housing_numbers`: its lengths and its material.

With `dynamics.shafts` the walls stand where the bearings are.
"""

from __future__ import annotations

from siggen.config import Shafts
from siggen.dynamics.housing.box import Material
from siggen.dynamics.housing.layout import Contents, Proportions
from siggen.gearbox.housing_numbers import PlateNumbers
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import Number, constant

IRON_PA, STEEL_PA = (90e9, 130e9), 206e9
IRON_KG_M3, STEEL_KG_M3 = (7100.0, 7300.0), 7850.0
IRON_WALL, STEEL_WALL = (1.1, 3.0), (1.5, 4.6)
"""Thickness over 3 mm + 2.5 % of the centre distance, a usual least wall of cast housings (memory)."""
SHAFT_SHARE = 0.26
"""Diameter of a shaft over the centre distance where no shafts are given (assumed)."""
ROOM_BETWEEN_BEARINGS = 0.95
ABOVE_SHARE = 1.0 / 3.0
"""Of the height that the gear leaves, where the height is given (assumed)."""
CLEARANCE_M = 2e-3


def specimen_layout(
    numbers: PlateNumbers, shafts: Shafts | None, pair: GearPair
) -> tuple[Contents, Proportions, Material]:
    """Return what the box of a drawn housing is made from."""
    contents = housing_contents(numbers, shafts, pair)
    return contents, _proportions(numbers, shafts, contents), _material(numbers)


def _material(numbers: PlateNumbers) -> Material:
    if numbers.material == "steel":
        return Material(STEEL_PA, 0.3, STEEL_KG_M3)
    return Material(_within(IRON_PA, numbers.modulus), 0.26, _within(IRON_KG_M3, numbers.density))


def housing_contents(numbers: PlateNumbers, shafts: Shafts | None, pair: GearPair) -> Contents:
    """Return what a housing holds; bearings are as large as fit beside each other."""
    centre = pair.working_centre_distance_m
    diameters = [SHAFT_SHARE * centre] * 2
    if shafts is not None:
        diameters = [1e-3 * constant(shaft.diameter_mm) for shaft in (shafts.driven, shafts.driver)]
    outer = [constant(numbers.bearing) * diameter for diameter in diameters]
    room = min(1.0, 2.0 * ROOM_BETWEEN_BEARINGS * centre / sum(outer))
    return Contents(
        centre_distance_m=centre,
        tip_radius_m=(pair.gear.tip_radius_m, pair.pinion.tip_radius_m),
        face_width_m=pair.face_width_m,
        bearing_outer_m=(room * outer[0], room * outer[1]),
    )


def _proportions(numbers: PlateNumbers, shafts: Shafts | None, contents: Contents) -> Proportions:
    centre, n = contents.centre_distance_m, numbers
    wall, overhang = _wall_m(numbers, centre), constant(numbers.overhang) * centre
    end = max(constant(n.end) * centre, end_for_bearings_m(contents, wall))
    side = constant(n.side) * centre
    above = _height_m(constant(n.above) * centre, contents, wall, constant(n.lid))
    sump = _height_m(constant(n.sump) * centre, contents, wall, constant(n.floor))
    if shafts is not None:
        spans = [1e-3 * constant(shaft.bearing_span_mm) for shaft in (shafts.driven, shafts.driver)]
        side = max(0.5 * (sum(spans) / 2.0 - wall - contents.face_width_m) - overhang, CLEARANCE_M)
    if n.length_mm is not None:
        end = 0.5 * (1e-3 * constant(n.length_mm) - centre - sum(contents.tip_radius_m))
    if n.width_mm is not None:
        side = 0.5 * (1e-3 * constant(n.width_mm) - contents.face_width_m)
    if n.height_mm is not None:
        left = 1e-3 * constant(n.height_mm) - 2.0 * max(contents.tip_radius_m)
        above, sump = ABOVE_SHARE * left, (1.0 - ABOVE_SHARE) * left
    return Proportions(
        end_m=end,
        above_m=above,
        sump_m=sump,
        side_m=side,
        wall_m=wall,
        lid=constant(n.lid),
        floor=constant(n.floor),
        boss=constant(n.boss),
        boss_thickness=constant(n.boss_thickness),
        overhang_m=overhang,
        bolt_inset=constant(n.bolt_inset),
        bolt_n_per_m=_bolt_n_per_m(numbers, centre),
        rib_height=constant(n.rib_height) if constant(n.ribbed) < RIBBED_SHARE else 0.0,
    )


RIBBED_SHARE = 0.3
LEAST_BOSS = 1.2
"""Of a boss over its bearing, where the ends are near (assumed)."""


def end_for_bearings_m(contents: Contents, wall_m: float) -> float:
    """Return the least distance of the teeth from the ends, so that bosses end a wall's thickness before them."""
    pairs = zip(contents.bearing_outer_m, contents.tip_radius_m, strict=True)
    return max(0.5 * LEAST_BOSS * outer + 0.5 * wall_m - tip for outer, tip in pairs)


def height_for_bearings_m(contents: Contents, wall_m: float, plate: float, boss: float = LEAST_BOSS) -> float:
    """Return the least distance [m] of the larger gear from lid or floor, `plate` walls thick, for bosses so large."""
    widest = 0.5 * boss * max(contents.bearing_outer_m)
    return widest + wall_m - 0.5 * plate * wall_m - max(contents.tip_radius_m)


def _height_m(drawn_m: float, contents: Contents, wall_m: float, plate: float) -> float:
    """Return what was drawn where bearings fit into the wall; else what a least boss asks for.

    Two small gears of equal size turn between bearings that are larger than they are.
    """
    fits = drawn_m > height_for_bearings_m(contents, wall_m, plate, boss=1.0)
    return drawn_m if fits else height_for_bearings_m(contents, wall_m, plate)


def _bolt_n_per_m(numbers: PlateNumbers, centre_m: float) -> tuple[float, float]:
    return constant(numbers.shear) * centre_m, constant(numbers.axial) * centre_m


def _wall_m(numbers: PlateNumbers, centre_m: float) -> float:
    if numbers.wall_mm is not None:
        return 1e-3 * constant(numbers.wall_mm)
    return least_wall_m(centre_m) * _within(STEEL_WALL if numbers.material == "steel" else IRON_WALL, numbers.wall)


def least_wall_m(centre_m: float) -> float:
    """Return what walls are multiples of [m]."""
    return 3e-3 + 0.025 * centre_m


def _within(limits: tuple[float, float], share: Number) -> float:
    return limits[0] + constant(share) * (limits[1] - limits[0])
