"""How a record is driven: its rotation, its torque and the forces of its shafts, each with its own random course."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from siggen.dynamics.drive.drive import Drive, Rotation
from siggen.dynamics.drive.excitation import Excitation, InputSource, SpeedDeviation
from siggen.dynamics.drive.slow_variation import SLOW_CORNER_HZ, SlowVariation, slow_variation
from siggen.dynamics.drive.speed_ramp import SpeedRamp
from siggen.dynamics.drive.torque_variation import TorqueSettings, TorqueVariation
from siggen.dynamics.drive.varying_drive import Ripple, VaryingDrive
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.sampling import Sampling
from siggen.dynamics.time.transient import TRANSIENT_CAP_S
from siggen.gearbox.specimen import Specimen
from siggen.gears.damage.part import Parts
from siggen.gears.geometry.gear_pair import GearPair
from siggen.planning.plan import PlannedRecord
from siggen.seeding import Stream, generator, named_generator, named_uniforms
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
    specimen: Specimen,
    structure: Structure,
    record: PlannedRecord,
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
    point, rotation = specimen.points[record.operating_point_id], record_rotation(specimen, record)
    forces = (
        *force_sources(specimen, structure),
        *lost_mass_sources(specimen.pair, structure, parts),
        *(source for pair, own, place in behind for source in lost_mass_sources(pair, structure, own, place)),
        *spall_sources(specimen, structure, record, rotation, parts),
    )
    if point.variation is None:
        return RecordDrive(rotation, Excitation(forces) if forces else None, None, -1)
    settings = _in_record(specimen, point.variation.torque, record)
    torque = TorqueVariation(structure, point.torque_nm, settings)
    sources: tuple[InputSource, ...] = (
        SpeedDeviation(structure.coordinates, 2.0 * pi * point.speed_hz),
        torque,
        *forces,
    )
    return RecordDrive(rotation, Excitation(sources), torque, 0)


def start_angle_rad(specimen: Specimen, record: PlannedRecord) -> float:
    """Return the pinion angle at the first sample [rad], uniform over the hunting period of all gears."""
    return float(generator(specimen.seed, Stream.START, *record.owner).random() * 2 * pi * specimen.hunting_turns)


def record_rotation(specimen: Specimen, record: PlannedRecord) -> Rotation:
    """Return the prescribed rotation of a record's pinion.

    Raises
    ------
    ValueError
        If the speed might reach zero.
    """
    point, angle_rad = specimen.points[record.operating_point_id], start_angle_rad(specimen, record)
    if point.variation is None:
        return Drive(point.speed_hz, angle_rad)
    speed, uniform = point.variation.speed, named_uniforms(specimen.seed, Stream.DRIVE, *record.owner)
    carrying_hz = point.speed_hz * (1.0 - speed.slip * point.torque_nm / specimen.rated_nm)
    ramp = SpeedRamp(speed.start_ratio * carrying_hz, speed.end_ratio * carrying_hz, specimen.sampling.duration_s)
    ripple = Ripple(
        speed.ripple_once,
        speed.ripple_twice,
        2.0 * pi * uniform("variation.speed.ripple_once.phase"),
        2.0 * pi * uniform("variation.speed.ripple_twice.phase"),
    )
    return VaryingDrive(ramp, angle_rad, ripple, _slow(specimen, record, "variation.speed.random"), speed.random_rms)


def variation_labels(sampling: Sampling, driven: RecordDrive) -> dict[str, object]:
    """Return the labels of the variation at the samples; none without it."""
    if driven.torque is None:
        return {}
    speed, torque = Spread(), Spread()
    for first in range(0, sampling.samples, BLOCK_SAMPLES):
        samples = np.arange(first, min(first + BLOCK_SAMPLES, sampling.samples))
        turning = driven.rotation.turning(samples / sampling.fs_hz)
        speed.take(turning.speed_rad_s)
        torque.take(driven.torque.motor_torque_nm(turning))
    return {
        "speed_std_hz": float(speed.std / (2.0 * pi)),
        "mean_torque_nm": torque.mean,
        "torque_std_nm": torque.std,
    }


def _in_record(specimen: Specimen, torque: TorqueSettings, record: PlannedRecord) -> TorqueSettings:
    """Return how the torque varies in one record."""
    uniform = named_uniforms(specimen.seed, Stream.DRIVE, *record.owner)
    return replace(
        torque,
        slow=_slow(specimen, record, "variation.torque.random"),
        load_phase_rad=2.0 * pi * uniform("variation.torque.load_once.phase"),
        line_phase_rad=2.0 * pi * uniform("variation.torque.line_ripple.phase"),
    )


def _slow(specimen: Specimen, record: PlannedRecord, name: str) -> SlowVariation:
    rng = named_generator(specimen.seed, Stream.DRIVE, *record.owner, name=name)
    end_s = specimen.sampling.duration_s + MARGIN_S
    return slow_variation(rng, SLOW_CORNER_HZ, -TRANSIENT_CAP_S - MARGIN_S, end_s)
