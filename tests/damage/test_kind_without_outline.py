"""A damage that shows on no flank, such as a hinge in the root, goes through all that asks about damage."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.columns.damage import DAMAGE_COLUMNS
from siggen.damage.flank_damage import damage_problems, pit_rows
from siggen.damage.part import has_extent
from siggen.mesh.contact_table import FORCE, ROUGH, contact_table
from siggen.mesh.damage_summary import damage_summary
from siggen.mesh.mesh_tables import largest_stiffness_loss, mesh_tables
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions
from siggen.views.flank import _views
from tests.damage.toy_hinge import Hinge
from tests.gears.builders import pair_18_47, pit

PAIR, OPTIONS = pair_18_47(), StiffnessOptions()


HINGE = Hinge("pinion", 3, 1e-3, 2e4)


def test_it_softens_its_pairs_by_its_own_compliance_and_no_others() -> None:
    tables = mesh_tables(PAIR, (HINGE,), OPTIONS, points=65)
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 65)
    added = HINGE.tooth_compliance_m_per_n(PAIR, position / PAIR.pinion.base_radius_m, position)
    healthy, hinged = tables.pair_stiffness_n_per_m
    assert 1.0 / hinged - 1.0 / healthy == pytest.approx(added, rel=1e-6)
    assert np.array_equal(healthy, mesh_tables(PAIR, (), OPTIONS, points=65).pair_stiffness_n_per_m[0])
    assert 0.0 < largest_stiffness_loss(PAIR, (HINGE,), OPTIONS) < 0.5


def test_the_contact_keeps_its_land_and_pits_beside_it_stay() -> None:
    damage = (HINGE, pit(tooth=5))
    table = contact_table(PAIR, damage, OPTIONS, TableOptions(4e3), 65)
    # Pinion teeth ascending, the hinge's tooth first; forces at the largest approach in the middle of the path.
    healthy, hinged, pitted = (table.upright[int(table.column[row, 32])] for row in range(3))
    assert not np.any(table.touch_m)
    assert 0.5 * healthy[-1, FORCE] < hinged[-1, FORCE] < 0.99 * healthy[-1, FORCE]
    assert np.array_equal(hinged[:, ROUGH], healthy[:, ROUGH])
    assert table.upright[:, :, ROUGH].max() > 0.0
    assert not np.any(pitted[:, ROUGH] < 0.0)
    assert pit_rows(damage).shape[0] == 1
    assert has_extent(HINGE)


def test_labels_problems_rows_and_pictures_do_without_an_outline() -> None:
    summary = damage_summary(PAIR, (HINGE,))
    assert (summary.count, summary.union_area_m2, summary.largest_profile_length_m) == (1, 0.0, 0.0)
    assert not summary.through_face
    assert not damage_problems(PAIR, (HINGE,))
    (problem,) = damage_problems(PAIR, (Hinge("pinion", 40, 1e-3, 2e4),))
    assert str(problem) == "hinge 0: received tooth 40; allowed: a tooth of the gear"
    of_gear = {"face_width_mm", "pitch_height_mm", "tip_height_mm"}
    assert set(HINGE.table_row()) == {column.name for column in DAMAGE_COLUMNS} - {"record_id"} - of_gear
    (view,) = _views(PAIR, "hinged", (HINGE,))
    assert view.outlines_mm == ()
