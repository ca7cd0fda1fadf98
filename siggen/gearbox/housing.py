"""What is drawn of a housing: a box of plates, modes that a user gave, or a rigid block; all in SI.

x runs from gear to pinion and is horizontal, y is vertical, z runs along the shafts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, Dynamics, ModalHousing, RigidHousing
from siggen.dynamics.housing.box import Material
from siggen.dynamics.housing.layout import Contents, Proportions
from siggen.dynamics.structure.gear_stage import Bolts, Casing, Point
from siggen.gearbox.housing_layout import specimen_layout
from siggen.gearbox.housing_numbers import plate_numbers
from siggen.gearbox.mode_table import ModeTable, mode_table
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import draw
from siggen.keys.number import Number, at, constant
from siggen.names import Side
from siggen.seeding import Stream, named_generator, named_uniforms
from siggen.sensors.sensor import SensorBase

SCATTER_MM = 15.0
"""Largest distance of a sensor from the middle of its plate along either axis, where no place is given (assumed)."""
CASING_GYRATION = 1.15
"""Radius of gyration of a casing over the distance of its axes: a box of even wall round the gears (derived)."""


@dataclass(frozen=True, slots=True)
class Mount:
    """Where a sensor stands: on a plate, so far from its middle along both axes [m]; on the floor beside a bolt."""

    plate: str
    away_m: Point


@dataclass(frozen=True, slots=True)
class Plates:
    """A box of plates round the gears of a pair.

    Attributes
    ----------
    contents, proportions, material : what the box is made from
    highest_hz : frequency up to which its modes count
    plate_damping : number of modes -> damping ratios of the plates in each (m,), the first ones the same for any number
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
    front_share: Mapping[str, float]
    drive_share: tuple[float, float]
    mounts: Mapping[str, Mount]
    plate_damping: Callable[[int], FloatArray] = field(compare=False)


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
