from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.mesh.mesh_force import mean_mesh_stiffness, mesh_force, mesh_law, mesh_stiffness, table_row
from siggen.mesh.mesh_tables import MeshTables
from tests.dynamics.conftest import CONTACT_RATIO, make_tables


def test_mesh_stiffness_is_the_sum_over_the_pairs_in_contact() -> None:
    law = mesh_law(make_tables(np.full((1, 33), 1e8)), 0.0, 0.0)
    overlap = CONTACT_RATIO - 1.0
    assert mesh_stiffness(law, 5.0 + 0.5 * overlap) == pytest.approx(2e8)
    assert mesh_stiffness(law, 5.0 + overlap + 0.01) == pytest.approx(1e8)


def test_the_mean_of_the_mesh_stiffness_over_the_angle(sharp_tables: MeshTables) -> None:
    healthy = make_tables(sharp_tables.pair_stiffness_n_per_m[:1])
    law = mesh_law(healthy, 0.0, 0.0)
    angles = (np.arange(20000) + 0.5) / 20000
    mean = np.mean([mesh_stiffness(law, angle) for angle in angles])
    # Midpoint rule across two jumps of half the stiffness: half a cell each, 1/20000.
    assert mean_mesh_stiffness(sharp_tables) == pytest.approx(mean, rel=1e-4)


@given(engagement=st.integers(-(10**6), 10**6))
def test_every_engagement_meets_its_teeth_over_the_hunting_period(engagement: int) -> None:
    numbers = np.arange(18 * 47, dtype=np.int32).reshape(18, 47)
    rows = make_tables(np.full((18 * 47, 3), 1e8))
    tables = MeshTables(rows.start_m, rows.end_m, rows.step_m, rows.base_pitch_m, rows.pair_stiffness_n_per_m, numbers)
    law = mesh_law(tables, 0.0, 0.0)
    assert table_row(law, engagement) == (engagement % 18) * 47 + engagement % 47
    assert table_row(law, engagement) == table_row(law, engagement + 18 * 47)


@pytest.mark.parametrize(
    ("approach", "rate", "expected"),
    [
        (60e-6, 0.0, 3.2e8 * 20e-6),
        (60e-6, 0.01, 3.2e8 * 20e-6 + 5.0),
        (40e-6, 0.01, 0.0),
        (0.0, 0.01, 0.0),
        (-40e-6, -0.01, 0.0),
        (-60e-6, 0.0, -3.2e8 * 20e-6),
    ],
)
def test_backlash_is_centred_and_the_damper_acts_only_in_contact(
    approach: float, rate: float, expected: float, constant_tables: MeshTables
) -> None:
    law = mesh_law(constant_tables, 500.0, 80e-6)
    # The table's angle 0.3 is inside both base pitches; products of three numbers round at 1e-15.
    assert mesh_force(law, approach, rate, 0.3) == pytest.approx(expected, rel=1e-12, abs=1e-9)


def test_without_backlash_the_force_is_linear_through_zero(constant_tables: MeshTables) -> None:
    law = mesh_law(constant_tables, 500.0, 0.0)
    assert mesh_force(law, -2e-6, 0.01, 0.3) == pytest.approx(-3.2e8 * 2e-6 + 5.0, rel=1e-12)
