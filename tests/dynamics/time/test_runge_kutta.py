from __future__ import annotations

import numpy as np

from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.linear_motion import RungeKutta
from tests.dynamics.conftest import make_tables
from tests.dynamics.integration_runs import model, reference, relative_error, trajectory

PINION_RATE = 8 + 2


def kinked_tables() -> MeshTables:
    """Return pairs whose stiffness rises and falls linearly, from practically nothing: kinks, no jump."""
    return make_tables(np.array([[1.0, 4e8, 1.0]]))


def test_fourth_order_where_the_stiffness_is_smooth(structure: Structure, constant_tables: MeshTables) -> None:
    equations, law, start = model(structure, constant_tables)
    start = start.copy()
    start[PINION_RATE] = 1e-3
    steps, step = 200, 1e-5
    finest = trajectory(RungeKutta, equations, law, start, step / 16, steps * 16)[::16]
    errors = [
        relative_error(trajectory(RungeKutta, equations, law, start, step / d, steps * d)[::d], finest, PINION_RATE)
        for d in (1, 2)
    ]
    # Order 4 within the terms of order 5 that are left at 0.5 rad per step of the mesh mode.
    assert 3.8 < np.log2(errors[0] / errors[1]) < 4.3


def test_agrees_with_an_adaptive_solver_across_kinks(structure: Structure) -> None:
    equations, law, start = model(structure, kinked_tables())
    times = np.arange(2049) / (51200 * 8)
    expected = reference(equations, law, start, times)
    errors = [
        relative_error(
            trajectory(RungeKutta, equations, law, start, times[1] / d, 2048 * d)[::d], expected, PINION_RATE
        )
        for d in (1, 4)
    ]
    # A kink of the stiffness inside a step leaves second order: a quarter of the step has a sixteenth of the error,
    # give or take where the kinks fall inside the steps. Measured 1e-4 and 1e-5.
    assert errors[0] < 3e-4
    assert 8.0 < errors[0] / errors[1] < 32.0


def test_energy_is_conserved_without_damping_at_constant_stiffness(
    undamped: Structure, constant_tables: MeshTables
) -> None:
    equations, law, start = model(undamped, constant_tables, damping=0.0)
    start = start.copy()
    start[8:] = np.linspace(-1e-3, 1e-3, 8)
    states = trajectory(RungeKutta, equations, law, start, 5e-7, 40000)
    stiffness = undamped.stiffness + 3.2e8 * np.outer(undamped.mesh.vector, undamped.mesh.vector)
    w, v = states[:, :8], states[:, 8:]
    energy = 0.5 * np.einsum("ti,ij,tj->t", w, stiffness, w) + 0.5 * np.einsum("ti,ij,tj->t", v, undamped.mass, v)
    # Classical Runge-Kutta loses the share (ωh)^6/72 of a mode's energy per step: 3e-12 at the 0.025 rad of the mesh
    # mode.
    assert (np.diff(energy[::4000]) < 0.0).all()
    np.testing.assert_allclose(energy, energy[0], rtol=40000 * 3.1e-12)
