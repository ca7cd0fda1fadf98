"""Spalled bearings of a specimen as what acts on its structure in one record.

The force that loads a bearing is the mean one of this gearbox at this operating point: what the mean torque presses
through the teeth, half of it on each of the two bearings of a shaft; weight too where `dynamics.<shaft>.bearing` says
which bearing it is. Else a spall is in one of the default numbers. Slip and walk of the cage belong to the record.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.bearing_spall import CageCourse, RollingSpall, SpalledBearing, cage_course, in_bearings, mean_zone
from siggen.damage.part import Part, Parts
from siggen.drivetrain.drive import Rotation
from siggen.drivetrain.excitation import bearing_direction, shaft_direction, shaft_directions, turning_sense
from siggen.drivetrain.structure import Structure
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.motion.motion import TRANSIENT_CAP_S
from siggen.names import Side
from siggen.record.structure import BEARINGS, specimen_bearings, supported_stage
from siggen.seeding import Stream, named_generator

SLIP = (0.01, 0.02)
"""Share by which the cage lags, drawn per record (memory: 1 to 2 %)."""
WALK = (0.005, 0.02)
"""Standard deviation of a step of the cage as each ball passes, as a share of the angle between two (memory)."""
AXES = ("horizontal", "vertical")
MARGIN_S = 1.0
"""Beyond transient and record, for the filters."""


def spall_sources(
    specimen: Specimen, structure: Structure, record: PlannedRecord, rotation: Rotation, parts: Parts
) -> tuple[SpalledBearing, ...]:
    """Return what the spalls among the parts of a damage push, but for those that no loaded ball passes.

    Raises
    ------
    ValueError
        If the structure has no bearings.
    """
    found = []
    bearings, point = specimen_bearings(specimen), specimen.points[record.operating_point_id]
    for drawn in in_bearings(parts):
        own = bearings.get(drawn.shaft)
        spall = drawn if own is None else replace(drawn, bearing=own.bearing)
        order = 1.0 if spall.shaft == Side.DRIVER else specimen.pair.pinion.teeth / specimen.pair.gear.teeth
        place = specimen.names.bearings[spall.place]
        force_n = mean_force_n(specimen, structure, point, place) / BEARINGS if own is None else own.force_n
        shares = _transmitted(specimen, structure, spall.shaft, place)
        rows = np.array([bearing_direction(structure, place, axis) for axis in AXES])
        source = SpalledBearing(
            spall=spall,
            zone=mean_zone(spall, force_n),
            cage=_cage(specimen, record, rotation, spall, order),
            order=order * turning_sense(structure, place),
            directions=shares.T @ rows,
            on_seat={f"{place}/{axis}": row for axis, row in zip(AXES, -shares, strict=True)},
        )
        if source.ever_pushes:
            found.append(source)
    return tuple(found)


def mean_force_n(specimen: Specimen, structure: Structure, point: OperatingPoint, place: str) -> FloatArray:
    """Return the mean force (2,) of a shaft on its seats, horizontal and vertical: that of the teeth."""
    along = structure.mesh.vector * (point.torque_nm / specimen.pair.pinion.base_radius_m)
    return np.asarray(-shaft_directions(structure, place) @ along)


def _transmitted(specimen: Specimen, structure: Structure, shaft: Side, place: str) -> FloatArray:
    """Return the share (2, 2) of a bearing's lost load that shaft and seat feel: along both axes, by loss along both.

    What moves in series with a bearing's spring is felt through all that is in series with it: the shaft's bending, the
    seat's giving way. With stiff ones it is 1. What one axis passes to the other by shaft and seat is left out unless
    the bearing does so too.
    """
    own = getattr(supported_stage(specimen), shaft).bearing
    names = [f"{place}/{axis}" for axis in AXES]
    whole = [float(structure.bearing_forces[name][0] @ shaft_direction(structure, name)) for name in names]
    if own.stiffness_xy_n_per_m == 0.0:
        return np.diag([whole[0] / own.stiffness_x_n_per_m, whole[1] / own.stiffness_y_n_per_m])
    x, xy, y = own.stiffness_x_n_per_m, own.stiffness_xy_n_per_m, own.stiffness_y_n_per_m
    crossed = [[structure.bearing_forces[n][0] @ shaft_direction(structure, other) for other in names] for n in names]
    return np.asarray(np.array(crossed) @ np.array([[y, -xy], [-xy, x]]) / (x * y - xy * xy))


def drawn_labels(seed: int, record: PlannedRecord, part: Part) -> dict[str, object]:
    """Return what a row of the table of damage tells of a part in this record alone: the slip of a spalled bearing."""
    return {"slip_share": _slip_and_walk(seed, record, part)[0]} if isinstance(part, RollingSpall) else {}


def _slip_and_walk(seed: int, record: PlannedRecord, spall: RollingSpall) -> tuple[float, float, np.random.Generator]:
    """Return slip and walk of a bearing's cage in a record, and the generator of its steps."""
    rng = named_generator(seed, Stream.DRIVE, *record.owner, name=f"bearing_spall.{spall.shaft}.cage")
    slip, walk = (low + (high - low) * rng.random() for low, high in (SLIP, WALK))
    return slip, walk, rng


def _cage(
    specimen: Specimen, record: PlannedRecord, rotation: Rotation, spall: RollingSpall, order: float
) -> CageCourse:
    slip, walk, rng = _slip_and_walk(specimen.seed, record, spall)
    end_s = specimen.sampling.duration_s + MARGIN_S
    ends = rotation.angle_rad(np.array([-TRANSIENT_CAP_S - MARGIN_S, end_s]))
    return cage_course(spall.bearing, rng, slip, walk, (order * float(ends[0]), order * float(ends[1])))
