"""Rough land beside pits: its part of the contact line by an independent grid, and what it is in the contact table."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from siggen.gears.contact.contact_table import contact_table
from siggen.gears.contact.table_columns import FORCE, ROUGH
from siggen.gears.contact.table_options import TableOptions
from siggen.gears.damage.part_chip import PartChip, lost_outline
from siggen.gears.damage.rough_land import REACH_M, rough_land, rough_shares
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47, pit

PAIR = pair_18_47()
FLANKS = ("pinion", "gear")
SLICES, WIDTH = 63, PAIR.face_width_m
SCATTERED = (pit(2.5, 3.0, 0.8, 0.3), pit(4.0, 5.0, 0.3, 0.9), pit(3.0, 0.2, 0.5, 0.5), pit(3.2, 19.9, 0.4, 0.4))


def near_pits(gear, pits, arc_m):
    """Rough points (k, 1000) of a flank at arcs (k,): in a pit, or within reach of its edge on the unrolled flank."""
    face, turn = (np.arange(1000) + 0.5) * WIDTH / 1000, np.linspace(0.0, 2.0 * np.pi, 2000)
    points = np.stack(np.broadcast_arrays(arc_m[:, np.newaxis], face), axis=-1)
    height = gear.height_m(np.sqrt(2.0 * arc_m / gear.base_radius_m))[:, np.newaxis]
    rough = np.zeros(points.shape[:2], bool)
    for one in pits:
        off = (height - one.height_m) / one.semi_axis_profile_m, (face - one.face_m) / one.semi_axis_face_m
        rough |= off[0] ** 2 + off[1] ** 2 <= 1.0
        roll = gear.roll_at_height(one.height_m + one.semi_axis_profile_m * np.sin(turn))
        edge = np.stack([0.5 * gear.base_radius_m * roll**2, one.face_m + one.semi_axis_face_m * np.cos(turn)], axis=-1)
        edge = edge[(edge[:, 1] >= 0.0) & (edge[:, 1] <= WIDTH)]
        rough |= cKDTree(edge).query(points, distance_upper_bound=REACH_M)[0] <= REACH_M
    return rough


@pytest.mark.parametrize("pits", [layers(3, 10), SCATTERED], ids=["layers", "scattered"])
@pytest.mark.parametrize("which", ["pinion", "gear"])
def test_the_rough_part_of_the_line_is_that_within_reach_of_the_pits(which, pits):
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 801)
    lands = {name: rough_land(PAIR.member(name), pits if name == which else (), WIDTH, SLICES) for name in FLANKS}
    found = rough_shares(PAIR, lands["pinion"], lands["gear"], position[:, np.newaxis] + np.zeros(SLICES))
    along = position if which == "pinion" else PAIR.line_of_action_m - position
    gear = PAIR.member(which)
    expected = near_pits(gear, pits, along**2 / (2.0 * gear.base_radius_m))
    off = np.abs(found.mean(axis=1) - expected.mean(axis=1))
    assert found.mean(axis=1).max() > 0.15
    # Lines and points stand 50 and 20 µm apart: it is rounding of the ends of ten pits, where all begin at once.
    assert off.mean() < 1e-3
    assert off.max() < 0.03


def test_land_beside_pits_carries_as_rough_and_a_broken_corner_leaves_none():
    stiffness, options = StiffnessOptions(coupling="body"), TableOptions()
    pitted = contact_table(PAIR, layers(1, 10), stiffness, options, 513)
    healthy = contact_table(PAIR, (), stiffness, options, 513)
    assert not healthy.upright[..., ROUGH].any()
    share = pitted.upright[:, :, ROUGH]
    # Ten pits of 0.6 mm, 1 mm apart: above and below them 10.6 of 20 mm are rough, less what is beyond the corners.
    assert 0.45 < share.max() < 0.53
    assert share.min() == 0.0
    corner = PartChip("pinion", 0, 2e-3, 4e-3, lost_outline(PAIR.pinion, 2e-3, 4e-3))
    chipped = contact_table(PAIR, (corner,), stiffness, options, 513)
    assert not chipped.upright[..., ROUGH].any()
    assert chipped.upright[..., FORCE].max() > 0.0
