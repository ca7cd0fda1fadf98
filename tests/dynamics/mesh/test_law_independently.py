"""The compiled pair law against plain Python of the equations: docs/scripts/exported_law.py, which shares no code."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from siggen.mesh.law_tables import law_tables
from siggen.mesh.node_forces import write_forces, write_node_forces
from siggen.mesh.pair_columns import (
    NODE_APPROACH,
    NODE_ARM,
    NODE_FRICTION,
    NODE_MOMENT,
    NODE_NORMAL,
    NODE_RATE,
    NODE_ROWS,
    NODE_SLIDING_0,
    NODE_SLIDING_1,
    NODE_SLOPE,
    NODE_SLOPE_RATE,
    NODE_TILT,
    NODE_TILT_RATE,
    NODE_TURN,
)
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from siggen.mesh.springs import EXACT_CHANGE, SMOOTH_CHANGE
from siggen.mesh.tooth_law import DampingLaw
from tests.dynamics.mesh.test_lane_forces import spalled

SCRIPT = Path(__file__).resolve().parents[3] / "docs" / "scripts" / "exported_law.py"
STATES = 160
STATE = (NODE_APPROACH, NODE_RATE, NODE_SLIDING_0, NODE_SLIDING_1, NODE_TILT, NODE_TILT_RATE)
SUMS = (NODE_NORMAL, NODE_FRICTION, NODE_ARM, NODE_MOMENT, NODE_TURN)
FORCE_N, MOMENT_N_M = 1200.0, 12.0
"""Of the mean torque, over half of the face: what differences count over."""


@pytest.fixture(scope="module")
def script() -> Any:
    spec = importlib.util.spec_from_file_location("exported_law", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its data classes look themselves up
    spec.loader.exec_module(module)
    return module


def drawn(rng: np.random.Generator) -> tuple[float, tuple[float, ...]]:
    """Return an angle, some with a corner near, and a state: loaded, barely touching, apart or on the back flank."""
    level = rng.choice([12e-6, 4e-6, 0.0, -100e-6], p=[0.5, 0.25, 0.1, 0.15])
    spread = (4e-6, 0.02, 0.02, 1.0, 1e-4, 0.1)
    state = np.array([level, 0.0, 0.0, 0.0, 0.0, 0.0]) + rng.normal(0.0, spread)
    return float(rng.uniform(2.0, 38.0)), tuple(state.tolist())


def independent(script: Any, law: PairLaw) -> Callable[[tuple[float, ...], float], np.ndarray]:
    """Return what gives ΣN, ΣF, Σ s F, Σμ and Σ ζ F of a state at an angle, from the law's tables alone."""
    plain = script.PairLaw({f"law.{name}": np.asarray(value) for name, value in law_tables(law).items()})

    def forces(state: tuple[float, ...], pitches: float) -> np.ndarray:
        plain.before = {}  # no start from the state before: each is settled from no force
        found = plain.forces(script.State(*state), pitches)
        return np.array([found.normal, found.friction, found.friction_moment, found.across, found.friction_across])

    return forces


def compiled(law: PairLaw, state: tuple[float, ...], pitches: float, pairs: np.ndarray) -> np.ndarray:
    node = pairs[:1, -NODE_ROWS:].T
    node[list(STATE), 0] = state
    write_forces(law, pitches, pairs)
    return np.array(node[list(SUMS), 0])


LAWS = {
    "coupled, tilting": {"tilts": True},
    "coupled, parallel": {"tilts": False},
    "alone, tilting": {"tilts": True, "coupled": False},
    "dampers by asperity share": {"tilts": True, "damping_ratio": DampingLaw(0.04, 0.02, 0.05)},
}


@pytest.mark.parametrize("name", LAWS)
def test_forces_of_a_state_are_those_of_the_equations(script: Any, name: str) -> None:
    law, rng = spalled(3, **LAWS[name]), np.random.default_rng(11)
    pairs, seen, independently = pair_table(law), np.zeros(4, dtype=int), independent(script, law)
    for _ in range(STATES):
        pitches, state = drawn(rng)
        expected = independently(state, pitches)
        found = compiled(law, state, pitches, pairs)
        # Pairs on one gear body are settled to less than this, see EXACT_CHANGE; the rest is rounding.
        scale = FORCE_N + abs(expected[0])
        np.testing.assert_allclose(found[:2], expected[:2], rtol=0.0, atol=1e-8 * scale)
        np.testing.assert_allclose(found[2:], expected[2:], rtol=0.0, atol=1e-8 * scale * MOMENT_N_M / FORCE_N)
        seen += [expected[0] == 0.0, expected[0] < 0.0, expected[0] > 0.0, expected[3] != 0.0]
    assert (seen[:3] > 5).all()
    assert (seen[3] > STATES // 4) == ("tilt" in name or "asperity" in name)


@pytest.mark.parametrize("name", [name for name in LAWS if "asperity" not in name])
def test_forces_at_the_nodes_of_a_step_are_those_of_their_states(script: Any, name: str) -> None:
    law, rng = spalled(3, **LAWS[name]), np.random.default_rng(13)
    nodes, independently = np.array([0.1, 0.5, 0.9]), independent(script, law)
    pairs = np.concatenate([pair_table(law)] * 3)
    for _ in range(STATES // 4):
        first, state = drawn(rng)
        states = np.array(state)[:, None] + 0.1 * np.array(drawn(rng)[1])[:, None] * (nodes - 0.5)
        node = np.zeros((NODE_ROWS, 3))
        node[list(STATE)] = states
        write_node_forces(law, nodes, np.full(3, 1.0 / 3.0), first, first + 0.01, pairs, node, SMOOTH_CHANGE)
        for q in range(3):
            expected = independently(tuple(states[:, q].tolist()), first + 0.01 * nodes[q])
            # One Newton step from a near state: below 1e-6 of the force where it was near, see SMOOTH_CHANGE.
            np.testing.assert_allclose(node[list(SUMS[:2]), q], expected[:2], atol=1e-4 * (FORCE_N + abs(expected[0])))


def test_tangents_of_the_sum_are_its_derivatives() -> None:
    law, rng = spalled(3, tilts=True), np.random.default_rng(17)
    node, pairs = np.zeros((NODE_ROWS, 1)), pair_table(law)
    for _ in range(60):
        pitches = float(rng.uniform(2.0, 38.0))
        state = [rng.uniform(8e-6, 14e-6), 0.0, 0.0, 0.0, 1e-5, 0.0]

        def sums(change: float, rate: float, state: list[float] = state, pitches: float = pitches) -> np.ndarray:
            node[list(STATE), 0] = [state[0] + change, rate, *state[2:]]
            one = np.ones(1)
            write_node_forces(law, 0.0 * one, one, pitches, pitches, pairs, node, EXACT_CHANGE)
            return node[:, 0].copy()

        here, step = sums(0.0, 0.0), 1e-11
        slope = (sums(step, 0.0) - sums(-step, 0.0))[NODE_NORMAL] / (2.0 * step)
        assert here[NODE_SLOPE] == pytest.approx(slope, rel=1e-3)
        per_rate = (sums(0.0, 1e-6) - sums(0.0, -1e-6))[NODE_NORMAL] / 2e-6
        assert here[NODE_SLOPE_RATE] == pytest.approx(per_rate, rel=1e-6)
