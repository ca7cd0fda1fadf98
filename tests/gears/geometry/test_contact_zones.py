"""Zones of single and double contact along the line of action."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.gears.gear_pair import contact_zones
from siggen.mesh.mesh_stiffness import pairs_in_contact
from tests.gears.builders import pair_18_47, spur_gear


def test_zones_of_18_47_are_double_single_double_at_the_literatures_edges():
    pair = pair_18_47()
    zones = contact_zones(pair)
    assert [zone.pairs for zone in zones] == [2, 1, 2]
    start, end, pitch = pair.contact_start_m, pair.contact_end_m, pair.base_pitch_m
    edges = [zones[0].start_m, *(zone.end_m for zone in zones)]
    assert edges == pytest.approx([start, end - pitch, start + pitch, end], rel=1e-14)
    # Heights of the ends of single contact on the 18-tooth pinion, printed to 0.1 um: 1.1692 and 2.4250 mm.
    heights = [float(pair.pinion.height_m(edge / pair.pinion.base_radius_m)) for edge in edges[1:3]]
    assert heights == pytest.approx([1.1692e-3, 2.4250e-3], abs=6e-8)


@given(st.integers(18, 60), st.integers(18, 120))
def test_zones_tile_the_path_and_hold_the_contact_ratio(first, second):
    pair = pair_18_47()
    pair = type(pair)(spur_gear(first), spur_gear(second), pair.face_width_m, 206e9, 0.3)
    zones = contact_zones(pair)
    assert zones[0].start_m == pytest.approx(pair.contact_start_m)
    assert zones[-1].end_m == pytest.approx(pair.contact_end_m)
    assert all(a.end_m == b.start_m for a, b in pairwise(zones))
    for zone in zones:
        middle = 0.5 * (zone.start_m + zone.end_m)
        angle = np.array([(middle - pair.contact_start_m) / pair.pinion.base_radius_m])
        assert pairs_in_contact(pair, angle)[0].size == zone.pairs
