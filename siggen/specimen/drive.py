"""How a record is driven: its rotation, its torque and the forces of its shafts, each with its own random course."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from siggen.config import Config, SpeedVariation, Variation
from siggen.config import TorqueVariation as TorqueSection
from siggen.config.variation import SLOW_CORNER_HZ
from siggen.dynamics.drive.drive import Drive, Rotation
from siggen.dynamics.drive.excitation import Excitation, Source, SpeedDeviation
from siggen.dynamics.drive.slow_variation import slow_variation
from siggen.dynamics.drive.speed_ramp import SpeedRamp
from siggen.dynamics.drive.torque_variation import TorqueSettings, TorqueVariation
from siggen.dynamics.drive.varying_drive import Ripple, VaryingDrive
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.transient import TRANSIENT_CAP_S
from siggen.gears.damage.part import Parts
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import draw
from siggen.keys.number import constant
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import OperatingPoint, Specimen
from siggen.seeding import Stage, generator, named_generator, named_uniforms
from siggen.sensing.block_filter import BLOCK_SAMPLES
from siggen.sensing.spread import Spread
from siggen.specimen.bearing_spalls import spall_sources
from siggen.specimen.lost_mass import MeshPlace, lost_mass_sources
from siggen.specimen.shaft_forces import force_sources

MARGIN_S = 1.0
"""Beyond transient and record, for the filters."""


@dataclass(frozen=True, slots=True)
class RecordDrive:
    """Rotation of the pinion, what acts besides the constant torque, and the torque by itself (None: constant).

    `speed_input` is the number of the input by which tooth pairs slide faster, -1 at constant speed.
    """

    rotation: Rotation
    excitation: Excitation | None
    torque: TorqueVariation | None
    speed_input: int


def record_drive(
    config: Config,
    specimen: Specimen,
    structure: Structure,
    point: OperatingPoint,
    record: PlannedRecord,
    start_angle_rad: float,
    parts: Parts = (),
    behind: Sequence[tuple[GearPair, Parts, MeshPlace]] = (),
) -> RecordDrive:
    """Return how a record is driven; without variation and forces at constant speed, with nothing else acting.

    `parts` are those of the state's damage: some push. `behind` has those of the further meshes.

    Raises
    ------
    ValueError
        If the speed might reach zero, or a force has no bearing to act at.
    """
    rotation = record_rotation(config, point, record, start_angle_rad)
    forces = (
        *force_sources(config, specimen, structure),
        *lost_mass_sources(specimen.pair, structure, parts),
        *(source for pair, own, place in behind for source in lost_mass_sources(pair, structure, own, place)),
        *spall_sources(config, specimen, structure, point, record, rotation, parts),
    )
    if not config.variation.active:
        return RecordDrive(rotation, Excitation(forces) if forces else None, None, -1)
    variation = drawn_variation(config, record)
    torque = TorqueVariation(structure, point.torque_nm, _torque_settings(config, variation.torque, record))
    sources: tuple[Source, ...] = (SpeedDeviation(structure.coordinates, 2.0 * pi * point.speed_hz), torque, *forces)
    return RecordDrive(rotation, Excitation(sources), torque, 0)


def start_angle_rad(config: Config, specimen: Specimen, record: PlannedRecord) -> float:
    """Return the pinion angle at the first sample [rad], uniform over the hunting period of all gears."""
    return float(generator(config.seed, Stage.START, *record_owner(record)).random() * 2 * pi * specimen.hunting_turns)


def record_rotation(config: Config, point: OperatingPoint, record: PlannedRecord, start_angle_rad: float) -> Rotation:
    """Return the prescribed rotation of a record's pinion.

    Raises
    ------
    ValueError
        If the speed might reach zero.
    """
    if not config.variation.active:
        return Drive(point.speed_hz, start_angle_rad)
    return _rotation(config, drawn_variation(config, record).speed, point, record, start_angle_rad)


def drawn_variation(config: Config, record: PlannedRecord) -> Variation:
    """Return the section drawn for a specimen and operating point: the same for all of its states."""
    uniform = named_uniforms(config.seed, Stage.OPERATING_POINT, record.specimen_id, record.operating_point_id)
    return draw(config.variation, uniform, "variation")


def record_owner(record: PlannedRecord) -> tuple[int, int, int, int]:
    """Return the keys of what is drawn per record."""
    return record.specimen_id, record.state_id, record.operating_point_id, record.repeat


def variation_labels(config: Config, driven: RecordDrive) -> dict[str, object]:
    """Return the labels of the variation at the samples; none without it."""
    if driven.torque is None:
        return {}
    speed, torque = Spread(), Spread()
    for first in range(0, config.samples, BLOCK_SAMPLES):
        samples = np.arange(first, min(first + BLOCK_SAMPLES, config.samples))
        turning = driven.rotation.turning(samples / config.fs_hz)
        speed.take(turning.speed_rad_s)
        torque.take(driven.torque.motor_torque_nm(turning))
    return {
        "speed_std_hz": float(speed.std / (2.0 * pi)),
        "mean_torque_nm": torque.mean,
        "torque_std_nm": torque.std,
    }


def _rotation(
    config: Config, speed: SpeedVariation, point: OperatingPoint, record: PlannedRecord, start_angle_rad: float
) -> VaryingDrive:
    uniform = named_uniforms(config.seed, Stage.DRIVE, *record_owner(record))
    carrying_hz = point.speed_hz * (1.0 - constant(speed.slip) * point.torque_nm / constant(speed.rated_torque_nm))
    ramp = SpeedRamp(
        constant(speed.start_ratio) * carrying_hz, constant(speed.end_ratio) * carrying_hz, config.duration_s
    )
    rng = named_generator(config.seed, Stage.DRIVE, *record_owner(record), name="variation.speed.random")
    ripple = Ripple(
        constant(speed.ripple_once),
        constant(speed.ripple_twice),
        2.0 * pi * uniform("variation.speed.ripple_once.phase"),
        2.0 * pi * uniform("variation.speed.ripple_twice.phase"),
    )
    slow = slow_variation(rng, SLOW_CORNER_HZ, -TRANSIENT_CAP_S - MARGIN_S, config.duration_s + MARGIN_S)
    return VaryingDrive(ramp, start_angle_rad, ripple, slow, constant(speed.random_rms))


def _torque_settings(config: Config, torque: TorqueSection, record: PlannedRecord) -> TorqueSettings:
    uniform = named_uniforms(config.seed, Stage.DRIVE, *record_owner(record))
    rng = named_generator(config.seed, Stage.DRIVE, *record_owner(record), name="variation.torque.random")
    return TorqueSettings(
        slow_variation(rng, SLOW_CORNER_HZ, -TRANSIENT_CAP_S - MARGIN_S, config.duration_s + MARGIN_S),
        constant(torque.random_rms),
        constant(torque.load_once),
        2.0 * pi * uniform("variation.torque.load_once.phase"),
        constant(torque.line_ripple),
        line_phase_rad=2.0 * pi * uniform("variation.torque.line_ripple.phase"),
    )
