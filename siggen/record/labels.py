"""Labels of a record: what is damaged, by how much, and at which speed and load it was recorded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.on_flank import with_outlines
from siggen.damage.part import Parts, teeth_of
from siggen.gearbox.specimen import DrawnState, OperatingPoint, Specimen
from siggen.gearbox.teeth import MadeGear, SpecimenErrors
from siggen.gears.flank_waves import FlankWaves
from siggen.gears.gear_pair import GearPair
from siggen.mesh.damage_summary import damage_summary
from siggen.mesh.mesh_stiffness import StiffnessOptions
from siggen.mesh.mesh_tables import largest_stiffness_loss
from siggen.motion.response import Sampling
from siggen.names import PLANETARY, SEVERAL, Side
from siggen.record.housing import MODES_ON_BOLTS, specimen_housing
from siggen.record.static_mesh import StaticMesh
from siggen.record.teeth import MeshTeeth


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


# Labels of the further meshes of a gearbox, and how those of all meshes make one label of the record.

ADDED = ("damage_count", "damaged_area_mm2")
LARGEST = (
    "damaged_area_share", "damage_face_length_mm", "damage_profile_length_mm", "contact_length_loss_mm",
    "mesh_stiffness_loss", "through_face", "sink_depth_um",
)  # fmt: skip
LOSS = "mesh_stiffness_loss_as_simulated"


def stage_labels(first: Mapping[str, Any], behind: Mapping[str, Mapping[str, Any]]) -> dict[str, object]:
    """Return the labels of a state by those of its first mesh and, by name, of each mesh behind it.

    Counts and areas add up; of shares, lengths and losses the largest counts.
    """
    every = (first, *behind.values())
    teeth = {
        f"faulty_teeth_{name}_{gear}": labels[f"faulty_teeth_{gear}"]
        for name, labels in behind.items()
        for gear in Side
    }
    added = {key: sum(labels[key] for labels in every) for key in ADDED}
    largest = {key: max(labels[key] for labels in every) for key in LARGEST}
    return {**first, **added, **largest, **teeth, "faulty_gear": _faulty_gear_of_all(first, behind)}


def stage_operating_labels(
    specimen: Specimen, first: Mapping[str, Any], behind: Sequence[StaticMesh]
) -> dict[str, object]:
    """Return teeth and frequencies of the further meshes, and the largest loss of stiffness of any mesh.

    Their first shaft is that of the first mesh's gear.
    """
    found: dict[str, object] = {}
    shaft_hz = float(first["gear_shaft_hz"])
    losses = [float(first[LOSS])]
    for mesh, static, turned in zip(specimen.behind, behind, specimen.shaft_turns[1:], strict=False):
        pair = static.pair
        losses.append(static.largest_loss(float(first["torque_nm"]) / float(turned)))
        found |= {f"teeth_{mesh.inner}_{gear}": pair.member(gear).teeth for gear in Side}
        found[f"mesh_{mesh.inner}_hz"] = shaft_hz * pair.pinion.teeth
        shaft_hz *= pair.pinion.teeth / pair.gear.teeth
        found[f"{mesh.inner}_shaft_hz"] = shaft_hz
    return {**found, LOSS: max(losses)} if behind else {}


def _faulty_gear_of_all(first: Mapping[str, Any], behind: Mapping[str, Mapping[str, Any]]) -> str:
    """Return which gear carries damage; `several` where gears of several meshes do."""
    each = {"": str(first["faulty_gear"]), **{name: str(one["faulty_gear"]) for name, one in behind.items()}}
    found = [f"{name}.{gear}" if name else gear for name, gear in each.items() if gear != "none"]
    return SEVERAL if len(found) > 1 or SEVERAL in each.values() else next(iter(found), "none")


# Labels of teeth as they were made: the columns of `siggen.columns.labels`.

Labels = dict[str, object]


def tooth_labels(teeth: MeshTeeth, state_id: int) -> Labels:
    """Return the labels of pinion and gear of a mesh in a state; none of perfect gears."""
    errors = teeth.errors(state_id)
    if errors is None:
        return {}
    drawn: Labels = {"manufacture_draw": "state" if teeth.teeth.redrawn else "specimen"}
    of_gears = (_errors(errors, teeth, side, side) | _waves(teeth, state_id, side, side) for side in Side)
    for labels in of_gears:
        drawn |= labels
    return drawn | {"lead_misalignment_um": 1e6 * errors.lead_misalignment_m}


def ring_and_planet_labels(suns: Sequence[MeshTeeth], ring: MeshTeeth, state_id: int, each: str) -> Labels:
    """Return the labels of a ring, and those of `each` planet towards the sun as lists."""
    of_ring = ring.errors(state_id)
    if of_ring is None:
        return {}
    planets = [_errors(errors, sun, Side.DRIVEN, each) for sun in suns if (errors := sun.errors(state_id)) is not None]
    return {
        **_errors(of_ring, ring, Side.DRIVEN, "ring"),
        **_waves(ring, state_id, Side.DRIVEN, "ring"),
        **{name: [one[name] for one in planets] for name in planets[0]},
    }


def _errors(errors: SpecimenErrors, teeth: MeshTeeth, side: Side, word: str) -> Labels:
    made: MadeGear = {Side.DRIVER: errors.pinion, Side.DRIVEN: errors.gear}[side]
    kinds = teeth.teeth.made
    largest, helix = made.found.largest, made.helix
    labels: Labels = {
        f"accuracy_class_{word}": made.accuracy_class,
        f"tolerance_share_{word}": made.tolerance_share,
        f"pitch_deviation_{word}_um": 1e6 * largest["pitch_m"],
        f"cumulative_pitch_{word}_um": 1e6 * largest["cumulative_pitch_m"],
        f"runout_{word}_um": 1e6 * largest["runout_m"],
        f"profile_slope_{word}_um": 1e6 * largest["profile_slope_m"],
        f"profile_form_{word}_um": 1e6 * largest["profile_form_m"],
        f"profile_deviation_{word}_um": 1e6 * largest["profile_m"],
    }
    if kinds is not None and kinds.crowned:
        labels[f"crowning_{word}_um"] = 1e6 * helix.crowning_m
    if kinds is not None and kinds.helices:
        labels[f"helix_slope_{word}_um"] = 1e6 * helix.slope_m
        labels[f"helix_form_{word}_um"] = 1e6 * float(np.ptp(helix.form_m))
    return labels


def _waves(teeth: MeshTeeth, state_id: int, side: Side, word: str) -> Labels:
    """Return the orders of a gear's ghosts, per turn of its shaft, and amplitudes before the contact's width."""
    waves = teeth.waves(state_id)
    if waves is None:
        return {}
    drawn: FlankWaves = {Side.DRIVER: waves.pinion, Side.DRIVEN: waves.gear}[side]
    count = waves.ghosts[side]
    return {
        f"ghost_orders_{word}": [int(n) for n in drawn.waves[:count]],
        f"ghost_amplitudes_{word}_um": [1e6 * float(a) for a in drawn.amplitude_m[:count]],
    }


# Labels of a planetary set: those of sun and first planet, seen as a pair, and what the ring and the others add.


def with_ring_labels(first: Mapping[str, Any], ring: Mapping[str, Any]) -> dict[str, object]:
    """Return the labels of a state by those of its sun with the first planet, and of that planet in the ring.

    Counts and areas add up; of shares, lengths and losses the largest counts.
    """
    gears = [str(one) for one in (first["faulty_gear"],) if one != "none"]
    gears += [PLANETARY.meshes[1].driven.word] * (ring["faulty_gear"] != "none")
    return {
        **first,
        **{key: first[key] + ring[key] for key in ADDED},
        **{key: max(first[key], ring[key]) for key in LARGEST},
        "faulty_gear": SEVERAL if len(gears) > 1 else next(iter(gears), "none"),
        "faulty_teeth_ring": ring["faulty_teeth_gear"],
    }


def planetary_labels(
    specimen: Specimen, labels: Mapping[str, Any], meshes: tuple[StaticMesh, ...]
) -> dict[str, object]:
    """Return the labels of a set by those of its sun and first planet as a pair; each planet carries its share.

    `meshes` are those of the first planet with the sun and with the ring, at rest.
    """
    if specimen.planets is None:
        return dict(labels)
    teeth, sun_hz = specimen.planets.teeth, float(labels["pinion_shaft_hz"])
    carrier_hz, of_each = sun_hz / (1.0 + teeth.ring / teeth.sun), float(labels["torque_nm"]) / len(teeth.places)
    torques = (of_each, of_each * teeth.planet / teeth.sun)
    return {
        **{name: value for name, value in labels.items() if name != "gear_shaft_hz"},
        "planet_hz": carrier_hz * teeth.ring / teeth.planet,
        "mesh_hz": carrier_hz * teeth.ring,
        LOSS: max(mesh.largest_loss(torque) for mesh, torque in zip(meshes, torques, strict=True)),
        "teeth_ring": teeth.ring,
        "planet_positions_deg": [360.0 * float(place) for place in teeth.places],
        "carrier_hz": carrier_hz,
        "pin_errors_um": [1e6 * error for error in specimen.planets.pin_errors_m],
    }
