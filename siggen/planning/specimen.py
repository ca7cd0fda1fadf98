"""One gearbox of the set: its numbers, and the speeds and torques at which it is measured."""

from __future__ import annotations

from dataclasses import dataclass

from siggen.config import Config, Dynamics, Gears, ModalHousing, RigidHousing, Stiffness
from siggen.keys.drawing import draw
from siggen.keys.number import at
from siggen.planning.gearbox import gearbox_config
from siggen.planning.housing_numbers import PlateNumbers, drawn_housing
from siggen.seeding import Stage, named_uniforms
from siggen.sensors.sensor import Sensor


@dataclass(frozen=True, slots=True)
class Specimen:
    """A gearbox: sections of the configuration with every distribution replaced by a value."""

    specimen_id: int
    gears: Gears
    stiffness: Stiffness
    dynamics: Dynamics
    housing: PlateNumbers | ModalHousing | RigidHousing
    sensors: tuple[Sensor, ...]


@dataclass(frozen=True, slots=True)
class OperatingPoint:
    """Speed and torque of the pinion shaft."""

    speed_hz: float
    torque_nm: float


def draw_specimen(config: Config, specimen_id: int) -> Specimen:
    """Return a specimen; depends on the seed, the sections it is drawn from and its index alone.

    Noise of the sensors belongs to records and is left as it is.
    """
    own = gearbox_config(config, specimen_id)
    gears = named_uniforms(config.seed, Stage.GEARS, specimen_id)
    supports = named_uniforms(config.seed, Stage.SUPPORTS, specimen_id)
    sensor = named_uniforms(config.seed, Stage.SENSOR, specimen_id)
    return Specimen(
        specimen_id,
        gears=draw(own.gears, gears, "gears"),
        stiffness=draw(own.stiffness, gears, "stiffness"),
        dynamics=draw(own.dynamics, supports, "dynamics"),
        housing=drawn_housing(own.housing, supports),
        sensors=tuple(one.drawn(sensor) for one in own.sensors),
    )


def draw_operating_point(config: Config, specimen_id: int, operating_point_id: int) -> OperatingPoint:
    """Return an operating point of a specimen; the same for all of its states."""
    uniform = named_uniforms(config.seed, Stage.OPERATING_POINT, specimen_id, operating_point_id)
    ranges = gearbox_config(config, specimen_id).operating_points[operating_point_id]
    return OperatingPoint(
        speed_hz=at(ranges.speed_hz, uniform("speed_hz")), torque_nm=at(ranges.torque_nm, uniform("torque_nm"))
    )
