"""Contact length that two mating flanks together lose wholly, on stretches however narrow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.damage.flank_damage import damage_problems, pit_rows
from siggen.damage.outlines import Polygon, rectangle
from siggen.damage.row_columns import COLUMNS
from siggen.damage.spalls import FlankSpall
from siggen.damage.union import _depth_crossings, lengths_covered
from siggen.damage.whole_loss import takes_whole_contact
from tests.gears.builders import pair_18_47, pit

PAIR = pair_18_47()
WIDTH_MM = 20.0
NONE = np.empty((0, COLUMNS))


def height_mm(which, position):
    gear = PAIR.member(which)
    travel = position if which == "pinion" else PAIR.line_of_action_m - position
    return 1e3 * np.asarray(gear.height_m(travel / gear.base_radius_m))


def covered(pinion, gear, position):
    """Return the face length that two flanks cover together, by siggen's union at one position after another."""
    heights = [height_mm(which, position) / 1e3 for which in ("pinion", "gear")]
    return lengths_covered(heights[0], pit_rows(pinion), heights[1], pit_rows(gear), WIDTH_MM / 1e3)


def planted(overlap_m):
    """Return a pit on each flank whose widest places lie apart and that together pass the face by `overlap_m` at most.

    The pinion's pit reaches from the face's left end, the gear's from its right end.
    """
    at = PAIR.pitch_point_m
    low = pit(float(height_mm("pinion", at - 60e-6)), 0.0, 10.0, 0.3, 0.2)
    high = pit(float(height_mm("gear", at + 45e-6)), WIDTH_MM, 9.5, 0.25, 0.2, gear="gear", tooth=30)

    def free(centre_mm, position):
        reach = []
        for p, which in ((low, "pinion"), (high, "gear")):
            u = (height_mm(which, position) / 1e3 - p.height_m) / p.semi_axis_profile_m
            reach.append(p.semi_axis_face_m * np.sqrt(np.clip(1.0 - u * u, 0.0, None)))
        return centre_mm / 1e3 - reach[0] - reach[1]

    # The gap's least value by its definition, on ever finer grids; its curvature leaves no digit after five of them.
    start, stop = at - 0.2e-3, at + 0.2e-3
    for _ in range(5):
        grid = np.linspace(start, stop, 401)
        best = grid[np.argmin(free(WIDTH_MM, grid))]
        start, stop = best - 2 * (grid[1] - grid[0]), best + 2 * (grid[1] - grid[0])
    moved = float(free(WIDTH_MM, best)) + overlap_m
    return low, replace(high, face_m=high.face_m - moved)


@pytest.mark.parametrize("overlap_m", [1e-6, 1e-8, 1e-10, 1e-12])
def test_a_narrow_stretch_that_two_flanks_close_together_is_found(overlap_m):
    low, high = planted(overlap_m)
    assert not takes_whole_contact(PAIR, pit_rows([low]), NONE)
    assert not takes_whole_contact(PAIR, NONE, pit_rows([high]))
    assert takes_whole_contact(PAIR, pit_rows([low]), pit_rows([high]))
    (problem,) = damage_problems(PAIR, (low, high))
    assert "pinion tooth 0 together with gear tooth 30 that take the whole contact length" in problem.received


@pytest.mark.parametrize("gap_m", [1e-6, 1e-8, 1e-10, 1e-12])
def test_a_gap_that_stays_open_however_narrow_is_no_whole_loss(gap_m):
    low, high = planted(-gap_m)
    assert not takes_whole_contact(PAIR, pit_rows([low]), pit_rows([high]))
    assert damage_problems(PAIR, (low, high)) == ()


@pytest.mark.parametrize(("edge_mm", "whole"), [(10.5, True), (10.999, True), (11.001, False)])
def test_leaning_edges_close_the_face_only_where_they_reach_the_other_flank(edge_mm, whole):
    # The pinion's outline ends at 9 mm below and at 11 mm above; the gear's begins at a straight edge.
    at = {which: float(height_mm(which, PAIR.pitch_point_m)) for which in ("pinion", "gear")}
    low, high = at["pinion"] - 0.2, at["pinion"] + 0.2
    corners = tuple((h * 1e-3, w * 1e-3) for h, w in ((low, 0.0), (low, 9.0), (high, 11.0), (high, 0.0)))
    leaning = FlankSpall("pinion", 0, Polygon(corners), 0.2e-3)
    across = ((at["gear"] - 0.6) * 1e-3, (at["gear"] + 0.6) * 1e-3), (edge_mm * 1e-3, WIDTH_MM * 1e-3)
    straight = FlankSpall("gear", 0, rectangle(*across), 0.2e-3)
    assert takes_whole_contact(PAIR, pit_rows([leaning]), pit_rows([straight])) == whole


chains = st.lists(
    st.tuples(st.floats(-0.3, 0.3), st.floats(0.0, 20.0), st.floats(2.0, 8.0), st.floats(0.1, 0.5)),
    min_size=1,
    max_size=6,
)


@settings(max_examples=60, deadline=None)
@given(chains, chains)
def test_a_stretch_that_a_dense_search_finds_is_found(on_pinion, on_gear):
    at = {which: float(height_mm(which, PAIR.pitch_point_m)) for which in ("pinion", "gear")}
    flanks = [
        [pit(at[which] + up, face, a, b, 0.2, gear=which) for up, face, a, b in chain]
        for which, chain in (("pinion", on_pinion), ("gear", on_gear))
    ]
    dense = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 4001)
    found = takes_whole_contact(PAIR, *(pit_rows(flank) for flank in flanks))
    if np.max(covered(*flanks, dense)) >= WIDTH_MM / 1e3:
        assert found
    if found:
        assert np.max(covered(*flanks, dense)) > 0.9 * WIDTH_MM / 1e3


@pytest.mark.parametrize(("depths_mm", "floors"), [((0.4, 0.25), ("dish", "dish")), ((0.4, 0.25), ("dish", "flat"))])
@pytest.mark.parametrize("height_mm", [1.9, 1.97])
def test_two_pits_change_places_where_they_are_equally_deep(depths_mm, floors, height_mm):
    """Depth D √(1 - u² - v²) of a dish, D of a flat floor: written out again."""
    first, second = (
        pit(face_mm=face, a_mm=0.8, b_mm=0.3, depth_mm=depth, floor=floor)
        for face, depth, floor in zip((9.8, 10.2), depths_mm, floors, strict=True)
    )
    rows, x = np.vstack([pit_rows([first]), pit_rows([second])]), height_mm * 1e-3

    def depth(one, face_m):
        u, v = (x - one.height_m) / one.semi_axis_profile_m, (face_m - one.face_m) / one.semi_axis_face_m
        return one.depth_m * (1.0 if one.floor == "flat" else np.sqrt(1.0 - u * u - v * v))

    def is_inside(at):
        with np.errstate(invalid="ignore"):
            return depth(first, at) > 0.0 and depth(second, at) > 0.0

    found = [at for at in _depth_crossings(x, rows, 0, 1) if is_inside(at)]
    assert found
    for at in found:
        assert depth(first, at) == pytest.approx(depth(second, at), rel=1e-9)


@pytest.mark.parametrize("which", ["pinion", "gear"])
def test_two_thousand_pits_beside_each_other_take_the_sum_of_their_lengths(which: str) -> None:
    count, half_mm = 2_000, 0.002
    middle_mm = float(height_mm("pinion", PAIR.pitch_point_m))
    at = np.linspace(0.5, WIDTH_MM - 0.5, count)
    many = pit_rows([pit(middle_mm, float(face), half_mm, 0.3, 0.2) for face in at])
    heights = np.array([middle_mm / 1e3])
    sides = (many, NONE) if which == "pinion" else (NONE, many)
    found = lengths_covered(heights, sides[0], heights, sides[1], WIDTH_MM / 1e3)
    assert found == pytest.approx(2e-3 * half_mm * count, rel=1e-9)
