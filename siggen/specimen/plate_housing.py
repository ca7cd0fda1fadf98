"""A housing of plates of one specimen: a box from its geometry, its modes, and where it is pressed and seen.

The box follows from the gears, the shafts and `siggen.gearbox.housing_numbers`. x runs from gear to pinion and is
horizontal, y is vertical, z runs along the shafts. With `dynamics.shafts` the walls stand where the bearings are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache, partial

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Config, Shafts
from siggen.dynamics.housing.box import SIDES, Axis, Box, Material, plane_axes
from siggen.dynamics.housing.housing_modes import (
    BEYOND,
    WAVES,
    BoxModes,
    HousingModes,
    housing_modes,
    mixed_damping,
    resolved_hz,
)
from siggen.dynamics.housing.layout import Contents, Proportions, layout
from siggen.dynamics.housing.loose_foot import loosened, springs
from siggen.dynamics.housing.motion import Motion, PlatePlace, motion_at, seat_motions
from siggen.dynamics.structure.gear_stage import Point
from siggen.gearbox.housing_numbers import PlateNumbers
from siggen.keys.number import at, constant
from siggen.names import ROLES
from siggen.planning.specimen import Specimen
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensors.sensor import SensorBase
from siggen.specimen.housing_layout import specimen_layout
from siggen.specimen.specimen_housing import MODES_ON_BOLTS, BoltMotions, SpecimenHousing, second_stage

AXES = {"horizontal": Axis.X, "vertical": Axis.Y, "axial": Axis.Z}
EDGE_M = 8e-3
"""Sensors stand at least so far from a plate's edge."""


def plate_housing(config: Config, specimen: Specimen, numbers: PlateNumbers) -> SpecimenHousing:
    """Return the box of plates of a specimen with its modes."""
    box, modes, ratio = damped_modes(config, specimen, numbers)
    pair, shafts = specimen.pair, specimen.dynamics.shafts
    pushed = pair.helix_rad != 0.0
    bearings = {role: shaft.bearing for role, shaft in zip(ROLES, specimen.names.shafts, strict=True)}
    seats = _seats(box, modes, shafts, bearings, located=pushed)
    uniform = named_uniforms(config.seed, Stage.PATH, specimen.specimen_id)
    return SpecimenHousing(
        modes=modes,
        damping_ratio=ratio,
        seats={name: motion for name, motion in seats.items() if pushed or not name.endswith("axial")},
        motions={**seats, **_sensors(box, modes, specimen.sensors, uniform)},
        entries={
            "second_stage": second_stage(seats, tuple(bearings.values()), pair.working_pressure_angle_rad),
            **_drive(box, modes, uniform),
        },
        bolts=partial(_bolts, box, modes, constant(numbers.loose_foot_share)),
        box=box,
    )


def damped_modes(config: Config, specimen: Specimen, numbers: PlateNumbers) -> tuple[Box, BoxModes, FloatArray]:
    """Return box, modes and their damping ratios (m,)."""
    made = specimen_layout(numbers, specimen.dynamics.shafts, specimen.pair)
    box, modes = _on_its_feet(*made, 0.5 * config.fs_hz, constant(numbers.loose_foot_share))
    rng = named_generator(config.seed, Stage.PATH, specimen.specimen_id, name="housing.damping_ratio")
    plates = np.array([at(numbers.damping_ratio, float(u)) for u in rng.random(modes.frequency_hz.size)])
    return box, modes, mixed_damping(modes, plates, constant(numbers.feet.damping_ratio))


def _bolts(box: Box, modes: BoxModes, share: float) -> BoltMotions:
    axes = {Axis.X: "horizontal", Axis.Y: "vertical"}
    return tuple(
        (_from_middle(box, one.bolt.x_m), axes[one.axis], one.stiffness_n_per_m, one.motion)
        for one in springs(box, modes.halves, share)
        if one.axis in axes
    )


@lru_cache(maxsize=4)
def _on_its_feet(
    contents: Contents, proportions: Proportions, material: Material, highest_hz: float, share: float
) -> tuple[Box, BoxModes]:
    """Return a box and its modes; one foot has a share of its stiffness left."""
    box, sound = _made(contents, proportions, material, highest_hz)
    return (box, sound) if share == 1.0 else (box, loosened(sound, box, share))


@lru_cache(maxsize=4)  # states and records of a gearbox share them
def _made(
    contents: Contents, proportions: Proportions, material: Material, highest_hz: float
) -> tuple[Box, HousingModes]:
    box = layout(contents, proportions, material)
    highest_hz = min(highest_hz, BEYOND * resolved_hz(box))
    modes = housing_modes(box, highest_hz, WAVES)
    while modes.vibrating <= MODES_ON_BOLTS:  # a small box with thick walls bends above the band: a label tells where
        highest_hz *= 2.0
        modes = housing_modes(box, highest_hz, WAVES)
    return box, modes


def _seats(
    box: Box, modes: BoxModes, shafts: Shafts | None, bearings: Mapping[str, str], *, located: bool
) -> dict[str, Motion]:
    """Return the motion of both seats of every shaft, weighted with what each of them bears of a force on the gear.

    Along the axis one bearing of a `located` shaft bears all of it, that in the front wall.
    """
    found = {}
    for shaft, bearing in bearings.items():
        front = 0.5 if shafts is None else 1.0 - constant(getattr(shafts, shaft).gear_position)
        of_walls = [seat_motions(modes.halves, box.seats[shaft], wall) for wall in ("front", "back")]
        for axis, number in (("vertical", "y"), ("horizontal", "x"), ("axial", "z")):
            first, second = (motions[number] for motions in of_walls)
            if located and axis == "axial":
                found[f"{bearing}/{axis}"] = first
                continue
            none = Motion(0.0 * first.even, 0.0 * first.odd)
            found[f"{bearing}/{axis}"] = none.plus(first, front).plus(second, 1.0 - front)
    return found


def _sensors(
    box: Box, modes: BoxModes, sensors: tuple[SensorBase, ...], uniform: Callable[[str], float]
) -> dict[str, Motion]:
    """Return the motions of all sensors on plates, along all axes."""
    found = {}
    for sensor in sensors:
        if sensor.plate is not None:
            plate, first, second = sensor_place(box, sensor, uniform)
            for axis, number in AXES.items():
                found[f"casing_{sensor.name}/{axis}"] = motion_at(
                    modes.halves, PlatePlace(plate, first, second, number)
                )
    return found


def sensor_place(box: Box, sensor: SensorBase, uniform: Callable[[str], float]) -> tuple[str, float, float]:
    """Return the plate and where on it a sensor stands: about its middle, or about a bolt."""
    if sensor.plate == "floor":
        bolt = box.bolts[-1]
        return "floor", bolt.x_m, bolt.z_m
    assert sensor.plate is not None
    sizes = [box.size_m[axis] for axis in plane_axes(SIDES[sensor.plate][0])]
    given = sensor.place_on_casing_mm
    found = []
    for i, size in enumerate(sizes):
        away_mm = (
            constant(given[i]) if given else SCATTER_MM * (2.0 * uniform(f"sensors.{sensor.name}.place.{i}") - 1.0)
        )
        found.append(min(max(0.5 * size + 1e-3 * away_mm, EDGE_M), size - EDGE_M))
    return sensor.plate, found[0], found[1]


SCATTER_MM = 15.0
"""Largest distance of a sensor from the middle of its plate along either axis, where no place is given (assumed)."""


def _drive(box: Box, modes: BoxModes, uniform: Callable[[str], float]) -> dict[str, Motion]:
    """Return where another drive presses: by the radial forces of its own bearings, in the plane of the front wall."""
    length, height, _ = box.size_m
    shares = [0.2 + 0.6 * uniform(f"housing.auxiliary_drive.{i}") for i in range(2)]
    return {
        f"auxiliary_drive/{axis}": motion_at(
            modes.halves, PlatePlace("front", shares[0] * length, shares[1] * height, AXES[axis])
        )
        for axis in ("horizontal", "vertical")
    }


def _from_middle(box: Box, x_m: float) -> Point:
    """Return where a place of the floor lies from the middle between both shafts."""
    first, second = box.seats["gear"], box.seats["pinion"]
    return x_m - 0.5 * (first.x_m + second.x_m), -0.5 * (first.y_m + second.y_m)
