"""A planetary set at rest and in free vibration: rigid rotation, torques, groups of modes, the frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from siggen.drivetrain.gear_stage import Coupling, PlanetaryBody, PlanetaryStage
from siggen.drivetrain.structure import free_rotations, in_space, rigid_rotation, rolling, static_solution
from siggen.motion.equations import equations_about, mesh_springs
from tests.dynamics.planetary_set import pairs, planetary_stage
from tests.dynamics.trains import planetary_structure

K = 3e8


def loaded(structure):
    return structure.stiffness + mesh_springs(structure, np.full(len(structure.meshes), K))


@pytest.mark.parametrize("planets", [3, 4, 5])
def test_rigid_rotation_deforms_nothing_and_is_the_only_free_motion(planets):
    structure = planetary_structure(planetary_stage(planets))
    turning = rigid_rotation(structure)
    names = dict(zip(structure.coordinates, turning, strict=True))
    assert names["theta_carrier"] == pytest.approx(1 / 4.25, rel=1e-12)
    assert names["theta_planet_1"] == pytest.approx((1 - 78 / 27) / 4.25, rel=1e-12)
    for mesh in structure.meshes:
        assert abs(mesh.vector @ turning) < 1e-15
    assert free_rotations(structure, loaded(structure)).shape[1] == 1
    values = np.linalg.eigvalsh(loaded(structure) / np.abs(loaded(structure)).max())
    assert (values > -1e-12).all()
    assert structure.torque_vector @ turning == pytest.approx(0.0, abs=1e-12)


def test_gears_turn_against_the_carrier_in_the_ratio_of_their_teeth():
    structure = planetary_structure(planetary_stage())
    names = dict(zip(structure.coordinates, rolling(structure), strict=True))
    assert names["theta_sun"] == 1.0
    assert names["theta_planet_2"] == pytest.approx(-24 / 27, rel=1e-12)
    assert names["theta_ring"] == pytest.approx(-24 / 78, rel=1e-12)
    assert names["theta_carrier"] == pytest.approx(0.0, abs=1e-15)


def test_a_motion_of_the_whole_set_brings_no_flanks_together():
    """Shift and turn of all bodies with the ring: in space every mesh keeps its approach."""
    structure = planetary_structure(planetary_stage())
    for moved in ("x", "y", "theta"):
        q = np.array([float(n in {f"{moved}_sun", f"{moved}_carrier", f"{moved}_ring"}) for n in structure.coordinates])
        if moved == "theta":
            q = q + [float(n.startswith("theta_planet")) for n in structure.coordinates]
        for mesh in structure.meshes:
            assert abs(mesh.vector @ q) < 1e-15


def test_the_torque_splits_evenly_and_the_ring_holds_what_motor_and_load_leave():
    stage = planetary_stage()
    structure = planetary_structure(stage)
    found = equations_about(structure, 100.0, np.full(6, K), np.zeros((6, 2)))
    each = 100.0 / 3 / stage.sun.base_radius_m
    assert found.static_force == pytest.approx(np.full(6, each), rel=1e-9)
    held = stage.ring.turning_stiffness_nm_per_rad * found.static_deflection[structure.coordinates.index("theta_ring")]
    assert -held == pytest.approx(100.0 * (stage.ratio - 1.0), rel=1e-9)


def test_energy_put_in_statically_is_the_energy_of_the_springs():
    structure, rng = planetary_structure(planetary_stage()), np.random.default_rng(2)
    force, free = rng.normal(size=len(structure.coordinates)), rigid_rotation(structure)
    force -= structure.mass @ free * (free @ force) / (free @ structure.mass @ free)
    moved = static_solution(structure, loaded(structure), force)
    parts = sum(K * (mesh.vector @ moved) ** 2 for mesh in structure.meshes)
    assert force @ moved == pytest.approx(moved @ structure.stiffness @ moved + parts, rel=1e-9)


@pytest.mark.parametrize("planets", [4, 5])
def test_modes_fall_into_rotation_translation_in_pairs_and_planets_alone(planets):
    """Lin & Parker's groups: N - 3 times three modes of planets alone; two by two the translational ones."""
    stage = planetary_stage(planets)
    structure = planetary_structure(replace(stage, places_turns=tuple(i / planets for i in range(planets))))
    assert len(structure.coordinates) == 11 + 3 * planets
    values, vectors = eigh(loaded(structure), structure.mass)
    central = [i for i, n in enumerate(structure.coordinates) if "planet" not in n]
    resting = np.abs(vectors[central]).max(axis=0) < 1e-6 * np.abs(vectors).max(axis=0)
    assert resting.sum() == 3 * (planets - 3)
    across = [
        i
        for i, n in enumerate(structure.coordinates)
        if n in {"x_sun", "y_sun", "x_carrier", "y_carrier", "x_ring", "y_ring"}
    ]
    shifting = np.abs(vectors[across]).max(axis=0) > 1e-6 * np.abs(vectors).max(axis=0)
    found = np.sort(values[shifting])
    assert found.size == 12
    assert found[::2] == pytest.approx(found[1::2], rel=1e-6)


@pytest.mark.parametrize("mesh", range(6))
def test_flanks_slide_as_the_points_of_both_bodies_move_that_touch(mesh):
    """Places of tangent points and contact from radii and the angles of the lines; any motion of all bodies."""
    stage, rng = planetary_stage(), np.random.default_rng(mesh)
    structure = planetary_structure(stage)
    speed = dict(zip(structure.coordinates, rng.normal(size=len(structure.coordinates)), strict=True))
    place, with_ring = 2.0 * np.pi * stage.places_turns[mesh % 3], mesh >= 3
    number, slant = mesh % 3 + 1, stage.ring_angle_rad if with_ring else stage.sun_angle_rad
    out, ahead = np.array([np.cos(place), np.sin(place)]), np.array([-np.sin(place), np.cos(place)])
    carrier = (
        np.array([speed["x_carrier"], speed["y_carrier"]]) + stage.centre_distance_m * speed["theta_carrier"] * ahead
    )
    planet = carrier + speed[f"x_planet_{number}"] * out + speed[f"y_planet_{number}"] * ahead
    axis = stage.centre_distance_m * out
    sign = -1.0 if with_ring else 1.0
    push = np.sin(slant) * out + sign * np.cos(slant) * ahead
    tangent = stage.planet.base_radius_m * np.array([push[1], -push[0]])  # a quarter turn before the push
    position, contact = 0.007, None
    bodies = {"planet": (axis, planet, speed[f"theta_planet_{number}"])}
    bodies["s"] = (np.zeros(2), np.array([speed["x_sun"], speed["y_sun"]]), speed["theta_sun"])
    bodies["r"] = (np.zeros(2), np.array([speed["x_ring"], speed["y_ring"]]), speed["theta_ring"])
    if with_ring:
        contact, driving, driven = axis - tangent + position * push, "planet", "r"
    else:
        foot = stage.sun.base_radius_m * np.array([push[1], -push[0]])
        contact, driving, driven = foot + position * push, "s", "planet"

    def moving(name):
        centre, shift, turning = bodies[name]
        arm = contact - centre
        return shift + turning * np.array([-arm[1], arm[0]])

    along = sign * np.array([-push[1], push[0]])
    expected = (moving(driving) - moving(driven)) @ along
    r_0, r_1 = structure.meshes[mesh].sliding
    found = (r_0 + position * r_1) @ np.array([speed[name] for name in structure.coordinates])
    assert found == pytest.approx(expected, abs=1e-12)


def test_rolling_flanks_slide_past_each_other_at_the_pitch_points_alone():
    stage = planetary_stage()
    structure = planetary_structure(stage)
    turning = rolling(structure)
    sun_pair, ring_pair = pairs()
    for number, mesh in enumerate(structure.meshes):
        first, second = mesh.sliding @ turning
        pair = sun_pair if number < 3 else ring_pair
        assert first + second * pair.pitch_point_m == pytest.approx(0.0, abs=1e-15)
        # planets turn by -24/27 against the carrier where the sun turns once, the ring by -24/78
        assert second == pytest.approx(1.0 + 24 / 27 if number < 3 else 24 / 27 - 24 / 78, rel=1e-12)


def test_a_circling_point_stands_still_in_space():
    structure = planetary_structure(planetary_stage())
    names, n = structure.coordinates, len(structure.coordinates)
    angle, static = np.linspace(0.0, 20.0, 7), np.zeros(len(structure.coordinates))
    x, y = names.index("x_ring"), names.index("y_ring")
    static[[x, y]] = 3e-6, -1e-6
    states = np.zeros((angle.size, 2 * n))
    states[:, x], states[:, y] = np.cos(angle) - static[x], -np.sin(angle) - static[y]  # (1, 0) seen from the frame
    seen = in_space(structure.drivetrain, states, static, angle)
    assert seen[:, x] == pytest.approx(np.ones(7), abs=1e-15)
    assert seen[:, y] == pytest.approx(np.zeros(7), abs=1e-15)
    others = [i for i in range(2 * n) if names[i % n].rpartition("_")[2] not in {"sun", "carrier", "ring"}]
    assert np.array_equal(seen[:, others], states[:, others])


def test_each_mesh_speeds_up_its_two_bodies_like_its_reduced_mass():
    structure = planetary_structure(planetary_stage(3))
    for mesh in structure.meshes:
        rows = [structure.coordinates.index(name) for name in mesh.turning]
        # A force F along the line of action gives the angles J^-1 p F, which part the flanks by p^T J^-1 p F = F / m.
        turned = np.linalg.solve(structure.mass[np.ix_(rows, rows)], mesh.vector[rows])
        assert 1.0 / (mesh.vector[rows] @ turned) == pytest.approx(mesh.mass_kg, rel=1e-12)


PUBLISHED_HZ = {
    3: "743.2 743.2 1102.4 1102.4 1475.7 1896.0 1896.0 1930.3 2276.4 2276.4 2658.3 6986.3 6986.3 7462.8 9647.9 9647.9 "
    "11775.3",
    4: "727.0 727.0 1091.0 1091.0 1536.6 1808.2 1892.8 1892.8 1970.6 2342.5 2342.5 2625.7 5963.8 6981.7 7189.9 7189.9 "
    "7773.6 10437.6 10437.6 13071.1",
}
"""Lin & Parker 1999 (Journal of Vibration and Acoustics 121), the example of a helicopter's planetary gear."""


@pytest.mark.parametrize("planets", PUBLISHED_HZ)
def test_natural_frequencies_are_those_that_lin_and_parker_published(planets):
    """Within 0.04 %, for three planets within all digits; radii count by their ratios alone."""
    base_mm, angle = (77.42, 100.35), np.radians(24.6)
    ring_mm, apart_m = base_mm[0] + 2.0 * base_mm[1], 0.5e-3 * sum(base_mm) / np.cos(angle)

    def body(radius_m, mass_kg, inertia, held=0.0):
        return PlanetaryBody(radius_m, mass_kg, inertia * radius_m**2, 1e8, 0.0, held * radius_m**2)

    free = Coupling(1e-6, 0.0)
    stage = PlanetaryStage(
        angle, angle, apart_m, body(0.5e-3 * base_mm[0], 0.4, 0.39), body(0.5e-3 * base_mm[1], 0.66, 0.61),
        body(0.5e-3 * ring_mm, 2.35, 3.0, 1e9), body(apart_m, 5.43, 6.29), tuple(i / planets for i in range(planets)),
        1e-9, 1e-9, free, free,
    )  # fmt: skip
    structure = planetary_structure(stage)
    rows = [mesh.vector for mesh in structure.meshes]
    stiffness = structure.stiffness + 5e8 * np.sum([np.outer(row, row) for row in rows], axis=0)
    kept = [i for i, name in enumerate(structure.coordinates) if name not in {"theta_motor", "theta_load"}]
    values = eigh(stiffness[np.ix_(kept, kept)], structure.mass[np.ix_(kept, kept)], eigvals_only=True)
    found = np.sqrt(np.abs(values)) / (2.0 * np.pi)
    expected = np.array(PUBLISHED_HZ[planets].split(), dtype=float)
    assert found[0] < 0.1
    np.testing.assert_allclose(found[1:], expected, rtol=4e-4)
