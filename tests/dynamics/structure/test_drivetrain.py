"""Two stages in a row: their shafts against finite elements, their meshes against drawn gears, and limits of both."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.drivetrain.gear_stage import Bearing, CommonShaft, Coupling, NextStage, Rotor
from siggen.drivetrain.structure import Structure, rigid_rotation, static_solution
from siggen.motion.equations import mesh_springs
from siggen.motion.modes import natural_modes
from tests.dynamics.casing_stage import bearing, make_stage
from tests.dynamics.trains import eight_dof, stages

GEARS = ("pinion", "gear", "slow_pinion", "slow_gear")
ANGLES = np.radians([20.0, 22.5])
RADII = (0.5 * 3e-3 * 18 * cos(ANGLES[0]), 0.5 * 3e-3 * 47 * cos(ANGLES[0]), 0.021, 0.066)
SHAFT = CommonShaft(0.1, 0.03, 206e9, 0.3)
TORQUE_NM, MESH_N_PER_M = 30.0, np.array([3e8, 5e8])
DIRECTIONS = [0.0, 90.0, -35.0, 180.0, 127.0]


def behind(direction_deg: float = 0.0, shaft: CommonShaft = SHAFT, last: float = 2e8) -> NextStage:
    rotors = Rotor(RADII[2], 0.7, 2e-4, bearing(1.0, 1.0)), Rotor(RADII[3], 5.0, 2e-2, bearing(last, 5.0))
    return NextStage(float(ANGLES[1]), *rotors, shaft, np.radians(direction_deg))


def machine(direction_deg: float = 0.0, shaft: CommonShaft = SHAFT) -> Structure:
    return stages(make_stage(), [behind(direction_deg, shaft)])


def beam_elements(shaft: CommonShaft, bearing_n_per_m: float) -> FloatArray:
    """Return the stiffness (2, 2) that gears at thirds feel: three cubic beam elements, each end on half a spring."""
    rigidity, length = shaft.youngs_modulus_pa * pi * shaft.diameter_m**4 / 64.0, shaft.span_m / 3.0
    element = np.array(
        [
            [12.0, 6.0 * length, -12.0, 6.0 * length],
            [6.0 * length, 4.0 * length**2, -6.0 * length, 2.0 * length**2],
            [-12.0, -6.0 * length, 12.0, -6.0 * length],
            [6.0 * length, 2.0 * length**2, -6.0 * length, 4.0 * length**2],
        ]
    )
    whole = np.zeros((8, 8))
    for first in (0, 2, 4):
        whole[first : first + 4, first : first + 4] += element * rigidity / length**3
    whole[[0, 6], [0, 6]] += 0.5 * bearing_n_per_m
    kept, free = [2, 4], [0, 1, 3, 5, 6, 7]
    left = whole[np.ix_(kept, free)]
    return whole[np.ix_(kept, kept)] - left @ np.linalg.solve(whole[np.ix_(free, free)], left.T)


def middle_shaft(structure: Structure, axis: str, matrix: str = "stiffness") -> FloatArray:
    rows = [structure.coordinates.index(f"{axis}_{gear}") for gear in GEARS[1:3]]
    return np.asarray(getattr(structure, matrix)[np.ix_(rows, rows)])


@pytest.mark.parametrize("bearing_n_per_m", [1e4, 2e8, 1e13])
@pytest.mark.parametrize("diameter_m", [0.01, 0.03, 0.2])
def test_a_shaft_with_two_gears_is_as_stiff_as_finite_beam_elements(bearing_n_per_m: float, diameter_m: float) -> None:
    """From a rigid shaft on soft bearings to a thin one on stiff bearings; cubic elements are exact."""
    shaft, stage = replace(SHAFT, diameter_m=diameter_m), make_stage(bearing_n_per_m)
    found = stages(stage, [behind(shaft=shaft)])
    expected = beam_elements(shaft, bearing_n_per_m)
    for axis in "xy":
        # Condensing parts of very different stiffness costs digits, the more the farther apart they are.
        assert middle_shaft(found, axis) == pytest.approx(expected, rel=1e-6, abs=1e-9 * expected.max())


def test_a_rigid_shaft_rolls_on_its_bearings_and_stiff_bearings_leave_the_beam_of_textbooks() -> None:
    rigid = middle_shaft(machine(shaft=replace(SHAFT, diameter_m=10.0)), "y")
    # Moved as one it feels both bearings; turned about its middle, gears at a sixth of the span and ends at half of it.
    assert np.ones(2) @ rigid @ np.ones(2) == pytest.approx(2e8, rel=1e-6)
    assert np.array([-1.0, 1.0]) @ rigid @ np.array([-1.0, 1.0]) == pytest.approx(9.0 * 2e8, rel=1e-6)
    held = np.linalg.inv(middle_shaft(stages(make_stage(1e16), [behind()]), "y"))
    beam = 206e9 * pi * 0.03**4 / 64.0 / 0.1**3
    # P a²(L - a)²/(3 E I L) with a = L/3, and P b x (L² - b² - x²)/(6 E I L) with b = x = L/3.
    assert held[0, 0] == pytest.approx(4.0 / 243.0 / beam, rel=1e-6)
    assert held[0, 1] == pytest.approx(7.0 / 486.0 / beam, rel=1e-6)


def test_dampers_of_bearings_waste_the_energy_of_the_motion_at_the_bearings() -> None:
    """Gears that move as one on a rigid shaft feel the whole damper; on a soft shaft bearings hardly move."""
    stage = make_stage()
    whole = stage.gear.bearing.damping_y_n_s_per_m
    stiff, soft = (middle_shaft(machine(shaft=replace(SHAFT, diameter_m=d)), "y", "damping") for d in (10.0, 0.003))
    assert np.ones(2) @ stiff @ np.ones(2) == pytest.approx(whole, rel=1e-6)
    assert 0.0 < np.ones(2) @ soft @ np.ones(2) < 1e-3 * whole


# ---- gears drawn in the plane: centres, base circles and the line on which a driving flank pushes ----


def cross(a: FloatArray, b: FloatArray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


SCANNED = np.linspace(-pi, pi, 720001)


class Drawn:
    """A mesh in the plane: `sense` 1 where the driving gear turns from x to y; `push` on the driven one."""

    def __init__(self, driving: FloatArray, direction_rad: float, radii: tuple[float, float], angle: float, sense: int):
        self.radii, self.sense, self.driving = radii, sense, driving
        self.driven = driving + sum(radii) / cos(angle) * np.array([cos(direction_rad), sin(direction_rad)])
        # Both base circles touch the line of action. Of all directions that part the gears take the one along which the
        # driven gear is turned against the driving one: found by scanning, not by a formula.
        between = self.driven - driving
        pitch_point = driving + between * radii[0] / sum(radii)
        pushes = np.stack([np.cos(SCANNED), np.sin(SCANNED)], axis=1)
        arm = pitch_point - self.driven
        turned = arm[0] * pushes[:, 1] - arm[1] * pushes[:, 0]
        best = pushes[np.argmin(np.abs(turned + sense * radii[1]) + (pushes @ between < 0.0))]
        self.push = best
        # Where the base circle of the driving gear touches it.
        self.begins = driving + radii[0] * sense * np.array([best[1], -best[0]])


def drawn(direction_deg: float) -> tuple[Drawn, Drawn]:
    first = Drawn(np.zeros(2), 0.0, RADII[:2], ANGLES[0], 1)
    return first, Drawn(first.driven, np.radians(direction_deg), RADII[2:], ANGLES[1], -1)


@pytest.mark.parametrize("direction_deg", DIRECTIONS)
def test_flanks_approach_and_slide_as_points_of_drawn_gears_do(direction_deg: float) -> None:
    """Velocities of both flanks at a point of the line of action, for any motion of all gears."""
    structure, rng = machine(direction_deg), np.random.default_rng(5)
    names = structure.coordinates
    for number, (mesh, gears) in enumerate(zip(structure.meshes, drawn(direction_deg), strict=True)):
        for s in (0.0, 0.004, 0.02):
            moving = rng.normal(size=len(names))
            place = gears.begins + s * gears.push
            flanks = []
            for gear, centre, sense in ((0, gears.driving, gears.sense), (1, gears.driven, -gears.sense)):
                at = GEARS[2 * number + gear]
                vx, vy, turning = (moving[names.index(f"{kind}_{at}")] for kind in ("x", "y", "theta"))
                arm = place - centre
                flanks.append(np.array([vx, vy]) + sense * turning * np.array([-arm[1], arm[0]]))
            apart = flanks[0] - flanks[1]
            across = gears.sense * np.array([-gears.push[1], gears.push[0]])
            # The scan of directions has steps of 9e-6 rad.
            assert mesh.vector @ moving == pytest.approx(apart @ gears.push, abs=2e-5 * np.abs(moving).max())
            sliding = (mesh.sliding[0] + s * mesh.sliding[1]) @ moving
            assert sliding == pytest.approx(apart @ across, abs=2e-5 * np.abs(moving).max())


@pytest.mark.parametrize("direction_deg", DIRECTIONS)
def test_the_lines_of_action_are_those_of_the_balance_of_torques(direction_deg: float) -> None:
    """The push has the base radius as its arm about both centres, against the turning of the driven gear's load."""
    structure = machine(direction_deg)
    for number, (mesh, gears) in enumerate(zip(structure.meshes, drawn(direction_deg), strict=True)):
        rows = [structure.coordinates.index(f"{axis}_{GEARS[2 * number]}") for axis in "xy"]
        push = mesh.vector[rows]
        assert push == pytest.approx(gears.push, abs=1e-5)
        assert np.linalg.norm(push) == pytest.approx(1.0, abs=1e-15)
        to_pitch = (gears.driven - gears.driving) * gears.radii[0] / sum(gears.radii)
        assert cross(to_pitch, -push) == pytest.approx(-gears.sense * gears.radii[0], rel=1e-12)


def at_rest(structure: Structure) -> tuple[FloatArray, FloatArray]:
    """Return the deflection (n,) under a torque with springs as meshes, and their forces (meshes,)."""
    loaded = structure.stiffness + mesh_springs(structure, MESH_N_PER_M)
    moved = static_solution(structure, loaded, TORQUE_NM * structure.torque_vector)
    return moved, np.array([k * mesh.vector @ moved for k, mesh in zip(MESH_N_PER_M, structure.meshes, strict=True)])


@pytest.mark.parametrize("direction_deg", DIRECTIONS)
def test_bearings_of_every_shaft_carry_the_forces_of_its_teeth_at_rest(direction_deg: float) -> None:
    structure = machine(direction_deg)
    moved, forces = at_rest(structure)
    assert forces == pytest.approx(
        [TORQUE_NM / RADII[0], TORQUE_NM * RADII[1] / (RADII[0] * RADII[2])],
        rel=1e-9,
    )
    driving = ([structure.coordinates.index(f"{axis}_{gear}") for axis in "xy"] for gear in GEARS[::2])
    parts = zip(forces, structure.meshes, driving, strict=True)
    first, second = (force * mesh.vector[rows] for force, mesh, rows in parts)
    expected = {"pinion": -first, "gear": first - second, "slow": second}
    for shaft, force in expected.items():
        found = [structure.bearing_forces[f"{shaft}_bearing/{axis}"][0] @ moved for axis in ("horizontal", "vertical")]
        assert found == pytest.approx(force, rel=1e-9, abs=1e-9 * np.abs(forces).max())


@pytest.mark.parametrize("direction_deg", DIRECTIONS)
def test_no_force_turns_or_moves_a_whole_machine_that_only_turns(direction_deg: float) -> None:
    structure = machine(direction_deg)
    turning = rigid_rotation(structure)
    ratio = RADII[0] * RADII[2] / (RADII[1] * RADII[3])
    assert turning[structure.coordinates.index("theta_load")] == pytest.approx(ratio, rel=1e-14)
    assert structure.torque_vector @ turning == pytest.approx(0.0, abs=1e-14)
    for mesh in structure.meshes:
        assert mesh.vector @ turning == pytest.approx(0.0, abs=1e-15)
    values = np.linalg.eigvalsh(structure.stiffness + mesh_springs(structure, MESH_N_PER_M))
    # One motion is free, and one only: the next spring is that of a coupling.
    assert abs(values[0]) < 1e-9 * values[-1]
    assert values[1] > 10.0


STIFF = 3e14


def test_a_stiff_second_mesh_adds_its_inertia_behind_the_first_stage() -> None:
    """Gear 2 drives J_3 + (J_4 + J_L)(z_3/z_4)² through the shaft: natural frequencies of a single stage with that.

    The other springs of the second stage are stiff as well; what they give way is some 1e-7 of the frequencies.
    """
    stage, torsion = make_stage(), 2.0e4
    span = 1e-6  # so short that it bends no more, and as thin as its torsion asks for
    polar = torsion * (span / 3.0) / (0.5 * 206e9 / 1.3)
    shaft = CommonShaft(span, (32.0 * polar / pi) ** 0.25, 206e9, 0.3)
    held = Bearing(STIFF, STIFF, 0.0, 0.0)
    first = replace(stage, gear=replace(stage.gear, bearing=held), output_coupling=Coupling(1e12, 0.0))
    next_stage = behind(70.0, shaft)
    both = stages(first, [replace(next_stage, gear=replace(next_stage.gear, bearing=held))])
    added = 2e-4 + (2e-2 + stage.load_inertia_kg_m2) * (RADII[2] / RADII[3]) ** 2
    alone = eight_dof(replace(first, load_inertia_kg_m2=added, output_coupling=Coupling(torsion, 0.0)))
    found = natural_modes(both, [MESH_N_PER_M[0], STIFF]).frequency_hz
    expected = natural_modes(alone, MESH_N_PER_M[0]).frequency_hz
    slow = expected[(expected > 1.0) & (expected < 5e4)]
    assert len(slow) >= 4
    assert found[(found > 1.0) & (found < 5e4)] == pytest.approx(slow, rel=1e-6)
    softer = natural_modes(both, [MESH_N_PER_M[0], 1e8]).frequency_hz
    assert np.abs(softer[1:4] / slow[:3] - 1.0).max() > 1e-3  # it would be seen


def test_a_third_stage_continues_the_ratio_and_the_sense_of_the_second() -> None:
    structure = stages(make_stage(), [behind(-35.0), behind(40.0)])
    assert structure.drivetrain.lines == (
        ("motor", "pinion"),
        ("gear", "mesh_0_pinion"),
        ("mesh_0_gear", "mesh_1_pinion"),
        ("mesh_1_gear", "load"),
    )
    turning = rigid_rotation(structure)
    assert turning[-1] == pytest.approx(RADII[0] / RADII[1] * (RADII[2] / RADII[3]) ** 2, rel=1e-14)
    # Its pinion turns as the first one does, so at direction 0 it pushes as that one.
    like_first = stages(make_stage(), [behind(), behind()]).meshes[2]
    push = [like_first.vector[like_first_row] for like_first_row in (13, 14)]
    assert push == pytest.approx([sin(ANGLES[1]), cos(ANGLES[1])])


def test_each_mesh_speeds_up_two_free_gears_like_its_reduced_mass() -> None:
    structure = machine(-35.0)
    for mesh in structure.meshes:
        rows = [structure.coordinates.index(name) for name in mesh.turning]
        # A force F along the line of action gives the angles J^-1 p F, which part the flanks by p^T J^-1 p F = F / m.
        turned = np.linalg.solve(structure.mass[np.ix_(rows, rows)], mesh.vector[rows])
        assert 1.0 / (mesh.vector[rows] @ turned) == pytest.approx(mesh.mass_kg, rel=1e-12)
