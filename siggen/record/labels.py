"""Labels of a record: what is damaged, by how much, and at which speed and load it was recorded."""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.dynamics.time.sampling import Sampling
from siggen.gearbox.specimen import DrawnState, OperatingPoint, Specimen
from siggen.gears.damage.flank_loss import with_outlines
from siggen.gears.damage.part import Parts, teeth_of
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.damage_summary import damage_summary
from siggen.gears.stiffness.mesh_stiffness import StiffnessOptions
from siggen.gears.stiffness.mesh_tables import largest_stiffness_loss
from siggen.names import SEVERAL, Side
from siggen.specimen.housing import specimen_housing
from siggen.specimen.specimen_housing import MODES_ON_BOLTS
from siggen.specimen.static_mesh import StaticMesh


def _faulty_gear(parts: Parts) -> str:
    found = {one.gear for one in parts} & set(Side)
    return SEVERAL if len(found) > 1 else next(iter(found), "none")


def damage_labels(
    state: DrawnState, pair: GearPair, parts: Parts, options: StiffnessOptions, sink_depth_m: float = 0.0
) -> dict[str, object]:
    """Return the labels that follow from the damage alone: fault, severity, teeth, areas, lengths and losses.

    mesh_stiffness_loss is by the stiffness model (shorter contact, weaker sections) however the damage acts on the
    motion, so sets compare. For damage through the face it counts a pair without contact length as one that carries
    nothing, though in motion its flank sinks by `sink_depth_m` [m] and then rests on the edges of the damage: that is
    what mesh_stiffness_loss_as_simulated tells, which depends on the torque (`operating_labels`).
    """
    damage = with_outlines(parts, pair)
    summary = damage_summary(pair, damage)
    shown = () if state.sham else parts
    return {
        "state": state.name,
        "fault": state.fault,
        "severity": state.severity,
        "faulty_gear": _faulty_gear(shown),
        "faulty_teeth_pinion": teeth_of(shown, Side.DRIVER),
        "faulty_teeth_gear": teeth_of(shown, Side.DRIVEN),
        "damage_count": len(shown),
        "damaged_area_mm2": 1e6 * summary.union_area_m2,
        "damaged_area_share": summary.area_share,
        "damage_face_length_mm": 1e3 * summary.largest_face_length_m,
        "damage_profile_length_mm": 1e3 * summary.largest_profile_length_m,
        "contact_length_loss_mm": 1e3 * summary.contact_length_loss_m,
        "mesh_stiffness_loss": largest_stiffness_loss(pair, damage, options),
        "through_face": summary.through_face,
        "sink_depth_um": 1e6 * sink_depth_m,
    }


def gearbox_labels(specimen: Specimen) -> dict[str, object]:
    """Return what a gearbox draws as a whole: pair, oil, housing, places of sensors; nothing that all share."""
    labels, housing = {column.name: value for column, value in specimen.labels.items()}, specimen_housing(specimen)
    if housing is None or housing.box is None:
        return labels
    first_hz = float(housing.modes.frequency_hz[MODES_ON_BOLTS])
    return {**labels, "housing_mass_kg": housing.box.mass_kg, "housing_first_mode_hz": first_hz}


def operating_labels(
    pair: GearPair, point: OperatingPoint, ends_rad: FloatArray, sampling: Sampling, static: StaticMesh
) -> dict[str, object]:
    """Return teeth, commanded speed and torque, the frequencies that the record really has, and the loss at its torque.

    `ends_rad` (2,) are the pinion's angles at the first and the last sample; `static` is the mesh of the
    state at rest.
    """
    shaft_hz = float((ends_rad[1] - ends_rad[0]) / (6.283185307179586 * (sampling.samples - 1) / sampling.fs_hz))
    return {
        "teeth_pinion": pair.pinion.teeth,
        "teeth_gear": pair.gear.teeth,
        "speed_hz": point.speed_hz,
        "torque_nm": point.torque_nm,
        "pinion_shaft_hz": shaft_hz,
        "gear_shaft_hz": shaft_hz * pair.pinion.teeth / pair.gear.teeth,
        "mesh_hz": shaft_hz * pair.pinion.teeth,
        "mesh_stiffness_loss_as_simulated": static.largest_loss(point.torque_nm),
    }
