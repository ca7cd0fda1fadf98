from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.structure import Structure, elastic_basis, free_rotations, locked_load, static_solution
from siggen.motion.equations import equations_about
from siggen.motion.modes import slowest_decay_per_s
from tests.dynamics.casing_stage import (
    BASE_RADIUS_1,
    MEAN_STIFFNESS,
    make_casing,
    make_stage,
    make_structure,
    torsional,
)
from tests.dynamics.natural_frequencies import natural_frequencies_hz
from tests.dynamics.trains import casing_structure, eight_dof

STRUCTURES = {
    "8dof": eight_dof(make_stage()),
    "torsional": torsional(make_stage()),
    "casing": make_structure(),
}


def loaded(structure: Structure, mesh: float = MEAN_STIFFNESS) -> np.ndarray:
    return structure.stiffness + mesh * np.outer(structure.mesh.vector, structure.mesh.vector)


@pytest.mark.parametrize("name", STRUCTURES)
def test_one_rotation_is_free_two_without_a_mesh_none_with_a_held_load(name: str) -> None:
    structure = STRUCTURES[name]
    free = free_rotations(structure, loaded(structure))
    assert free.shape[1] == 1
    turned = dict(
        zip(structure.coordinates, free[:, 0] / free[structure.coordinates.index("theta_pinion"), 0], strict=True)
    )
    assert turned["theta_gear"] == pytest.approx(18.0 / 47.0, rel=1e-14)
    assert {turned[name] for name in structure.coordinates if name[0] in "xyp"} <= {0.0}
    assert free_rotations(structure, structure.stiffness).shape[1] == 2
    locked = locked_load(structure)
    assert free_rotations(locked, loaded(locked)).shape[1] == 0


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_static_solution_solves_without_free_rotation(name: str) -> None:
    structure = STRUCTURES[name]
    force = 30.0 * structure.torque_vector
    q = static_solution(structure, loaded(structure), force)
    np.testing.assert_allclose(loaded(structure) @ q, force, atol=1e-9 * np.abs(force).max())
    free = free_rotations(structure, loaded(structure))[:, 0]
    assert abs(free @ structure.mass @ q) < 1e-13 * (np.abs(free) @ structure.mass @ np.abs(q))


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_elastic_basis_completes_the_free_rotation(name: str) -> None:
    structure = STRUCTURES[name]
    basis = elastic_basis(structure, loaded(structure))
    np.testing.assert_allclose(basis.T @ structure.mass @ basis, np.eye(basis.shape[1]), atol=1e-12)
    free = free_rotations(structure, loaded(structure))
    assert np.abs(free.T @ structure.mass @ basis).max() < 1e-14


# From 1e12 N/m on, a cut of eigenvalues relative to the largest would take the soft shafts for free rotations.
@pytest.mark.parametrize("stiffness", [1e12, 1e14, 1e16])
@pytest.mark.parametrize("name", ["8dof", "casing"])
def test_rigid_supports_leave_the_torsional_model(stiffness: float, name: str) -> None:
    stage = make_stage(bearing_stiffness=stiffness)
    heavy = make_casing(mass_kg=2e7, inertia_kg_m2=2.5e5)
    structure = eight_dof(stage) if name == "8dof" else casing_structure(stage, heavy)
    alone = torsional(stage)
    expected = natural_frequencies_hz(alone, MEAN_STIFFNESS)
    found = natural_frequencies_hz(structure, MEAN_STIFFNESS)
    assert (found == 0.0).sum() == 1
    for frequency in expected[1:]:
        # The mesh pushes with k on bearings of this stiffness in series, half of 2 k/k_b in frequency; and stiff modes
        # round the squared frequencies of the others by 1e-16 k_b/m, m from 1 kg on.
        rounding = 1e-15 * stiffness / (2.0 * np.pi * frequency) ** 2
        assert np.abs(found / frequency - 1.0).min() < 4.0 * MEAN_STIFFNESS / stiffness + rounding
    assert expected[-1] == pytest.approx(6120.0, rel=0.015)  # √(k/m_e)/2π, 1.1 % stiffer by the shafts
    force = 30.0 * structure.torque_vector
    q = static_solution(structure, loaded(structure), force)
    assert MEAN_STIFFNESS * (structure.mesh.vector @ q) == pytest.approx(30.0 / BASE_RADIUS_1, rel=1e-11)
    equations = equations_about(structure, 30.0, np.array([MEAN_STIFFNESS]), np.zeros((1, 2)))
    decay = slowest_decay_per_s(structure, equations, np.array([1000.0]))
    about = equations_about(alone, 30.0, np.array([MEAN_STIFFNESS]), np.zeros((1, 2)))
    torsion = slowest_decay_per_s(alone, about, np.array([1000.0]))
    if name == "8dof":  # the heavy casing has slow modes of its own
        assert decay == pytest.approx(torsion, rel=2e-3)


def test_a_force_on_the_free_rotation_has_no_equilibrium() -> None:
    structure = STRUCTURES["8dof"]
    force = np.zeros(8)
    force[structure.coordinates.index("theta_motor")] = 1.0
    with pytest.raises(ValueError, match="unbalanced force"):
        static_solution(structure, loaded(structure), force)
    # With a held load the lock carries it.
    locked = locked_load(structure)
    assert np.isfinite(static_solution(locked, loaded(locked), force)).all()
