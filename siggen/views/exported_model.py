"""One record's equations of motion as plain arrays, so that anybody can integrate the same record with other tools.

Every key is described in docs/reference/exported_model.md. What belongs to a mesh stands under `mesh.0.`, `mesh.1.`,
in the order of power; numbers and tables of its law under `mesh.0.law.`.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from siggen.drivetrain.drive import Rotation
from siggen.drivetrain.structure import MeshVectors, Structure, frame_turns, rolling, without_drift
from siggen.errors import UsageError
from siggen.file_writing import write_file
from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen
from siggen.mesh.law_tables import law_tables
from siggen.mesh.pair_law import PairLaw
from siggen.motion.decimation import half_length
from siggen.motion.equations import Equations
from siggen.motion.motion import Motion, both_settled_s, settling_steps
from siggen.record.drive import RecordDrive, start_angle_rad
from siggen.record.housing import SpecimenHousing, participation
from siggen.record.instrument import history_s
from siggen.record.simulation import at_point, state_drive
from siggen.record.specimen_state import refused_as, specimen_state
from siggen.record.step_choice import stepped_motion
from siggen.sources import installed_version

FORMAT_VERSION = 6
"""Raised when a key changes its meaning or goes away; new keys leave it."""

ENDING = ".npz"

Model = Mapping[str, Any]
"""Key -> array or plain value, see docs/reference/exported_model.md."""


def exported_model(gearbox: Specimen, record: PlannedRecord, **of_set: str) -> Model:
    """Return the model of one record: structure, mesh law, static state, start state and time grid.

    Parameters
    ----------
    gearbox : Specimen
    record : PlannedRecord
    of_set : what else it says of its set

    Raises
    ------
    SolverFailure
        If what was drawn cannot be built; says why.
    """
    specimen = gearbox.in_state(record.state_id)
    state = specimen_state(specimen, record.state_id)
    point = specimen.points[record.operating_point_id]
    with refused_as("outside_model"):
        specimen, state = at_point(specimen, state, record)
        driven = state_drive(specimen, state, record)
        (steps, _), motion, *_ = stepped_motion(specimen.sampling, specimen.law, state.mesh, point, driven)
        grid = _time_grid(specimen, motion, steps)
        start = motion.start(_first_pitches(motion, driven.rotation, grid["start_s"]))
    return {
        "format": "siggen exported model",
        "format_version": FORMAT_VERSION,
        "siggen_version": installed_version(),
        **of_set,
        "record_id": record.record_id,
        "state": specimen.states[record.state_id].name,
        **_structure(motion.structure),
        "static_deflection": motion.equations.static_deflection,
        "torque_nm": point.torque_nm,
        "integrator": specimen.law.method,
        "speed_hz": point.speed_hz,
        "start_angle_rad": start_angle_rad(specimen, record),
        **grid,
        **_inputs(driven, grid, motion.structure),
        "start_state": start,
        "law": specimen.law.kind,
        **_meshes(motion),
    }


def write_model(model: Model, path: Path) -> None:
    """Write a model as a compressed NumPy archive; the file appears as a whole or not at all.

    Raises
    ------
    UsageError
        If the path does not end with .npz or cannot be written.
    """
    check_model_file(path)
    arrays: dict[str, Any] = {name: np.asarray(value) for name, value in model.items()}

    def fill(draft: Path) -> None:
        with draft.open("wb") as file:  # NumPy would append its ending to a name
            np.savez_compressed(file, **arrays)

    write_file(path, fill)


def check_model_file(path: Path) -> None:
    """Refuse a path that no model can go to; call it before long work.

    Raises
    ------
    UsageError
        If the ending is unknown or the path is a folder.
    """
    if path.suffix.lower() != ENDING:
        raise UsageError(f"{path}: received the ending {path.suffix!r}; allowed is {ENDING}")
    if path.is_dir():
        raise UsageError(f"{path} is a folder; name a file in it, such as {path / 'model.npz'}")


def _structure(structure: Structure) -> dict[str, Any]:
    """Return matrices and vectors; a structure without bearings has no rows of bearing forces."""
    empty = np.empty((0, len(structure.coordinates)))
    forces = list(structure.bearing_forces.values())
    return {
        "coordinates": np.array(structure.coordinates),
        "rolling": rolling(structure) * (1.0 - frame_turns(structure)),
        "frame_turns": frame_turns(structure),
        "mass": structure.mass,
        "damping": structure.damping,
        "stiffness": structure.stiffness,
        "torque_vector": structure.torque_vector,
        "motion_names": np.array(list(structure.motions), dtype=np.str_),
        "motion_rows": np.array(list(structure.motions.values())) if structure.motions else empty,
        "bearing_force_names": np.array(list(structure.bearing_forces), dtype=np.str_),
        "bearing_force_stiffness_rows": np.array([k for k, _ in forces]) if forces else empty,
        "bearing_force_damping_rows": np.array([c for _, c in forces]) if forces else empty,
    }


def _meshes(motion: Motion) -> dict[str, Any]:
    """Return how many meshes there are, and what belongs to each."""
    found: dict[str, Any] = {"meshes": len(motion.structure.meshes)}
    per_radian = _pitches_per_rad(motion)
    for number, (mesh, law) in enumerate(zip(motion.structure.meshes, motion.laws, strict=True)):
        rate, begins = motion.places[number]
        own = {
            "name": mesh.name,
            "vector": mesh.vector,
            "sliding_vectors": mesh.sliding,
            "friction_vectors": without_drift(motion.structure, mesh.sliding),
            "rotations": np.array(mesh.turning),
            "equivalent_mass_kg": mesh.mass_kg,
            "pitches_per_rad": per_radian * rate,
            "begins_pitches": begins + mesh.flanks.ahead_pitches,
            **_static_part(motion.equations, number),
            **_tilt(mesh, motion.equations),
            **_law(law),
        }
        found |= {f"mesh.{number}.{name}": value for name, value in own.items()}
    return found


def _tilt(mesh: MeshVectors, equations: Equations) -> dict[str, Any]:
    """Return how gears of a mesh tilt, where they do."""
    if mesh.tilt is None:
        return {}
    return {
        "tilt_vector": mesh.tilt,
        "tilt_friction_vector": mesh.friction_tilt,
        "static_tilt_rad": float(mesh.tilt @ equations.static_deflection),
    }


def _static_part(equations: Equations, mesh: int) -> dict[str, Any]:
    return {
        "static_force_n": float(equations.static_force[mesh]),
        "static_approach_m": float(equations.static_approach[mesh]),
        "reference_stiffness_n_per_m": float(equations.reference_stiffness[mesh]),
    }


def _pitches_per_rad(motion: Motion) -> float:
    """Return the base pitches that the first mesh turns per angle of the first shaft, less what its frame turns."""
    return motion.teeth * (1.0 - frame_turns(motion.structure)) / (2.0 * np.pi)


def _first_pitches(motion: Motion, rotation: Rotation, time_s: float) -> float:
    """Return the base pitches that the first mesh has turned at a time."""
    turned = float(rotation.angle_rad(np.array([time_s]))[0]) * _pitches_per_rad(motion)
    return turned + motion.structure.mesh.flanks.ahead_pitches


def _time_grid(specimen: Specimen, motion: Motion, steps: int) -> dict[str, Any]:
    """Return rate and steps; the transient lies before time 0, as long as that of the record (`response_stream`)."""
    sampling = specimen.sampling
    step_s = 1.0 / (sampling.fs_hz * steps)
    settle_s = both_settled_s(motion.transient_s, history_s(specimen))
    settling = half_length(steps) + settling_steps(motion.transient_s, settle_s, sampling.fs_hz * steps)
    if motion.starts_settled:
        settling = steps * (half_length(1) + settling_steps(motion.transient_s, settle_s, sampling.fs_hz))
    return {
        "fs_hz": sampling.fs_hz,
        "samples": sampling.samples,
        "steps_per_sample": steps,
        "step_s": step_s,
        "start_s": -settling * step_s,
    }


def _inputs(driven: RecordDrive, grid: Mapping[str, Any], structure: Structure) -> dict[str, Any]:
    """Return angle and inputs at all steps up to the end of the filter behind the last sample, where they vary."""
    if driven.excitation is None:
        return {}
    count = round((grid["samples"] / grid["fs_hz"] - grid["start_s"]) / grid["step_s"])
    time_s = grid["start_s"] + np.arange(count + half_length(grid["steps_per_sample"]) + 1) * grid["step_s"]
    rows = driven.excitation.seat_force_rows(tuple(structure.bearing_forces))
    return {
        "angle_rad": driven.rotation.angle_rad(time_s),
        "inputs": driven.excitation.inputs(time_s, driven.rotation),
        "input_vectors": driven.excitation.vectors,
        "speed_input": driven.speed_input,
        **({"input_bearing_force_rows": rows} if rows.any() else {}),
    }


def _law(law: Any) -> dict[str, Any]:
    """Return numbers and tables of a law: a named tuple of them, or tooth pairs in packed form."""
    named = law_tables(law) if isinstance(law, PairLaw) else law._asdict()
    return {f"law.{name}": value for name, value in named.items()}


# Modes of a gearbox's housing as a table that `housing: {kind: modal}` reads: an example, and a check of both ways.

RESIDUAL_HZ, RESIDUAL_DAMPING = 1e10, 1e-6
"""Of residual vectors: so high that within any band they only give way (to 1e-11 at 30 kHz)."""
LEAST = 1e-15
"""Share of the largest flexibility below which what is left is rounding."""


def exported_modes(housing: SpecimenHousing) -> ModeTable:
    """Return the modes of a housing at its seats, sensors and entries; behind them what all higher modes give way.

    Derived. That flexibility is R = Σ λ_k v_k v_kᵀ over all places; a mode of frequency ω and shape √λ_k ω v_k gives
    way by as much. Such residual vectors are usual in finite elements (reference: standard literature).
    """
    places = {**housing.seats, **housing.motions, **{name: housing.entries[name] for name in DRIVE}}
    modes, motions = housing.modes, list(places.values())
    values, vectors = np.linalg.eigh(modes.residual_flexibility(motions, motions))
    kept = values > LEAST * max(float(values.max()), 0.0)
    beyond = vectors[:, kept] * np.sqrt(values[kept]) * (2.0 * pi * RESIDUAL_HZ)
    shapes = np.concatenate([modes.shapes(motions), beyond], axis=1)
    more = np.ones(int(kept.sum()))
    return ModeTable(
        frequency_hz=np.concatenate([modes.frequency_hz, RESIDUAL_HZ * more]),
        damping_ratio=np.concatenate([housing.damping_ratio, RESIDUAL_DAMPING * more]),
        shapes={name.removeprefix("casing_"): shape for name, shape in zip(places, shapes, strict=True)},
        base={name: np.concatenate([row, 0.0 * more]) for name, row in zip(BASE, participation(housing).T, strict=True)}
        if housing.bolts()
        else {},
    )
