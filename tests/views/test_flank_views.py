"""Damaged flanks as they are drawn: true areas, zones that tile the active profile, a table of all damage."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.views.flank import flank_damage_table, flank_views
from tests.config.minimal import design

LISTED = {
    "kind": "list",
    "pits": [
        {"tooth": 3, "face_mm": 5.0, "height_mm": 2.0, "semi_axis_face_mm": 1.0, "semi_axis_profile_mm": 0.5,
         "depth_mm": 0.2},
        {"gear": "gear", "tooth": 7, "face_mm": 12.0, "height_mm": 4.0, "semi_axis_face_mm": 0.8,
         "semi_axis_profile_mm": 0.4, "depth_mm": 0.3},
    ],
}  # fmt: skip


@pytest.fixture
def views():
    return flank_views(design(states__slight__damage=LISTED).gearbox(0))


def test_one_view_per_damaged_tooth(views):
    assert [(v.state, v.gear, v.tooth) for v in views] == [("slight", "pinion", 3), ("slight", "gear", 7)]


def test_zones_tile_the_active_profile_and_hold_the_pitch_line_in_single_contact(views):
    for view in views:
        assert [zone.pairs for zone in view.zones] == [2, 1, 2]
        assert view.zones[0].low_mm == view.start_mm
        assert view.zones[-1].high_mm == pytest.approx(view.tip_mm)
        assert view.zones[1].low_mm < view.pitch_mm < view.zones[1].high_mm
        assert 0 <= view.foot_mm <= view.start_mm < view.tip_mm


def test_arcs_of_the_paper_gear_are_the_tabulated_ones():
    view = flank_views(load_config("configs/paper_a.yaml").gearbox(0), state="moderate")[0]
    # Arc of the pitch point of 18 teeth at module 3.5 above the base circle, printed to 0.1 um.
    assert view.pitch_mm == pytest.approx(1.9606, abs=6e-5)
    assert len(view.outlines_mm) == len(view.depths_mm) == 16
    assert view.area_mm2 < 16 * np.pi * 0.3 * 0.2 * 1.1


def test_damage_is_that_of_the_asked_specimen_whatever_its_records():
    usable = design(repeats=3, operating_points=[{"speed_hz": 30.0, "torque_nm": 60.0}] * 2)
    for specimen in (0, 1, 7):
        teeth = set(flank_damage_table(usable.gearbox(specimen))["tooth"].to_pylist())
        assert teeth == {view.tooth for view in flank_views(usable.gearbox(specimen))}
