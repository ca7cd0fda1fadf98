"""A gear in two meshes: one body whose torques cancel, and whose two flanks carry errors and damage of their own."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.checks.loading import load_config
from siggen.gearbox.design import SetDesign
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.gears.errors import eccentric_m
from siggen.motion.equations import no_inputs
from siggen.motion.pair_motion import PairMotion
from siggen.record.motion import SpecimenMesh, specimen_motion
from siggen.record.specimen_state import specimen_state
from siggen.record.structure import structure
from siggen.record.teeth import MeshTeeth, all_teeth
from tests.config.idler import idler, with_idler

STEP_S = 1.0 / (25600 * 16)
SMOOTH = {"dynamics": {"model": "8dof", "friction": {"model": "off"}, "mesh_damping_ratio": 0.07}}


@cache
def machine(state: int = 0, **changes: object) -> tuple[SetDesign, Specimen, SpecimenMesh, OperatingPoint]:
    config = load_config(idler(**SMOOTH, **changes))
    specimen = config.gearbox(0)
    return config, specimen, specimen_state(specimen, state).mesh, config.drawn_points(0)[0]


def motion_of(mesh: SpecimenMesh) -> PairMotion:
    _, specimen, _, point = machine()
    motion = specimen_motion(specimen.law, mesh, point, STEP_S)
    assert isinstance(motion, PairMotion)
    return motion


def run(motion: PairMotion, steps: int) -> tuple[FloatArray, FloatArray]:
    pitches = 18 * 30.0 * STEP_S * np.arange(steps + 1) + 0.3
    states = np.empty((steps + 1, 2 * len(motion.structure.coordinates)))
    states[0] = motion.start(pitches[0])
    motion.advance(pitches, no_inputs(pitches), states)
    return pitches, states


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize("direction_deg", [60.0, -100.0])
def test_no_mesh_notices_that_the_whole_machine_is_moved_and_turned_as_one_body(direction_deg: float) -> None:
    """Turned about the idler by ω, the gear at d moves by ω x d; shafts that turn back count their rotation so."""
    config = load_config(idler(machine=with_idler("meshes", "second", direction_deg=direction_deg)))
    specimen = config.gearbox(0)
    found = structure(specimen)
    names, place = found.coordinates, np.radians(direction_deg)
    to_a, to_c = (-0.045, 0.0), (0.062 * np.cos(place), 0.062 * np.sin(place))
    body = {"theta_a": 1.0, "theta_b": -1.0, "theta_c": 1.0}
    body |= {"x_a": -to_a[1], "y_a": to_a[0], "x_c": -to_c[1], "y_c": to_c[0]}
    shift = {f"{axis}_{gear}": value for gear in "abc" for axis, value in (("x", 0.7), ("y", -0.4))}
    for mesh in found.meshes:
        for motion in (body, shift):
            whole = sum(mesh.vector[names.index(name)] * value for name, value in motion.items())
            assert whole == pytest.approx(0.0, abs=1e-12)
    turning = [name for name in names if name.startswith("theta")]
    assert turning == ["theta_motor", "theta_a", "theta_b", "theta_c", "theta_load"]


def test_torques_on_the_idler_cancel_and_its_bearing_holds_the_sum_of_both_tooth_forces() -> None:
    """Both are T/R_b; they stand at the angle between the centre lines, less a pressure angle each, to each other."""
    _, _, mesh, point = machine()
    equations = motion_of(mesh).equations
    radius = mesh.pair.pinion.base_radius_m
    assert equations.static_force == pytest.approx([point.torque_nm / radius] * 2, rel=1e-9)
    found, names = mesh.structure, list(mesh.structure.coordinates)
    turned = [names.index("theta_b")]
    work = sum(force * one.vector[turned] for force, one in zip(equations.static_force, found.meshes, strict=True))
    assert work == pytest.approx(0.0, abs=1e-9 * point.torque_nm)
    axes = ("horizontal", "vertical")
    held = [found.bearing_forces[f"middle_bearing/{axis}"][0] @ equations.static_deflection for axis in axes]
    # pushed at 90° - 20° from the first line of centres, and back at -90° + 20° from the second one, at 60°
    first, second = np.radians(0.0 + 90.0 - 20.0), np.radians(60.0 - 90.0 + 20.0)
    expected = point.torque_nm / radius * (np.exp(1j * first) - np.exp(1j * second))
    assert held == pytest.approx([expected.real, expected.imag], rel=1e-9)


def test_an_idler_too_heavy_to_move_parts_both_meshes() -> None:
    """Then neither sees the other: with other phases of the second mesh the first one moves as it did."""
    _, _, mesh, _ = machine()
    built = mesh.structure
    factor = np.array([1e6 if name.endswith("_b") else 1.0 for name in built.coordinates])
    heavy = replace(mesh, structure=replace(built, mass=built.mass * factor))
    at = len(built.coordinates) + built.coordinates.index("theta_a")
    found = []
    for own in (heavy, mesh):
        (behind,) = own.behind
        later = replace(own, behind=(behind._replace(turned_pitches=behind.turned_pitches + 0.4),))
        one, other = (run(motion_of(each), 4000)[1][:, at] for each in (own, later))
        found.append(rms(one - other) / rms(one))
    # what is left is the idler's motion: one over how much heavier it is, times a stiffness ratio of about ten
    assert found[0] < 1e-5
    assert found[1] > 0.1


def test_a_flank_acts_in_its_own_mesh_alone() -> None:
    """A spall on either flank of tooth 5: the other mesh has sound teeth only."""
    for state, damaged in ((1, [True, False]), (2, [False, True])):
        mesh = machine(state)[2]
        tables = [one.mesh.tables.table_of_pair for one in mesh.every]
        assert [bool(one.any()) for one in tables] == damaged
        hit = tables[damaged.index(True)]
        teeth = np.flatnonzero(hit.any(axis=0 if damaged[0] else 1))
        assert teeth.tolist() == [5]


def missing_m(made: MeshTeeth, which: str, pitches: FloatArray) -> FloatArray:
    """Return what the eccentricity takes from the pair that is in contact (k,) [m], `pitches` after pair 0 entered."""
    errors = made.errors(0)
    assert errors is not None
    number = np.floor(pitches).astype(int)
    position = made.pair.contact_start_m + (pitches - number) * made.pair.base_pitch_m
    every = eccentric_m(made.pair, which, getattr(errors, which).errors, position)
    return np.asarray(every[number % made.pair.member(which).teeth, np.arange(pitches.size)])


def test_an_eccentric_idler_stands_back_from_both_gears_as_the_structure_says_of_its_shift() -> None:
    """The shift is found from the first mesh by the vectors of the motion, turned, and told to the second one's."""
    config = load_config(idler(**SMOOTH, manufacture={"accuracy_class": 6}))
    specimen = config.gearbox(0)
    made, found = all_teeth(specimen), structure(specimen)
    mesh = specimen_state(specimen, 0).mesh
    rows = [found.coordinates.index(f"{axis}_b") for axis in "xy"]
    ahead, behind = (one.vector[rows] for one in found.meshes)
    turned = 30.0 + np.linspace(0.0, 27.0, 53)  # pitches
    angle = -2.0 * np.pi * turned / 27  # the idler turns back
    turns = np.stack([np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)]).reshape(2, 2, -1)
    shift = np.linalg.lstsq(-np.einsum("a,bak->kb", ahead, turns), missing_m(made[0], "gear", turned), rcond=None)
    expected = -np.einsum("a,bak,b->k", behind, turns, shift[0])
    found_m = missing_m(made[1], "pinion", turned + mesh.behind[0].turned_pitches)
    assert np.ptp(expected) > 1e-6
    assert found_m == pytest.approx(expected, abs=1e-9 * np.ptp(expected))
