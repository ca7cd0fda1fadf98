"""Chipped and missing teeth: the pair of a lower addendum, and the way of rigid gears over a gap."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from siggen.arrays import FloatArray
from siggen.damage.chip import MARGIN_PITCHES, WholeChip, corner_reach_pitches, keeps_contact
from siggen.damage.on_flank import on_back_flanks, reach_pitches, turned, with_losses
from siggen.damage.pits import FlankPit
from siggen.gears.back_flanks import back_flanks, driven_pair
from siggen.gears.missing_material import CORNER_REACH_PITCHES, missing_material, touching_gap_m
from siggen.mesh.mesh_tables import TABLE_POINTS, MeshTables, mesh_tables
from siggen.mesh.node_forces import pair_forces
from siggen.mesh.pair_columns import NORMAL
from siggen.mesh.pair_columns import PAIR as NUMBER
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.pair_springs import pair_table
from siggen.mesh.static_mesh import static_approaches_m
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.names import Side
from tests.damage.rigid_gears import RigidGears
from tests.gears.builders import pair_18_47

PAIR = pair_18_47()
GAP = 2.0 - PAIR.contact_ratio
BACKLASH_M, NEXT_TO_NOTHING_N = 80e-6, 0.01
GONE = WholeChip(Side.DRIVER, 5, inf)


@cache
def tables() -> MeshTables:
    return mesh_tables(PAIR, (), StiffnessOptions(), points=TABLE_POINTS)


def law(*chips: WholeChip) -> PairLaw:
    whole = missing_material(PAIR, points=TABLE_POINTS, reach_pitches=reach_pitches(PAIR, chips))
    mesh = MeshConstants(PAIR.line_of_action_m, 1.0, BACKLASH_M)
    return pair_law(tables(), with_losses(whole, PAIR, chips), mesh, damping_ratio=0.0)


def unloaded_m(chosen: PairLaw, pitches: FloatArray) -> FloatArray:
    return static_approaches_m(chosen, NEXT_TO_NOTHING_N, pitches)


@pytest.mark.parametrize("which", list(Side))
def test_teeth_that_are_all_chipped_alike_are_those_of_a_lower_addendum(which: str) -> None:
    height_m = 0.2 * PAIR.pinion.module_m
    teeth = PAIR.member(which)
    lower = replace(PAIR, **{which: replace(teeth, addendum_coefficient=0.8)})
    whole = missing_material(PAIR, points=2001, reach_pitches=0.2)
    chipped = with_losses(whole, PAIR, tuple(WholeChip(which, tooth, height_m) for tooth in range(teeth.teeth)))
    position = np.linspace(whole.start_m, whole.end_m, 2001)
    rows = getattr(chipped, which)
    # The corner's gap is a difference of angles of 0.1 rad: rounding of 1e-17 rad times the base radius.
    expected = np.tile(touching_gap_m(lower, which, position), (teeth.teeth, 1))
    np.testing.assert_allclose(rows.profile_m[rows.kind_of_tooth], expected, rtol=1e-9, atol=1e-15)
    assert lower.contact_ratio < PAIR.contact_ratio


def test_the_less_is_lost_the_less_is_missing_and_nothing_takes_nothing() -> None:
    position = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 501)
    heights = [1e-9, 0.2e-3, 0.8e-3, 2e-3]
    found = [WholeChip(Side.DRIVER, 0, height).missing_m(PAIR, position) for height in heights]
    assert found[0].max() < 1e-15
    assert all(np.all(more >= less) for less, more in pairwise(found))
    assert all(
        WholeChip(Side.DRIVER, 0, more).hides(WholeChip(Side.DRIVER, 0, less)) for less, more in pairwise(heights)
    )
    assert not GONE.hides(WholeChip(Side.DRIVER, 4, 1e-3))
    assert GONE.hides(FlankPit(Side.DRIVER, 5, 1.9e-3, 10e-3, 0.3e-3, 0.2e-3, 0.4e-3, "flat"))


def test_corners_are_followed_as_far_as_they_carry() -> None:
    """Both corners touch somewhere in the gap, whose length is what whole pairs leave."""
    reach = corner_reach_pitches(PAIR, Side.DRIVER, inf) - MARGIN_PITCHES
    ends = PAIR.contact_end_m + reach * PAIR.base_pitch_m, PAIR.contact_start_m - (GAP - reach) * PAIR.base_pitch_m
    gaps = [touching_gap_m(PAIR, which, np.array([s]))[0] for which, s in zip(Side, ends, strict=True)]
    assert gaps[0] == pytest.approx(gaps[1], rel=0.02)  # places 1e-3 of a base pitch apart, 5e-3 of this way
    assert corner_reach_pitches(PAIR, Side.DRIVER, 0.1e-3) == CORNER_REACH_PITCHES
    assert reach_pitches(PAIR, ()) == CORNER_REACH_PITCHES
    assert keeps_contact(PAIR, Side.DRIVER, 2e-3)
    assert not keeps_contact(PAIR, Side.DRIVER, 6.9e-3)


@pytest.mark.parametrize("height_m", [3.5e-3, inf])
def test_the_unloaded_gear_lags_as_a_rigid_one_over_the_gap(height_m: float) -> None:
    """Number 5 of either gear's teeth meets at angle 5; its neighbours carry where it does not."""
    pitches = np.linspace(4.5, 7.0, 601)
    found = unloaded_m(law(replace(GONE, height_m=height_m)), pitches)
    rigid = RigidGears(PAIR)
    gone, tips = ((0,), {}) if height_m == inf else ((), {0: rigid.tip[0] - height_m})
    expected = rigid.lag_m(pitches - 5.0, tips, gone)
    # Tables of 2049 points, and 0.02 nm of deflection under next to nothing.
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=0.01 * expected.max())
    if height_m == inf:
        assert expected.max() > 100e-6  # more than the backlash
        lagging = np.count_nonzero(found > 5e-9) * (pitches[1] - pitches[0])
        assert lagging == pytest.approx(GAP, abs=0.02)  # the first nanometres of a parabola


def test_a_missing_tooth_has_no_back_flank() -> None:
    """Pushed back by as much as the backlash, neighbours carry; the pair that is gone never does."""
    chosen = law(GONE)
    pairs = pair_table(chosen)
    for approach in (-BACKLASH_M - 20e-6, 200e-6):
        carried = set()
        for pitches in np.linspace(4.0, 7.5, 71):
            pair_forces(chosen, approach, 0.0, float(pitches), 0.0, 0.0, pairs)
            carried |= {int(number) for number in pairs[pairs[:, NORMAL] != 0.0, NUMBER]}
        assert {4, 6} <= carried
        assert 5 not in carried


@pytest.mark.parametrize(("which", "tooth"), [(Side.DRIVER, 5), (Side.DRIVEN, 9), (Side.DRIVEN, 0)])
def test_the_back_flank_of_a_chipped_tooth_is_chipped_where_a_misplaced_one_is_misplaced(
    which: str, tooth: int
) -> None:
    """Tables of back flanks number pairs as those of drive flanks, in which the gear's tooth is the one in front."""
    whole, driven = missing_material(PAIR, points=TABLE_POINTS), driven_pair(PAIR)
    teeth = getattr(whole, which)
    places = teeth.offset_m.copy()
    places[tooth] = 1e-6
    misplaced = getattr(back_flanks(replace(whole, **{which: replace(teeth, offset_m=places)}), PAIR), which)
    chip = WholeChip(which, tooth, 0.2 * PAIR.pinion.module_m)
    back = getattr(on_back_flanks(back_flanks(whole, PAIR), driven, (chip,)), which)
    sound = getattr(back_flanks(whole, PAIR), which).profile_m[0]
    chipped = np.abs(back.profile_m[back.kind_of_tooth] - sound).max(axis=1) > 0.0
    np.testing.assert_array_equal(chipped, misplaced.offset_m != 0.0)
    role = which.mate
    lower = replace(driven, **{role: replace(driven.member(role), addendum_coefficient=0.8)})
    position = PAIR.line_of_action_m - np.linspace(whole.end_m, whole.start_m, TABLE_POINTS)
    expected = touching_gap_m(lower, role, position)
    np.testing.assert_allclose(back.profile_m[back.kind_of_tooth][chipped][0], expected, rtol=1e-9, atol=1e-14)
    assert turned(chip, driven).tooth == int(np.flatnonzero(chipped)[0])
