"""A planetary set at rest and in free vibration: rigid rotation, torques, groups of modes, the frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from siggen.dynamics.structure.fixed_frame import in_space
from siggen.dynamics.structure.free_rotation import free_rotations, static_solution
from siggen.dynamics.structure.planetary import planetary_structure
from siggen.dynamics.structure.shaft_lines import rigid_rotation, rolling
from siggen.dynamics.time.equations import equations_about, mesh_springs
from tests.dynamics.planetary_set import planetary_stage

K = 3e8


def loaded(structure):
    return structure.stiffness + mesh_springs(structure, np.full(len(structure.meshes), K))


@pytest.mark.parametrize("planets", [3, 4, 5])
def test_rigid_rotation_deforms_nothing_and_is_the_only_free_motion(planets):
    structure = planetary_structure(planetary_stage(planets))
    turning = rigid_rotation(structure)
    names = dict(zip(structure.coordinates, turning, strict=True))
    assert names["theta_c"] == pytest.approx(1 / 4.25, rel=1e-12)
    assert names["theta_p1"] == pytest.approx((1 - 78 / 27) / 4.25, rel=1e-12)
    for mesh in structure.meshes:
        assert abs(mesh.vector @ turning) < 1e-15
    assert free_rotations(structure, loaded(structure)).shape[1] == 1
    values = np.linalg.eigvalsh(loaded(structure) / np.abs(loaded(structure)).max())
    assert (values > -1e-12).all()
    assert structure.torque_vector @ turning == pytest.approx(0.0, abs=1e-12)


def test_gears_turn_against_the_carrier_in_the_ratio_of_their_teeth():
    structure = planetary_structure(planetary_stage())
    names = dict(zip(structure.coordinates, rolling(structure), strict=True))
    assert names["theta_s"] == 1.0
    assert names["theta_p2"] == pytest.approx(-24 / 27, rel=1e-12)
    assert names["theta_r"] == pytest.approx(-24 / 78, rel=1e-12)
    assert names["theta_c"] == pytest.approx(0.0, abs=1e-15)


def test_a_motion_of_the_whole_set_brings_no_flanks_together():
    """Shift and turn of all bodies with the ring: in space every mesh keeps its approach."""
    structure = planetary_structure(planetary_stage())
    for moved in ("x", "y", "theta"):
        q = np.array([float(n in {f"{moved}_s", f"{moved}_c", f"{moved}_r"}) for n in structure.coordinates])
        if moved == "theta":
            q = q + [float(n.startswith("theta_p")) for n in structure.coordinates]
        for mesh in structure.meshes:
            assert abs(mesh.vector @ q) < 1e-15


def test_the_torque_splits_evenly_and_the_ring_holds_what_motor_and_load_leave():
    stage = planetary_stage()
    structure = planetary_structure(stage)
    found = equations_about(structure, 100.0, np.full(6, K), np.zeros((6, 2)))
    each = 100.0 / 3 / stage.sun.base_radius_m
    assert found.static_force == pytest.approx(np.full(6, each), rel=1e-9)
    held = stage.ring.turning_stiffness_nm_per_rad * found.static_deflection[structure.coordinates.index("theta_r")]
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
    central = [i for i, n in enumerate(structure.coordinates) if n[-2:] in {"_s", "_c", "_r", "_m", "_l"}]
    resting = np.abs(vectors[central]).max(axis=0) < 1e-6 * np.abs(vectors).max(axis=0)
    assert resting.sum() == 3 * (planets - 3)
    across = [i for i, n in enumerate(structure.coordinates) if n in {"x_s", "y_s", "x_c", "y_c", "x_r", "y_r"}]
    shifting = np.abs(vectors[across]).max(axis=0) > 1e-6 * np.abs(vectors).max(axis=0)
    found = np.sort(values[shifting])
    assert found.size == 12
    assert found[::2] == pytest.approx(found[1::2], rel=1e-6)


def test_a_circling_point_stands_still_in_space():
    structure = planetary_structure(planetary_stage())
    names, n = structure.coordinates, len(structure.coordinates)
    angle, static = np.linspace(0.0, 20.0, 7), np.zeros(len(structure.coordinates))
    x, y = names.index("x_r"), names.index("y_r")
    static[[x, y]] = 3e-6, -1e-6
    states = np.zeros((angle.size, 2 * n))
    states[:, x], states[:, y] = np.cos(angle) - static[x], -np.sin(angle) - static[y]  # (1, 0) seen from the frame
    seen = in_space(names, states, static, angle)
    assert seen[:, x] == pytest.approx(np.ones(7), abs=1e-15)
    assert seen[:, y] == pytest.approx(np.zeros(7), abs=1e-15)
    others = [i for i in range(2 * n) if names[i % n][-2:] not in {"_s", "_c", "_r"}]
    assert np.array_equal(seen[:, others], states[:, others])
