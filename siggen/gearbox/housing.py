"""What is drawn of a housing: a box of plates, modes that a user gave, or a rigid block; all in SI.

x runs from gear to pinion and is horizontal, y is vertical, z runs along the shafts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Annotated, TypeAlias

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, Dynamics, ModalHousing, PlateHousing, RigidHousing, Shafts
from siggen.drivetrain.box import Contents, Material, Proportions
from siggen.drivetrain.gear_stage import Bolts, Casing, Point
from siggen.gearbox.mode_table import ModeTable, mode_table
from siggen.gears.gear_pair import GearPair
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import draw
from siggen.keys.number import MIDDLE, Number, Within, at, constant
from siggen.keys.section import Section
from siggen.names import Side
from siggen.seeding import Stream, named_generator, named_uniforms
from siggen.sensors.sensor import SensorBase

# Proportions of a housing of plates that no file sets, with their sources; drawn per gearbox, by name, like its keys.
#
# Ranges are those of `docs/understand/methods.md`: clearances, walls and ribs from design rules, bosses and welded
# walls assumed. Lengths are shares of the centre distance or of the wall.

IRON_SHARE = 0.6
"""Of gearboxes of any material (assumed)."""
Drawn = Annotated[Number, Within()]


class FootNumbers(Section):
    """Of the four bolts under the corners of the floor: their share in the damping of a mode's energy (assumed)."""

    damping_ratio: Drawn = Uniform(low=0.03, high=0.07)


class PlateNumbers(PlateHousing):
    """Of the box: what its contents leave open.

    `end`, `above`, `sump`, `side`: clearances over the centre distance (10 to 25, 15 to 30, 25 to 60 and 25 to 55 mm at
    97.5 mm); `wall`, `modulus` and `density`: places within the ranges of the material; `lid`, `floor`: thickness over
    the wall's; `boss` over the bearing, `boss_thickness` over the wall; `bearing`: outer diameter over the shaft's;
    `overhang`: over the centre distance; `shear`, `axial`: stiffness of a bolt per metre of centre distance [N/m²];
    `bolt_inset`: over length and width; `ribbed`: below 0.3 with ribs; `rib_height`: over the wall.
    """

    end: Drawn = Uniform(low=0.10, high=0.26)
    above: Drawn = Uniform(low=0.15, high=0.31)
    sump: Drawn = Uniform(low=0.26, high=0.62)
    side: Drawn = Uniform(low=0.26, high=0.56)
    wall: Drawn = Uniform(low=0.0, high=1.0)
    modulus: Drawn = Uniform(low=0.0, high=1.0)
    density: Drawn = Uniform(low=0.0, high=1.0)
    lid: Drawn = Uniform(low=0.7, high=1.0)
    floor: Drawn = Uniform(low=1.3, high=1.7)
    boss: Drawn = Uniform(low=1.4, high=1.8)
    boss_thickness: Drawn = Uniform(low=1.5, high=4.0)
    bearing: Drawn = Uniform(low=1.8, high=2.2)
    shear: Drawn = Uniform(low=0.62e9, high=1.13e9)
    axial: Drawn = Uniform(low=1.13e9, high=2.05e9)
    overhang: Drawn = Uniform(low=0.0, high=0.10)
    bolt_inset: Drawn = Uniform(low=0.08, high=0.2)
    ribbed: Drawn = Uniform(low=0.0, high=1.0)
    rib_height: Drawn = Uniform(low=2.0, high=5.0)
    feet: FootNumbers = FootNumbers()


def plate_numbers(section: PlateHousing, uniform: Callable[[str], float]) -> PlateNumbers:
    """Return the numbers of one gearbox's box; the damping of plates belongs to modes and stays as it is."""
    numbers: PlateNumbers = draw(PlateNumbers.model_construct(**dict(section)), uniform, "housing")
    material = section.material
    if material == "any":
        material = "grey_iron" if uniform("housing.material") < IRON_SHARE else "steel"
    return numbers.model_copy(update={"material": material, "damping_ratio": section.damping_ratio})


# The box of one specimen, from gears, shafts and `siggen.gearbox.housing`: its lengths and its material.
#
# With `dynamics.shafts` the walls stand where the bearings are.

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


SCATTER_MM = 15.0
"""Largest distance of a sensor from the middle of its plate along either axis, where no place is given (assumed)."""
CASING_GYRATION = 1.15
"""Radius of gyration of a casing over the distance of its axes: a box of even wall round the gears (derived)."""


@dataclass(frozen=True, slots=True)
class Mount:
    """Where a sensor stands: on a plate, so far from its middle along both axes [m]; on the floor beside a bolt."""

    plate: str
    away_m: Point


PlateDamping = Callable[[int], FloatArray]
"""Number of modes -> damping ratios of the plates in each (m,)."""


@dataclass(frozen=True, slots=True)
class Plates:
    """A box of plates round the gears of a pair.

    Attributes
    ----------
    contents, proportions, material : what the box is made from
    highest_hz : frequency up to which its modes count
    plate_damping : the first ones the same for any number of modes
    foot_damping_ratio : of the bolts
    loose_share : what one foot has left of its stiffness
    front_share : pinion, gear -> what the front bearing of its shaft bears of a force on it
    drive_share : where another drive presses on the front wall, over its length and height
    mounts : name of a sensor -> where it stands
    """

    contents: Contents
    proportions: Proportions
    material: Material
    highest_hz: float
    foot_damping_ratio: float
    loose_share: float
    front_share: Mapping[str, float] = field(hash=False)
    drive_share: tuple[float, float]
    mounts: Mapping[str, Mount] = field(hash=False)
    plate_damping: PlateDamping = field(compare=False)


@dataclass(frozen=True, slots=True)
class Block:
    """A rigid housing on bolts, and where sensors stand from its centre of gravity.

    Without given inertia (None) that follows from the housing's extent.
    """

    mass_kg: float
    inertia_kg_m2: float | None
    bolts: Bolts
    sensor_places_m: Mapping[str, Point]

    def casing(self, extent_m: float) -> Casing:
        """Return it round axes of an extent [m] between the outermost ones, the first pinion at one end."""
        inertia = self.inertia_kg_m2
        return Casing(
            mass_kg=self.mass_kg,
            inertia_kg_m2=self.mass_kg * (CASING_GYRATION * extent_m) ** 2 if inertia is None else inertia,
            bolts=self.bolts,
            pinion_place_m=(0.5 * extent_m, 0.0),
            sensor_places_m=self.sensor_places_m,
        )


Housing: TypeAlias = Plates | ModeTable | Block


def walls_m2(housing: Housing | None, pairs: Sequence[GearPair], ring_m: float | None) -> float:
    """Return the area of the walls [m²]: of plates as they are, else of a typical box round the gears, laid flat.

    Parameters
    ----------
    housing : as it is drawn
    pairs : of a train; of a planetary set in a ring, whose outer radius is `ring_m` [m]
    """
    if isinstance(housing, Plates):
        held, around = housing.contents, housing.proportions
        length_m = held.centre_distance_m + sum(held.tip_radius_m) + 2.0 * around.end_m
        height_m = 2.0 * max(held.tip_radius_m) + around.above_m + around.sump_m
        return _box_m2(length_m, height_m, held.face_width_m + 2.0 * around.side_m)
    room = plate_numbers(PlateHousing(), lambda _: MIDDLE)
    centres_m, tips_m = [pair.working_centre_distance_m for pair in pairs], [pair.gear.tip_radius_m for pair in pairs]
    size_m, width_m = max(centres_m), sum(pair.face_width_m for pair in pairs)
    length_m, height_m = pairs[0].pinion.tip_radius_m + sum(centres_m) + tips_m[-1], 2.0 * max(tips_m)
    if ring_m is not None:
        length_m, height_m, width_m = 2.0 * ring_m, 2.0 * ring_m, pairs[0].face_width_m
    end, side = constant(room.end), constant(room.side)
    above, sump = constant(room.above), constant(room.sump)
    return _box_m2(length_m + 2.0 * end * size_m, height_m + (above + sump) * size_m, width_m + 2.0 * side * size_m)


def _box_m2(length_m: float, height_m: float, width_m: float) -> float:
    return 2.0 * (length_m * height_m + length_m * width_m + height_m * width_m)


def drawn_housing(
    config: Config, specimen_id: int, dynamics: Dynamics, pair: GearPair, sensors: Sequence[SensorBase]
) -> Housing | None:
    """Return the housing of one gearbox with drawn `dynamics` and `sensors`; None where the ground carries bearings."""
    section, uniform = config.housing, named_uniforms(config.seed, Stream.SUPPORTS, specimen_id)
    if dynamics.model != "casing":
        return None
    if isinstance(section, ModalHousing):
        return mode_table(section.modes)
    if isinstance(section, RigidHousing):
        return _block(draw(section, uniform, "housing"), sensors)
    rng = partial(named_generator, config.seed, Stream.PATH, specimen_id, name="housing.damping_ratio")
    numbers, shafts = plate_numbers(section, uniform), dynamics.shafts
    contents, proportions, material = specimen_layout(numbers, shafts, pair)
    path = named_uniforms(config.seed, Stream.PATH, specimen_id)
    return Plates(
        contents,
        proportions,
        material,
        highest_hz=0.5 * config.fs_hz,
        foot_damping_ratio=constant(numbers.feet.damping_ratio),
        loose_share=constant(numbers.loose_foot_share),
        front_share={role: 0.5 if shafts is None else 1.0 - constant(shafts.of(role).gear_position) for role in Side},
        drive_share=(_of_wall(path("housing.auxiliary_drive.0")), _of_wall(path("housing.auxiliary_drive.1"))),
        mounts={sensor.name: _mount(sensor, sensor.plate, path) for sensor in sensors if sensor.plate is not None},
        plate_damping=partial(_plate_damping, rng, section.damping_ratio),
    )


def _of_wall(uniform: float) -> float:
    return 0.2 + 0.6 * uniform


def _plate_damping(rng: Callable[[], np.random.Generator], law: Number, modes: int) -> FloatArray:
    return np.array([at(law, float(u)) for u in rng().random(modes)])


def _mount(sensor: SensorBase, plate: str, uniform: Callable[[str], float]) -> Mount:
    """Return where a sensor stands: where it was put, or about the middle of its plate."""
    given = sensor.place_on_casing_mm
    first, second = (
        constant(given[i]) if given else SCATTER_MM * (2.0 * uniform(f"sensors.{sensor.name}.place.{i}") - 1.0)
        for i in range(2)
    )
    return Mount(plate, _metres((first, second)))


def _block(section: RigidHousing, sensors: Sequence[SensorBase]) -> Block:
    bolts, inertia = section.bolts, section.inertia_kg_m2
    return Block(
        mass_kg=constant(section.mass_kg),
        inertia_kg_m2=None if inertia is None else constant(inertia),
        bolts=Bolts(
            shear_stiffness_n_per_m=constant(bolts.shear_stiffness_n_per_m),
            axial_stiffness_n_per_m=constant(bolts.axial_stiffness_n_per_m),
            damping_ratio=constant(bolts.damping_ratio),
            places_m=tuple(_metres(place) for place in bolts.positions_mm),
            loose_share=constant(section.loose_foot_share),
        ),
        sensor_places_m={s.name: _metres(s.place_on_casing_mm) for s in sensors if s.place_on_casing_mm},
    )


def _metres(position_mm: Sequence[Number]) -> Point:
    first, second = (1e-3 * constant(number) for number in position_mm)
    return first, second
