"""Damping of tooth pairs, and the film between flanks apart, against formulas of their own."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.gears.missing_material import missing_material
from siggen.mesh.node_forces import pair_forces
from siggen.mesh.pair_columns import DAMPING, STIFFNESS
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from tests.dynamics.pair_runs import gear_pair, law

DOUBLE, SINGLE = 5.3, 5.85
"""Angles with two pairs and with one pair in contact: the contact ratio is 1.637."""


def loaded(chosen: PairLaw, approach_m: float, rate_m_s: float, pitches: float) -> np.ndarray:
    pairs = pair_table(chosen)
    pair_forces(chosen, approach_m, rate_m_s, pitches, 0.0, 0.0, pairs)
    return pairs


def test_pairs_share_the_mesh_damping_by_stiffness() -> None:
    exact = missing_material(gear_pair(), None, corner_contact=False)
    pairs = loaded(law(exact, damping_ratio=0.07, mass=0.2124), 5e-6, 0.0, DOUBLE)
    touching = pairs[pairs[:, DAMPING] > 0.0]
    assert len(touching) == 2
    total = touching[:, STIFFNESS].sum()
    assert touching[:, DAMPING].sum() == pytest.approx(2.0 * 0.07 * np.sqrt(total * 0.2124), rel=1e-12)
    np.testing.assert_allclose(
        touching[:, DAMPING] / touching[:, STIFFNESS], touching[0, DAMPING] / touching[0, STIFFNESS]
    )
