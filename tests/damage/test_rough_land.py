"""Rough land beside pits: its part of the contact line by an independent grid, and what it is in the contact table."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.damage.chip import PartChip, lost_outline
from siggen.damage.rough_land import REACH_M, rough_land, rough_shares
from siggen.mesh.contact_table import FORCE, ROUGH, contact_table
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions
from tests.gears.builders import layers, pair_18_47, pit

PAIR = pair_18_47()
FLANKS = ("pinion", "gear")
SLICES, WIDTH = 63, PAIR.face_width_m
SCATTERED = (pit(2.5, 3.0, 0.8, 0.3), pit(4.0, 5.0, 0.3, 0.9), pit(3.0, 0.2, 0.5, 0.5), pit(3.2, 19.9, 0.4, 0.4))


def near_pits(gear, pits, arc_m):
    """Rough points (k, 1000) of a flank at arcs (k,): by the distance from every chord, which is rough as far as long.

    Chords of overlapping pits are one; on the unrolled flank, where distances are those on the metal.
    """
    face, lines = (np.arange(1000) + 0.5) * WIDTH / 1000, (np.arange(2000) + 0.5) * WIDTH / 2000
    rough = np.zeros((arc_m.size, face.size), bool)
    for line in lines:
        chords = []
        for one in pits:
            inside = 1.0 - ((line - one.face_m) / one.semi_axis_face_m) ** 2
            if inside > 0.0:
                half = one.semi_axis_profile_m * np.sqrt(inside)
                roll = gear.roll_at_height(one.height_m + np.array([-half, half]))
                chords.append(0.5 * gear.base_radius_m * roll**2)
        merged = []
        for low, high in sorted(map(tuple, chords)):
            if merged and low <= merged[-1][1]:
                merged[-1][1] = max(high, merged[-1][1])
            else:
                merged.append([low, high])
        for low, high in merged:
            reach = min(REACH_M, high - low)
            near = np.abs(face - line) <= reach
            off = np.maximum(np.maximum(low - arc_m, arc_m - high), 0.0)
            rough[:, near] |= np.hypot(off[:, np.newaxis], (face - line)[near]) <= reach
    return rough


@pytest.mark.parametrize("pits", [layers(3, 10), SCATTERED], ids=["layers", "scattered"])
@pytest.mark.parametrize("which", ["pinion", "gear"])
def test_the_rough_part_of_the_line_is_that_within_reach_of_the_pits(which, pits):
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 201)
    lands = {name: rough_land(PAIR.member(name), pits if name == which else (), WIDTH, SLICES) for name in FLANKS}
    found = rough_shares(PAIR, lands["pinion"], lands["gear"], position[:, np.newaxis] + np.zeros(SLICES))
    along = position if which == "pinion" else PAIR.line_of_action_m - position
    gear = PAIR.member(which)
    expected = near_pits(gear, pits, along**2 / (2.0 * gear.base_radius_m))
    off = np.abs(found.mean(axis=1) - expected.mean(axis=1))
    assert found.mean(axis=1).max() > 0.15
    # Lines stand 50 µm apart: where ten pits begin at once, each of their ends may be rounded by one.
    assert off.mean() < 1e-3
    assert off.max() < 20 * 50e-6 / WIDTH


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
