"""A gearbox of two stages from its configuration: torques, power, and limits in which stages no longer see each other.

Teeth 18/47 and 17/52. What single stages do has its own tests; here they are the reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.checks.loading import load_config
from siggen.config import read_yaml
from siggen.drivetrain.excitation import InputSource, Unbalance, shaft_mass
from siggen.drivetrain.structure import Structure
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.motion.equations import no_inputs
from siggen.motion.pair_motion import PairMotion
from siggen.names import PAIR
from siggen.record.drive import force_sources, record_drive, start_angle_rad
from siggen.record.motion import SpecimenMesh, specimen_motion
from siggen.record.specimen_state import specimen_state
from siggen.record.structure import structure
from tests.config.minimal import by_name
from tests.config.staged import in_a_row
from tests.simulated import internals_table

ROOT = Path(__file__).resolve().parents[2]

GEARS = ("pinion", "gear", "slow_pinion", "slow_gear")
TEETH = (18, 47, 17, 52)
SLOW = {
    "name": "slow",
    "gears": {
        "module_mm": 3.0,
        "face_width_mm": 30.0,
        "pinion": {"teeth": 17, "bore_radius_mm": 15.0},
        "gear": {"teeth": 52, "bore_radius_mm": 25.0},
    },
    "direction_deg": 70.0,
}
SENSOR = {"name": "top", "place": "pinion_bearing", "axes": ["vertical"]}
WITHOUT_FRICTION = ("dynamics.friction.model=off", "dynamics.mesh.damping=constant")
STEP_S = 1.0 / (51200 * 8)


def two_stages(**stage: Any) -> dict[str, Any]:
    """Return the gearbox of the tests on bearings in the ground, with a second stage, as in a file."""
    raw = {**read_yaml(ROOT / "tests/configs/casing.yaml"), "sensors": by_name([SENSOR])}
    rotors = {which: raw["dynamics"].pop(which) for which in ("pinion", "gear")}
    own = {"machine": in_a_row(raw.pop("gears"), [{**SLOW, **stage}], rotors), "housing": {}, "duration_s": 0.2}
    return {**raw, **own, "dynamics": {**raw["dynamics"], "model": "8dof"}}


@cache
def config(*overrides: str) -> SetDesign:
    return load_config(two_stages(), overrides)


@cache
def machine(*overrides: str) -> tuple[SetDesign, Specimen, SpecimenMesh, OperatingPoint]:
    found = config(*overrides)
    specimen = found.gearbox(0)
    return found, specimen, specimen_state(specimen, 0).mesh, found.drawn_points(0)[2]


def run(motion: PairMotion, pitches: FloatArray) -> FloatArray:
    """Return the velocities (steps, n) from rest."""
    states = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))
    states[0] = motion.start(pitches[0])
    motion.advance(pitches, no_inputs(pitches), states)
    return states[:, len(motion.structure.coordinates) :]


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def base_radii_m(*meshes: SpecimenMesh) -> list[float]:
    return [gear.base_radius_m for mesh in meshes for gear in (mesh.pair.pinion, mesh.pair.gear)]


def test_teeth_and_bearings_carry_the_torque_of_their_shaft_at_rest() -> None:
    """F = T/R_b of the shaft's pinion; on the middle shaft both tooth forces and the bearings leave nothing."""
    _, specimen, mesh, point = machine(*WITHOUT_FRICTION)
    motion = specimen_motion(specimen.law, mesh, point, STEP_S)
    r_1, r_2, r_3, _ = base_radii_m(mesh, mesh.behind[0].mesh)
    first = point.torque_nm / r_1
    assert motion.equations.static_force == pytest.approx([first, first * r_2 / r_3], rel=1e-9)
    moved = motion.equations.static_deflection
    names = list(mesh.structure.coordinates)
    pushed = sum(
        force * vectors.vector[[names.index(f"x_{gear}"), names.index(f"y_{gear}")]]
        for force, vectors, gear in zip(motion.equations.static_force, mesh.structure.meshes, GEARS[1:3], strict=True)
    )
    axes = ("horizontal", "vertical")
    held = [mesh.structure.bearing_forces[f"gear_bearing/{axis}"][0] @ moved for axis in axes]
    assert held == pytest.approx(-pushed, rel=1e-9)


@cache
def rubbing_record() -> dict[str, FloatArray]:
    table = internals_table(config("duration_s=0.5", "operating_points.2={speed_hz: 35.0, torque_nm: 40.0}"), 2)
    facts = {key.decode(): float(table.schema.metadata[key]) for key in (b"speed_hz", b"torque_nm")}
    columns = {name: table[name].to_numpy() for name in table.column_names}
    slow_s = 47 / (18 * 17 * facts["speed_hz"])  # one mesh of the second stage, several of the first
    whole = int(int(0.5 / slow_s) * slow_s * 51200)
    return {name: values[:whole].mean() for name, values in columns.items()} | facts | {"columns": columns}


def test_torques_of_teeth_and_friction_balance_on_every_shaft_on_the_mean() -> None:
    """By the columns of a record with friction, which takes about a percent in either mesh."""
    mean, (_, _, mesh, _) = rubbing_record(), machine()
    r_1, r_2, r_3, _ = base_radii_m(mesh, mesh.behind[0].mesh)
    torque = mean["torque_nm"]
    # Friction moments of mixed sign; the record's ends leave 1e-4 of the torque.
    assert r_1 * mean["fast_mesh_force_n"] + mean["fast_friction_moment_pinion_nm"] == pytest.approx(torque, rel=3e-4)
    driven = r_2 * mean["fast_mesh_force_n"] + mean["fast_friction_moment_gear_nm"]
    driving = r_3 * mean["slow_mesh_force_n"] + mean["slow_friction_moment_slow_pinion_nm"]
    assert driven == pytest.approx(driving, rel=3e-4)
    assert abs(mean["fast_friction_moment_gear_nm"]) > 1e-3 * driven


def test_power_in_is_power_out_and_what_friction_of_both_meshes_takes() -> None:
    mean, (_, _, mesh, _) = rubbing_record(), machine()
    *_, r_4 = base_radii_m(mesh, mesh.behind[0].mesh)
    speed = 2.0 * pi * mean["speed_hz"]
    out_nm = r_4 * mean["slow_mesh_force_n"] + mean["slow_friction_moment_slow_gear_nm"]
    given = mean["torque_nm"] * speed
    taken = given - out_nm * speed * 18 / 47 * 17 / 52
    columns = mean["columns"]
    lost = {
        name: float(
            sum((columns[f"{name}pair_{k}_friction_n"] * columns[f"{name}pair_{k}_sliding_m_s"]).mean() for k in (0, 1))
        )
        for name in ("fast_", "slow_")
    }
    assert min(lost.values()) > 1e-3 * given
    # Of the power that is lost; the record's ends leave some 1e-4 of the power.
    assert taken == pytest.approx(sum(lost.values()), abs=3e-4 * given)


def with_heavy(found: Structure, names: Sequence[str]) -> Structure:
    heavy = np.where(np.isin(found.coordinates, names), 1e8, 1.0)
    return replace(found, mass=found.mass * heavy)


def test_a_middle_shaft_too_heavy_to_move_leaves_two_single_stages() -> None:
    """Then the first stage is one whose gear stands still, and the second one whose pinion does."""
    _, specimen, mesh, point = machine(*WITHOUT_FRICTION)
    middle = [f"{kind}_{gear}" for kind in ("x", "y", "theta") for gear in GEARS[1:3]]
    pitches = 18 * point.speed_hz * STEP_S * np.arange(8001) + 0.3
    both = specimen_motion(specimen.law, mesh.on(with_heavy(mesh.structure, middle)), point, STEP_S)
    velocities = dict(zip(both.structure.coordinates, run(both, pitches).T, strict=True))

    train = specimen.train
    assert train is not None
    single = replace(specimen, meshes=specimen.meshes[:1], train=replace(train, behind=()), names=PAIR)
    made = structure(single)
    first = replace(mesh, structure=with_heavy(made, ["x_gear", "y_gear", "theta_gear"]), behind=())
    wanted = run(specimen_motion(single.law, first, point, STEP_S), pitches).T
    for name, expected in zip(made.coordinates[:4], wanted[:4], strict=True):
        # What is left is the motion of the shaft, 1e-8 times a few ratios of stiffness and inertia.
        assert rms(velocities[name] - expected) < 1e-6 * rms(expected)

    behind, (stage,) = mesh.behind[0], train.behind
    shared = {name: getattr(stage, name) for name in ("working_pressure_angle_rad", "pinion", "gear")}
    alone = replace(train, first=replace(train.first, **shared), behind=())
    own = replace(single, meshes=specimen.meshes[1:], train=alone)
    made = structure(own)
    second = replace(behind.mesh, structure=with_heavy(made, ["x_pinion", "y_pinion", "theta_pinion"]))
    turned = pitches * float(specimen.shaft_turns[1]) * 17 / 18 + behind.turned_pitches
    slow = specimen_motion(own.law, second, point.turned(float(specimen.shaft_turns[1])), STEP_S)
    # Its line of centres is turned by 70°, and its pinion runs backwards: a mirror and a turn, on equal bearings.
    wanted = run(slow, turned).T
    for name, expected in zip(("theta_slow_gear", "theta_load"), wanted[[6, 7]], strict=True):
        assert rms(velocities[name] - expected) < 1e-6 * rms(expected)


def test_all_teeth_meet_as_at_the_start_after_the_hunting_turns_and_not_before() -> None:
    found, specimen, _, _ = machine()
    whole = int(specimen.hunting_turns)
    z_1, z_2, z_3, z_4 = TEETH

    def as_at_start(turned: int) -> bool:
        """Shafts turn by whole turns: teeth that have passed are multiples of what is on the next gear."""
        second = turned * z_1
        return second % z_2 == 0 and (second // z_2) * z_3 % z_4 == 0

    # A first pinion that turns by whole turns only; tooth and gap of a shaft in front have to stand as they did.
    assert as_at_start(whole)
    assert not any(as_at_start(turned) for turned in range(1, whole))
    angles = [start_angle_rad(specimen, planned_record(found, record)) for record in range(12)]
    assert 0.5 * whole < max(angles) / (2.0 * pi) < whole


def balance(sources: Sequence[InputSource]) -> tuple[list[float], list[float]]:
    """Return order and moment [kg m] of unbalances."""
    orders = [one.order for one in sources if isinstance(one, Unbalance)]
    return orders, [one.moment_kg_m for one in sources if isinstance(one, Unbalance)]


def test_every_shaft_is_out_of_balance_by_the_mass_of_its_gears_and_turns_against_the_one_in_front() -> None:
    _, specimen, mesh, _ = machine("dynamics.unbalance={grade_mm_s: 6.3}")
    built = mesh.structure
    orders, moments = balance(force_sources(specimen, built))
    assert orders == pytest.approx([1.0, -18 / 47, 18 / 47 * 17 / 52])
    masses = [built.mass[(built.coordinates.index(f"x_{gear}"),) * 2] for gear in GEARS]
    of_shafts = np.array([masses[0], masses[1] + masses[2], masses[3]])
    assert np.array(moments) * np.abs(orders) * 100.0 * pi == pytest.approx(6.3e-3 * of_shafts)
    # On the middle shaft each gear is pulled by its own mass, and both together as one mass is.
    _, pulled = shaft_mass(built, "gear_bearing")
    rows = [built.coordinates.index(name) for name in ("x_gear", "x_slow_pinion")]
    assert pulled[0, rows] == pytest.approx(np.array(masses[1:3]) / sum(masses[1:3]), rel=1e-12)


@pytest.mark.parametrize(("gear", "order"), [("gear", -18 / 47), ("slow_pinion", -18 / 47), ("slow_gear", 306 / 2444)])
def test_a_missing_tooth_of_any_gear_shakes_that_gear(gear: str, order: float) -> None:
    """A missing tooth leaves a mass on the other side, which turns with its shaft and stands at its tooth's angle."""
    damage = f"{{kind: chip, gear: {gear}, height_mm: whole}}"
    found = config(f"states={{healthy: {{}}, slight: {{damage: {damage}}}}}")
    specimen, record = found.gearbox(0), planned_record(found, 3)
    state = specimen_state(specimen, 1)
    point, built = found.drawn_points(0)[0], state.mesh.structure
    driven = record_drive(specimen, built, record, state.parts, state.parts_behind)
    assert driven.excitation is not None
    assert driven.excitation.vectors.shape[0] == 2
    names = [built.coordinates.index(f"{axis}_{gear}") for axis in "xy"]
    assert np.abs(driven.excitation.vectors[:, names]) == pytest.approx(np.eye(2), abs=1e-12)
    assert np.count_nonzero(driven.excitation.vectors) == 2
    times = np.arange(4) * 0.25 / (abs(order) * point.speed_hz)
    force = driven.excitation.inputs(times, driven.rotation) @ driven.excitation.vectors[:, names]
    turned = np.unwrap(np.angle(force[:, 0] + 1j * force[:, 1]))
    assert np.diff(turned) == pytest.approx(np.sign(order) * pi / 2 * np.ones(3), rel=1e-9)


def test_shafts_that_let_gears_part_are_refused_with_the_place_to_change() -> None:
    found = load_config(two_stages(span_mm=1500.0), WITHOUT_FRICTION)
    specimen = found.gearbox(0)
    motion = specimen_motion(specimen.law, specimen_state(specimen, 0).mesh, found.drawn_points(0)[0], STEP_S)
    with pytest.raises(ValueError, match="machine: a gear moves by"):
        motion.start(0.0)
