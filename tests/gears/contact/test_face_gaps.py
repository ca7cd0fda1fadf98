"""Gaps that slices meet: damage, tips, and the refusals; where damage lies, says `test_flank_chords`."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.damage.flank_chords import flank_chords
from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.mesh.contact_edges import NO_EDGE
from siggen.mesh.face_slices import FaceGaps, _nearest, carrying_length, face_gaps
from tests.gears.builders import pair_18_47

PAIR = pair_18_47(module_m=3e-3)
SLICES = 60
SPALL = FlankSpall("pinion", 0, rectangle((1.6e-3, 2.4e-3), (4e-3, 12e-3)), 0.15e-3)


def flanks(pinion=(), gear=()):
    return tuple(
        flank_chords(PAIR.member(which), damage, PAIR.face_width_m, SLICES)
        for which, damage in (("pinion", pinion), ("gear", gear))
    )


def test_a_spall_seen_from_the_gear_is_its_mirror_image():
    position = np.array([PAIR.pitch_point_m])
    gaps = face_gaps(PAIR, *flanks((SPALL,)), position)
    row = np.flatnonzero(gaps.notch_m[0] > 0.0)
    np.testing.assert_allclose(gaps.notch_m[0, row], 0.15e-3)
    moved = face_gaps(PAIR, *flanks((SPALL,)), position + 0.05e-3)
    # the pinion's arc grows by R_b ψ dψ: the left edge moves away, the right one comes closer
    assert (moved.left_m[0, row] > gaps.left_m[0, row]).all()
    assert (moved.right_m[0, row] < gaps.right_m[0, row]).all()


def test_teeth_end_at_their_tips():
    start, end = PAIR.contact_start_m, PAIR.contact_end_m
    position = np.array([start, 0.5 * (start + end), end])
    gaps = face_gaps(PAIR, *flanks(), position)
    # at s_A the tip of the gear touches: its edge is behind the normal, and nothing lies before it
    np.testing.assert_allclose(gaps.right_m[0], 0.0, atol=1e-9)
    np.testing.assert_allclose(gaps.left_m[2], 0.0, atol=1e-9)
    assert (gaps.left_m[0] == NO_EDGE).all()
    assert (gaps.right_m[2] == NO_EDGE).all()
    assert (np.minimum(gaps.left_m, gaps.right_m)[1] < -1e-3).all()
    assert not gaps.notch_m.any()
    assert not gaps.on_damage.any()


def test_a_gap_open_at_the_tip_has_no_edge_there():
    tip = float(PAIR.pinion.height_m(PAIR.pinion.tip_roll_rad))
    open_spall = FlankSpall("pinion", 0, rectangle((tip - 1e-3, tip + 0.2e-3), (4e-3, 12e-3)), 0.15e-3)
    gaps = face_gaps(PAIR, *flanks((open_spall,)), np.array([PAIR.contact_end_m - 0.5e-3]))
    row = gaps.on_damage[0] > 0.0
    assert row.any()
    assert (gaps.right_m[0, row] == NO_EDGE).all()
    assert (gaps.left_m[0, row] > 0.0).all()


def test_the_carrying_length_is_the_land_or_the_whole_face():
    land = np.full(100, -NO_EDGE)
    gap = np.where(np.arange(100) < 40, 0.6e-3, -NO_EDGE)
    none = np.zeros(100)
    sizes = 0.2e-3, 6.7e-3, 0.34e-6
    tips, whole = np.full((100, 2), -NO_EDGE), np.ones(100)

    def length(edge_m, covered) -> float:
        return carrying_length(FaceGaps(edge_m, edge_m, none, none, none, covered, tips), none, *sizes)

    assert length(land, none) == pytest.approx(20e-3)
    assert length(gap, np.where(gap > 0.0, whole, 0.0)) == pytest.approx(12e-3, rel=0.02)
    assert length(gap, np.where(gap > 0.0, 0.5 * whole, 0.0)) == pytest.approx(16e-3, rel=0.02)
    assert length(np.full(100, 0.6e-3), whole) == pytest.approx(20e-3)


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(0, 4)), min_size=1, max_size=6))
def test_a_gap_grows_by_all_that_touch_it_and_by_no_other(found):
    """Beside half steps that are marked one by one; several gaps may be as near to 0."""
    room = np.array([(low, low + width) for low, width in found], dtype=float).T
    steps = {step for low, width in found for step in range(2 * low, 2 * (low + width) + 1)}
    first = min(range(len(found)), key=lambda k: max(room[0, k], -room[1, k]))
    low, high = (round(2 * room[side, first]) for side in (0, 1))
    while low - 1 in steps:
        low -= 1
    while high + 1 in steps:
        high += 1
    assert _nearest(room, len(found)) == (0.5 * low, 0.5 * high)
