"""How a record is driven: its rotation, its torque and the forces of its shafts, each with its own random course."""

from __future__ import annotations

from cmath import exp, phase
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import NamedTuple

import numpy as np

from siggen.damage.part import LostMetals, Parts, lost_moment_kg_m, without_metal
from siggen.drivetrain.drive import Drive, Rotation
from siggen.drivetrain.excitation import (
    Excitation,
    InputSource,
    SpeedDeviation,
    Unbalance,
    bearing_places,
    gear_directions,
    shaft_mass,
    turning_sense,
)
from siggen.drivetrain.structure import Structure
from siggen.drivetrain.varying_drive import (
    SLOW_CORNER_HZ,
    Ripple,
    SlowVariation,
    SpeedRamp,
    TorqueSettings,
    TorqueVariation,
    VaryingDrive,
    slow_variation,
)
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair
from siggen.motion.motion import TRANSIENT_CAP_S
from siggen.motion.response import Sampling
from siggen.names import Side
from siggen.record.bearing_spalls import spall_sources
from siggen.seeding import Stream, generator, named_generator, named_uniforms
from siggen.sensing.filters import BLOCK_SAMPLES
from siggen.sensing.measurement import Spread

# Forces that come with the rotation of a specimen's shafts: unbalance.

RATED_SPEED_HZ = 50.0
"""Of the pinion shaft, to which a grade of balance belongs; that of the others by their ratios."""


def force_sources(specimen: Specimen, structure: Structure) -> tuple[InputSource, ...]:
    """Return the unbalance of all shafts where a gearbox has it.

    Raises
    ------
    ValueError
        If the structure has no bearings.
    """
    levels = specimen.unbalance
    if levels is None:
        return ()
    shafts = zip(bearing_places(structure), map(float, specimen.shaft_turns), levels.phases_rad, strict=True)
    return tuple(_unbalance(structure, levels.grade_mm_s, *shaft) for shaft in shafts)


def _unbalance(structure: Structure, grade_mm_s: float, place: str, order: float, phase_rad: float) -> Unbalance:
    mass_kg, directions = shaft_mass(structure, place)
    return Unbalance(
        directions=directions,
        moment_kg_m=mass_kg * 1e-3 * grade_mm_s / (2.0 * pi * RATED_SPEED_HZ * order),
        order=order * turning_sense(structure, place),
        phase_rad=phase_rad,
    )


# Unbalance of shafts whose gears have lost metal: chipped and missing teeth.
#
# Derived. The first moments of what the teeth of a gear have lost add up as vectors; what is left is out of balance
# the other way. With e from the centre to where the line of action touches the base circle, pair n stands at s in the
# line of action, and the centre line of its driving tooth at s/R_b - α_b from e in the sense of its rotation, α_b the
# half angle of the tooth on the base circle; that of the driven tooth at α_b - s/R_b, with s from its own end.


class MeshPlace(NamedTuple):
    """Number of a mesh, the turns of its pinion per turn of the first one, and `MeshBehind.turned_pitches`."""

    number: int = 0
    turning: float = 1.0
    turned_pitches: float = 0.0


FIRST = MeshPlace()


def lost_mass_sources(
    pair: GearPair, structure: Structure, parts: Parts, place: MeshPlace = FIRST
) -> tuple[Unbalance, ...]:
    """Return the unbalance of each gear of a mesh that has lost metal, by all of its teeth together.

    In a model of rotations alone no shaft can shake, so there is none.
    """
    lost = without_metal(parts) if structure.bearing_directions else ()
    by_gear = {side: tuple(one for one in lost if one.gear == side) for side in Side}
    return tuple(_lost_unbalance(pair, structure, side, own, place) for side, own in by_gear.items() if own)


def tooth_angle_rad(pair: GearPair, side: Side, tooth: int) -> float:
    """Return where a tooth's centre line is while the pinion's angle is 0, from e in the sense of rotation [rad]."""
    gear = pair.member(side)
    behind = 2.0 * pi * tooth / gear.teeth
    if side == Side.DRIVER:
        return pair.contact_start_m / gear.base_radius_m - gear.base_half_angle_rad - behind
    own_end = pair.line_of_action_m - pair.contact_start_m
    return gear.base_half_angle_rad - own_end / gear.base_radius_m - behind


def _lost_unbalance(pair: GearPair, structure: Structure, side: Side, lost: LostMetals, at: MeshPlace) -> Unbalance:
    gear, driven = pair.member(side), int(side == Side.DRIVEN)
    mesh = structure.drivetrain.meshes[at.number]
    directions = gear_directions(structure, (mesh.driven if driven else mesh.driver).body)
    sense = turning_sense(structure, bearing_places(structure)[at.number + driven])
    begins_rad = 2.0 * pi * at.turned_pitches / gear.teeth
    moment = -sum(
        lost_moment_kg_m(gear, one, pair.face_width_m)
        * exp(1j * sense * (tooth_angle_rad(pair, side, one.tooth) + begins_rad))
        for one in lost
    )
    # A gear that moves along -e slides its flank forwards over its mate's.
    horizontal, vertical = -(directions @ structure.meshes[at.number].sliding[0])
    order = sense * at.turning * pair.pinion.teeth / gear.teeth
    return Unbalance(directions, abs(moment), order, phase(moment) + phase(complex(horizontal, vertical)))


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
