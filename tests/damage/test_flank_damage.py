"""What makes a damage impossible, named with pit, value and limit."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.damage.flank_damage import damage_problems
from siggen.damage.heights import flank_heights
from siggen.mesh.mesh_stiffness import StiffnessOptions, pair_stiffness
from tests.gears.builders import layers, pair_18_47, pit
from tests.gears.stiffness.test_sections import pits

PAIR = pair_18_47()


def test_possible_damage_has_no_problem_even_where_pits_cross_the_face_or_the_tip():
    tip = flank_heights(PAIR.pinion)[1] * 1e3
    assert damage_problems(PAIR, ()) == ()
    assert damage_problems(PAIR, layers(3, 10)) == ()
    assert damage_problems(PAIR, (pit(face_mm=0.0), pit(face_mm=20.0), pit(tip - 0.01, depth_mm=0.3))) == ()


@pytest.mark.parametrize(
    ("bad", "received", "allowed"),
    [
        ({"height_mm": 5.6}, "height 5.6 mm", "5.53372 mm"),
        ({"height_mm": 0.001}, "height 0.001 mm", "involute flank"),
        ({"height_mm": float("nan")}, "height_m nan", "finite"),
        ({"face_mm": 20.1}, "face 20.1 mm", "0 to 20 mm"),
        ({"a_mm": 0.0}, "semi_axis_face 0 mm", "above 0"),
        ({"b_mm": -0.1}, "semi_axis_profile -0.1 mm", "above 0"),
        ({"depth_mm": float("inf")}, "depth inf mm", "finite"),
        ({"depth_mm": 2.8}, "depth 2.8 mm", "below the half tooth thickness there"),
        ({"floor": "cone"}, "floor 'cone'", "flat, dish"),
        ({"tooth": 18}, "tooth 18", "0 to 17"),
        ({"tooth": -1}, "tooth -1", "0 to 17"),
    ],
    ids=str,
)
def test_impossible_pits_are_named_with_index_value_and_limit(bad, received, allowed):
    problems = damage_problems(PAIR, (pit(), pit(**bad)))
    assert [problem.index for problem in problems] == [1]
    assert problems[0].received == received
    assert allowed in problems[0].allowed
    assert str(problems[0]).startswith("pit 1: received ")


def test_a_whole_contact_length_must_not_be_lost_on_one_flank():
    chain = tuple(pit(1.9, w, 1.2, 0.3, depth_mm=0.3) for w in range(0, 21, 2))
    problems = damage_problems(PAIR, (pit(tooth=3), *chain))
    assert [problem.index for problem in problems] == [1]
    assert "whole contact length" in problems[0].received
    assert damage_problems(PAIR, chain[1:]) == ()


def test_a_whole_contact_length_must_not_be_lost_by_two_mating_flanks_together():
    s = PAIR.pitch_point_m
    heights = (
        float(PAIR.pinion.height_m(s / PAIR.pinion.base_radius_m)) * 1e3,
        float(PAIR.gear.height_m((PAIR.line_of_action_m - s) / PAIR.gear.base_radius_m)) * 1e3,
    )
    one = pit(heights[0], 0.0, 12.0, 0.3, depth_mm=0.2)
    two = replace(pit(heights[1], 20.0, 12.0, 0.3, depth_mm=0.2), gear="gear", tooth=30)
    assert damage_problems(PAIR, (one,)) == ()
    assert damage_problems(PAIR, (two,)) == ()
    problems = damage_problems(PAIR, (one, two))
    assert [problem.index for problem in problems] == [0]
    assert "together with gear tooth 30" in problems[0].received


@settings(max_examples=60, deadline=None)
@given(st.lists(pits, min_size=1, max_size=10), st.sampled_from(["pinion", "gear"]))
def test_damage_without_problems_has_a_positive_stiffness_everywhere(layout, which):
    damage = tuple(replace(p, gear=which) for p in layout)
    if damage_problems(PAIR, damage):
        return
    start, end = PAIR.contact_start_m, PAIR.contact_end_m
    s = [start + (end - start) * i / 40 for i in range(41)]
    found = pair_stiffness(PAIR, s, StiffnessOptions(), **{f"{which}_pits": damage})
    assert (found > 0).all()
