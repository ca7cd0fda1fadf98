from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.equations import approach_of
from siggen.motion.linear_motion import RungeKutta
from siggen.motion.product_integration import HERMITE_DIP, SHIFTED_LEGENDRE, ProductIntegration, scheme
from tests.dynamics.conftest import arched_row, make_tables
from tests.dynamics.integration_runs import FIRST_PITCHES, MESH_HZ, model, reference, relative_error, trajectory

PINION_RATE = 8 + 2  # velocity of y_pinion in the state of the 8-DOF model
STEP = 1.0 / (51200 * 4)
STEPS = 2048  # 10 ms: five engagements with ten stiffness jumps


@pytest.mark.parametrize("kind", ["jumps", "ramps"])
def test_agrees_with_an_adaptive_solver_that_stops_at_every_event(kind: str, structure: Structure) -> None:
    row = arched_row(42)
    if kind == "ramps":
        row[[0, -1]] = 1.0
    equations, law, start = model(structure, make_tables(row[None, :]))
    states = trajectory(ProductIntegration, equations, law, start, STEP, STEPS)
    expected = reference(equations, law, start, STEP * np.arange(STEPS + 1))
    # Jumps: the Hermite cubic misses the jump of the acceleration. Ramps: the kinks at the table's few points fall
    # between the quadrature nodes. Measured 3e-5 of the pinion's velocity for both at four steps per sample.
    assert relative_error(states, expected, PINION_RATE) < 6e-5


def test_jumps_of_the_stiffness_cost_no_order(structure: Structure) -> None:
    equations, law, start = model(structure, make_tables(arched_row(3)[None, :]))
    errors = []
    finest = trajectory(ProductIntegration, equations, law, start, STEP / 32, STEPS * 32)
    for division in (1, 2, 4):
        states = trajectory(ProductIntegration, equations, law, start, STEP / division, STEPS * division)
        errors.append(relative_error(states[::division], finest[::32], PINION_RATE))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    # A cubic Hermite misses the jump of the acceleration by h²: local force error h³ at a fixed number of events.
    # Between neighbouring steps the position of the jumps inside the step scatters the order by about a half.
    assert (orders > 2.4).all(), (errors, orders)


def test_without_jumps_the_approach_is_exact_where_the_stiffness_is_the_mean(
    structure: Structure, constant_tables: MeshTables
) -> None:
    equations, law, start = model(structure, constant_tables)
    start = start.copy()
    start[PINION_RATE] = 1e-3
    coarse = trajectory(ProductIntegration, equations, law, start, 1e-4, 20)
    fine = trajectory(RungeKutta, equations, law, start, 2.5e-7, 8000)[::400]
    # The stiffness is the mean one, so the step is the matrix exponential. Runge-Kutta at 0.012 rad of the mesh mode
    # per step: (ωh)^5/120 = 2e-12, 8000 steps.
    np.testing.assert_allclose(coarse[:, PINION_RATE], fine[:, PINION_RATE], rtol=0.0, atol=2e-8 * 1e-3)


def test_a_force_from_outside_goes_on_while_the_flanks_are_apart(structure: Structure) -> None:
    equations, law, start = model(structure, make_tables(arched_row(65)[None, :]), torque=0.5, backlash=4e-6)
    row = np.zeros((1, 8))
    row[0, 3] = 1.0
    equations, start = equations._replace(external_input=row), start.copy()
    start[8 + 3] = -3.0
    times = STEP * np.arange(STEPS + 1)
    found = []
    for integrator, division in ((ProductIntegration, 1), (RungeKutta, 64)):
        at = STEP / division * np.arange(STEPS * division + 1)
        # 3e4 rad/s² for the 0.1 ms of a flight are the 3 rad/s of the strike; linear within steps, as both take it
        push = np.interp(at, times, 3e4 * np.cos(2.0 * np.pi * 900.0 * times))[:, None]
        states = np.empty((at.size, start.size))
        states[0] = start
        integrator(equations, law, STEP / division).advance(FIRST_PITCHES + MESH_HZ * at, push, states)
        found.append(states[::division])
    states, fine = found
    apart = np.array([abs(approach_of(equations, 0, state)[0]) < 2e-6 for state in fine])
    assert apart.mean() > 0.05
    assert relative_error(states, fine, 8 + 3) < 2e-2  # the flank's edge at first order, as above


def test_response_weights_are_the_integrals_they_stand_for(structure: Structure, sharp_tables: MeshTables) -> None:
    from scipy.linalg import expm

    from siggen.motion.equations import state_matrix

    equations, law, _ = model(structure, sharp_tables)
    constants = scheme(equations, law, STEP)
    matrix = state_matrix(equations, equations.reference_stiffness, np.array([law.damping_n_s_per_m]))
    inputs = np.concatenate([np.zeros(8), equations.mesh_input[0]])
    nodes, weights = np.polynomial.legendre.leggauss(12)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    powers = nodes ** np.arange(4)[:, None]
    polynomials = SHIFTED_LEGENDRE @ powers
    kernel = np.array([expm(matrix * STEP * (1.0 - t)) @ inputs for t in nodes])
    expected = STEP * (2 * np.arange(4) + 1)[:, None] * ((polynomials * weights) @ kernel)
    # Twelve nodes are exact for the smooth kernel; both sides lose digits to the size of M⁻¹K.
    scale = np.abs(expected).max(axis=0)
    assert (np.abs(constants.response[:, :16] - expected) <= 1e-10 * scale).all()


def test_no_cubic_dips_deeper_below_its_ends_than_the_bound_on_its_slopes() -> None:
    """Hermite's functions of the end slopes are x (1 - x)² and -x² (1 - x); a third of the way is where they end."""
    x = np.linspace(0.0, 1.0, 3001)
    assert np.max(x * (1.0 - x) ** 2) == pytest.approx(HERMITE_DIP, rel=1e-6)
