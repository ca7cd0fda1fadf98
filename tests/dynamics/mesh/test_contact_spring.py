"""The compiled force of a pair reads the table of the contact across the face as it was made."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.damage.outlines import rectangle
from siggen.damage.part import Damage
from siggen.damage.spalls import FlankSpall
from siggen.gears.missing_material import missing_material
from siggen.mesh.body_coupling import body_coupling
from siggen.mesh.contact_table import ContactTable, contact_table, node_places_m
from siggen.mesh.mesh_tables import mesh_tables
from siggen.mesh.node_forces import pair_forces, static_approach_m, static_force
from siggen.mesh.pair_columns import CARRYING, NORMAL, PENETRATION, POSITION, ROUGH, STIFFNESS
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.pair_springs import pair_table
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions
from siggen.record.contact import whole_face
from tests.dynamics.pair_runs import RELIEF, gear_pair

TEETH = StiffnessOptions()
POINTS = 513


def spall() -> Damage:
    pair = gear_pair()
    height = float(pair.pinion.height_m(np.array([pair.pitch_point_m / pair.pinion.base_radius_m]))[0])
    outline = rectangle((height - 0.4e-3, height + 0.4e-3), (-5e-3, 25e-3))
    return (FlankSpall("pinion", 5, outline, 0.2e-3, "flat"),)


def made(damage: Damage, *, coupled: bool = False) -> tuple[ContactTable, PairLaw]:
    pair = gear_pair()
    table = contact_table(pair, damage, TEETH, TableOptions(3600.0), POINTS)
    along = np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)
    law = pair_law(
        whole_face(pair, damage, TEETH, POINTS),
        missing_material(pair, RELIEF),
        MeshConstants(pair.line_of_action_m, 0.2124, 80e-6),
        damping_ratio=0.07,
        contact=table,
        coupling_m_per_n=body_coupling(pair, TEETH, along) if coupled else None,
    )
    return table, law


def test_the_force_of_a_single_pair_is_that_of_its_column() -> None:
    table, law = made(())
    pairs = pair_table(law)
    # At 1.2 base pitches behind its entry the pair before it has left: 1.66 - 1 < 1.2 - 0.5.
    for approach in (2e-6, 7e-6, 12e-6):
        pair_forces(law, approach, 0.0, 0.9, 0.0, 0.0, pairs)
        loaded = np.flatnonzero(pairs[:, NORMAL] > 0.0)
        for i in loaded:
            place = (pairs[i, POSITION] - gear_pair().contact_start_m) / (
                gear_pair().contact_end_m - gear_pair().contact_start_m
            )
            column = place * (table.curves.shape[0] - 1)
            node = node_places_m(table.unit_m, table.curves.shape[1])
            low, high = (
                np.interp(pairs[i, PENETRATION], node, table.upright[k, :, 0]) for k in (int(column), int(column) + 1)
            )
            # Straight lines between nodes lie above the cubic by some per cent of a force.
            assert pairs[i, NORMAL] == pytest.approx(low + (column - int(column)) * (high - low), rel=0.03)
            assert 0.9 < pairs[i, CARRYING] <= 1.0
            assert pairs[i, ROUGH] == 0.0


def test_force_and_stiffness_are_value_and_derivative() -> None:
    _, law = made(spall())
    pairs = pair_table(law)
    step = 1e-11
    for pitches in (5.6, 5.75, 5.8, 6.2):
        for approach in (4e-6, 9e-6, 16e-6):
            pair_forces(law, approach, 0.0, pitches, 0.0, 0.0, pairs)
            slope = pairs[:, STIFFNESS][pairs[:, NORMAL] > 0.0].sum()
            ahead, behind = (static_force(law, approach + d, pitches, pairs) for d in (step, -step))
            assert (ahead - behind) / (2.0 * step) == pytest.approx(slope, rel=1e-4)


def test_a_spall_through_the_face_lets_the_pair_sink_and_its_share_carry_on_damage() -> None:
    _, damaged = made(spall())
    _, healthy = made(())
    pitch_point = (gear_pair().pitch_point_m - gear_pair().contact_start_m) / gear_pair().base_pitch_m
    sunk = static_approach_m(damaged, 1200.0, 5.0 + pitch_point) - static_approach_m(healthy, 1200.0, 5.0 + pitch_point)
    assert 10e-6 < sunk < 16e-6  # the rigid sink of 0.8 mm is about 12 um, the edges give way by 1 to 3 um more
    pairs = pair_table(damaged)
    pair_forces(damaged, 25e-6, 0.0, 5.0 + pitch_point, 0.0, 0.0, pairs)
    assert pairs[:, ROUGH].max() == pytest.approx(1.0)


@pytest.mark.parametrize("approach", [3e-6, 8e-6, 15e-6])
def test_coupled_pairs_solve_their_equations(approach: float) -> None:
    _, law = made(spall(), coupled=True)
    _, alone = made(spall())
    pairs, single = pair_table(law), pair_table(alone)
    for pitches in (5.1, 5.3, 5.75):
        pair_forces(law, approach, 0.0, pitches, 0.0, 0.0, pairs)
        # The force of every pair is that of its own penetration without coupling.
        for i in np.flatnonzero(pairs[:, NORMAL] > 0.0):
            pair_forces(alone, approach, 0.0, pitches, 0.0, 0.0, single)
            moved = approach - (single[i, PENETRATION] - pairs[i, PENETRATION])
            pair_forces(alone, moved, 0.0, pitches, 0.0, 0.0, single)
            assert single[i, NORMAL] == pytest.approx(pairs[i, NORMAL], rel=1e-8)


def test_healthy_tables_keep_the_kinds_of_damaged_pairs() -> None:
    pair = gear_pair()
    found = whole_face(pair, spall(), TEETH, POINTS)
    assert found.pair_stiffness_n_per_m.shape[0] == 2
    healthy = mesh_tables(pair, (), TEETH, points=POINTS).pair_stiffness_n_per_m[0]
    np.testing.assert_array_equal(found.pair_stiffness_n_per_m[1], healthy)
    assert set(np.unique(found.table_of_pair)) == {0, 1}
