"""One gearbox of the set: its numbers, and the speeds and torques at which it is measured."""

from __future__ import annotations

from dataclasses import dataclass, replace

from siggen.config import Config, Dynamics, Gears, ModalHousing, Planetary, RigidHousing, Stage, Stiffness
from siggen.config.stages import with_idlers
from siggen.keys.drawing import draw
from siggen.keys.number import at
from siggen.names import PAIR, Names
from siggen.planning.gearbox import gearbox_config
from siggen.planning.housing_numbers import PlateNumbers, drawn_housing
from siggen.seeding import Stage as Consumer
from siggen.seeding import named_uniforms
from siggen.sensors.sensor import SensorBase


@dataclass(frozen=True, slots=True)
class Specimen:
    """A gearbox: sections of the configuration with every distribution replaced by a value.

    `bearing_point` is the operating point under whose mean load its bearings stand; None where they have one stiffness.
    `stages` are the meshes behind that of `gears`; with `planetary` those are sun and planets.
    """

    specimen_id: int
    gears: Gears
    stiffness: Stiffness
    dynamics: Dynamics
    housing: PlateNumbers | ModalHousing | RigidHousing
    sensors: tuple[SensorBase, ...]
    bearing_point: OperatingPoint | None = None
    stages: tuple[Stage, ...] = ()
    planetary: Planetary | None = None
    names: Names = PAIR

    def under(self, point: OperatingPoint) -> Specimen:
        """Return the gearbox at an operating point; itself where its bearings have one stiffness."""
        return self if self.bearing_point in (None, point) else replace(self, bearing_point=point)


@dataclass(frozen=True, slots=True)
class OperatingPoint:
    """Speed and torque of the pinion shaft."""

    speed_hz: float
    torque_nm: float


def draw_specimen(config: Config, specimen_id: int) -> Specimen:
    """Return a specimen; depends on the seed, the sections it is drawn from and its index alone.

    Noise of the sensors belongs to records and is left as it is. Bearings that follow the load stand at the first
    operating point; `Specimen.under` puts them at that of a record.
    """
    own = gearbox_config(config, specimen_id)
    gears = named_uniforms(config.seed, Consumer.GEARS, specimen_id)
    supports = named_uniforms(config.seed, Consumer.SUPPORTS, specimen_id)
    sensor = named_uniforms(config.seed, Consumer.SENSOR, specimen_id)
    first = draw(own.gears, gears, "gears")
    return Specimen(
        specimen_id,
        gears=first,
        stiffness=draw(own.stiffness, gears, "stiffness"),
        dynamics=draw(own.dynamics, supports, "dynamics"),
        housing=drawn_housing(own.housing, supports),
        sensors=tuple(one.drawn(sensor) for one in own.sensors),
        bearing_point=draw_operating_point(own, specimen_id, 0) if follows_load(own.dynamics) else None,
        stages=tuple(with_idlers(first, (draw(one, supports, f"stages.{one.name}") for one in own.stages))),
        planetary=None if own.planetary is None else draw(own.planetary, supports, "planetary"),
        names=own.names,
    )


def follows_load(dynamics: Dynamics) -> bool:
    """Return whether the stiffness of any bearing follows its load."""
    return dynamics.pinion.bearing is not None or dynamics.gear.bearing is not None


def draw_operating_point(config: Config, specimen_id: int, operating_point_id: int) -> OperatingPoint:
    """Return an operating point of a specimen; the same for all of its states."""
    uniform = named_uniforms(config.seed, Consumer.OPERATING_POINT, specimen_id, operating_point_id)
    ranges = gearbox_config(config, specimen_id).operating_points[operating_point_id]
    return OperatingPoint(
        speed_hz=at(ranges.speed_hz, uniform("speed_hz")), torque_nm=at(ranges.torque_nm, uniform("torque_nm"))
    )
