"""Tooth pairs that share gear bodies, against all springs at once as one problem of non-negative least squares."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

from siggen.gears.missing_material import missing_material
from siggen.mesh.node_forces import pair_forces
from siggen.mesh.pair_columns import NORMAL
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.pair_springs import pair_table
from tests.dynamics.casing_stage import make_structure
from tests.dynamics.pair_runs import (
    RELIEF,
    columns,
    constant_tables,
    exact_involutes,
    gear_pair,
    motion,
    settled,
    tables,
)

STIFFNESS = 1.57e8
TABLES = constant_tables(STIFFNESS, 2.05)
TABLES_RATIO = 2.05
POINTS = 65
ANGLES = st.floats(4.0, 6.0)


def law(coupling: np.ndarray | None, backlash_m: float = 80e-6) -> PairLaw:
    return pair_law(
        TABLES,
        exact_involutes(TABLES),
        MeshConstants(gear_pair().line_of_action_m, 0.2124, backlash_m),
        damping_ratio=0.07,
        coupling_m_per_n=coupling,
    )


def table(first: float, second: float) -> np.ndarray:
    """Coupling one and two pitches apart in compliances of a pair, growing along the path."""
    return np.array([[first], [second]]) / STIFFNESS * np.linspace(0.5, 1.0, POINTS)


def loaded(chosen: PairLaw, approach: float, pitches: float) -> np.ndarray:
    pairs = pair_table(chosen)
    pair_forces(chosen, approach, 0.0, pitches, 0.0, 0.0, pairs)
    return pairs


def by_least_squares(coupling: np.ndarray, approach: float, pitches: float) -> dict[int, float]:
    """Return the force of every pair: all springs with their own and coupled compliances, each at least 0."""
    engaged = [n for n in range(int(pitches) - 3, int(pitches) + 2) if 0.0 <= pitches - n < TABLES_RATIO]
    compliance = np.eye(len(engaged)) / STIFFNESS
    for i, one in enumerate(engaged):
        for j, two in enumerate(engaged):
            if i != j:
                later = pitches - max(one, two)
                compliance[i, j] = np.interp(later, np.linspace(0, 2.05, POINTS), coupling[abs(one - two) - 1])
    # In µm and kN, so that least squares are well scaled: minimise ½ F·A F - d·F for F >= 0.
    root = np.linalg.cholesky(compliance * 1e9)
    force = 1e3 * nnls(root.T, np.linalg.solve(root, np.full(len(engaged), approach * 1e6)))[0]
    return dict(zip(engaged, force, strict=True))


@settings(deadline=None)
@given(st.floats(1e-7, 2e-5), ANGLES, st.floats(-0.3, 0.35), st.floats(-0.15, 0.15))
def test_coupled_pairs_carry_what_least_squares_find(
    approach: float, pitches: float, first: float, second: float
) -> None:
    coupling = table(first, second)
    pairs = loaded(law(coupling), approach, pitches)
    for n, force in by_least_squares(coupling, approach, pitches).items():
        # Rounding of the least squares, whose system has a condition of a few.
        assert pairs[n % len(pairs), NORMAL] == pytest.approx(force, rel=1e-8, abs=1e-8 * STIFFNESS * approach)


def test_two_coupled_pairs_have_the_closed_form() -> None:
    coupling, depth, angle = table(0.25, 0.0), 5e-6, 5.5
    pairs = loaded(law(coupling), depth, angle)
    c = np.interp(0.5, np.linspace(0.0, 2.05, POINTS), coupling[0])
    # Equal springs: N (1/k + c) = d.
    for n in (5, 4):
        assert pairs[n % 3, NORMAL] == pytest.approx(depth / (1.0 / STIFFNESS + c), rel=1e-9)


def test_a_coupled_mesh_runs_and_carries_the_torque() -> None:
    points = tables().pair_stiffness_n_per_m.shape[1]
    coupled = pair_law(
        tables(),
        missing_material(gear_pair(), RELIEF),
        MeshConstants(gear_pair().line_of_action_m, 0.2124, 80e-6),
        damping_ratio=0.07,
        coupling_m_per_n=np.full((1, points), 0.15 / 1.8e8),
    )
    run = motion(make_structure(), coupled, step_s=1.0 / 204800)
    pitches, states = settled(run, 30.0, 1.0 / 204800, 6827, 0.3)
    force = columns(run, states, pitches)["mesh_force_n"]
    # One revolution of 18 meshes; what is left of the slow torsional mode.
    assert force.mean() == pytest.approx(30.0 / gear_pair().pinion.base_radius_m, rel=5e-3)
    assert force.min() > 0.5 * force.mean()


@pytest.mark.parametrize("wrong", [np.zeros(POINTS), np.zeros((1, 7)), np.full((1, POINTS), np.nan)])
def test_couplings_of_another_grid_are_refused(wrong: np.ndarray) -> None:
    with pytest.raises(ValueError, match="coupling_m_per_n: received"):
        law(wrong)
