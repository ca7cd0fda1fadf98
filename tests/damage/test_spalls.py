"""Spalls of every outline: closed forms, unions, invariances and an independent quadrature."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from siggen.damage.flank_damage import damage_problems, pit_rows
from siggen.damage.heights import profile_arc_m
from siggen.damage.kinks import section_kinks
from siggen.damage.outlines import Polygon, rectangle
from siggen.damage.spalls import FlankSpall
from siggen.mesh.beams import involute_integrals
from siggen.mesh.mesh_stiffness import pair_stiffness
from siggen.mesh.pitted_beams import pit_integrals, pit_sums
from siggen.mesh.sections import largest_contact_length_loss, section_loss, union_area_m2
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import section_breaks, tooth_compliance
from tests.gears.builders import pair_18_47, pit
from tests.gears.stiffness.slow_quadrature import Outline, beam_compliances, depth_integrals

PAIR = pair_18_47()
GEAR, WIDTH = PAIR.pinion, PAIR.face_width_m
OPTIONS = StiffnessOptions()
S = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 173)
MM = 1e-3
STAR = tuple((h * MM, w * MM) for h, w in ((1.0, 4.0), (2.6, 6.0), (1.6, 8.0), (3.1, 12.0), (1.2, 10.0), (0.7, 7.0)))


def box(low=1.5, high=2.5, left=6.0, right=11.0, depth=0.2, floor="flat"):
    return FlankSpall("pinion", 0, rectangle((low * MM, high * MM), (left * MM, right * MM)), depth * MM, floor)


def v(low=1.2, high=2.8, face=9.0, lower=0.0, upper=6.0, depth=0.25, floor="flat"):
    corners = [(low, face - lower / 2), (low, face + lower / 2), (high, face + upper / 2), (high, face - upper / 2)]
    outline = Polygon(tuple(dict.fromkeys((h * MM, w * MM) for h, w in corners)))
    return FlankSpall("pinion", 0, outline, depth * MM, floor)


def star(depth=0.15, floor="flat"):
    return FlankSpall("pinion", 0, Polygon(STAR), depth * MM, floor)


floors = st.sampled_from(["flat", "dish"])
boxes = st.builds(
    lambda low, length, left, across, depth, floor: box(low, low + length, left, left + across, depth, floor),
    st.floats(0.3, 4.0),
    st.floats(0.1, 2.0),
    st.floats(-2.0, 18.0),
    st.floats(0.1, 9.0),
    st.floats(0.05, 0.4),
    floors,
)
vs = st.builds(
    lambda low, length, face, lower, upper, depth, floor: v(low, low + length, face, lower, upper, depth, floor),
    st.floats(0.3, 4.0),
    st.floats(0.1, 2.0),
    st.floats(0.0, 20.0),
    st.floats(0.0, 6.0),
    st.floats(0.1, 6.0),
    st.floats(0.05, 0.4),
    floors,
)
dents = st.builds(
    pit,
    height_mm=st.floats(0.5, 4.5),
    face_mm=st.floats(0.0, 20.0),
    a_mm=st.floats(0.1, 2.0),
    b_mm=st.floats(0.1, 0.8),
    depth_mm=st.floats(0.05, 0.4),
    floor=floors,
)
mixtures = st.lists(boxes | vs | dents | floors.map(lambda f: star(floor=f)), min_size=1, max_size=5)


def test_a_rectangle_loses_its_width_its_area_and_the_published_inertia():
    one, x = box(), 2.1e-3
    h = float(GEAR.half_thickness_m(GEAR.roll_at_height(x)))
    loss = section_loss(GEAR, [one], WIDTH, [x, 1.4e-3, 2.6e-3])
    assert loss.contact_length_m == pytest.approx([5e-3, 0.0, 0.0], rel=1e-14)
    area, lost, depth = 2 * h * WIDTH, 5e-3 * 0.2e-3, 0.2e-3
    assert loss.area_m2[0] == pytest.approx(lost, rel=1e-14)
    published = 5e-3 * depth**3 / 12 + area * lost * (h - depth / 2) ** 2 / (area - lost)
    assert loss.inertia_m4 == pytest.approx([published, 0.0, 0.0], rel=1e-12)
    assert union_area_m2(GEAR, [one], WIDTH, "axial") == pytest.approx(5e-6, rel=1e-13)
    assert union_area_m2(GEAR, [one], WIDTH) == pytest.approx(5e-3 * profile_arc_m(GEAR, one.outline), rel=1e-12)


def test_a_dished_rectangle_is_half_an_elliptic_cylinder():
    one, x = box(floor="dish"), 2.3e-3
    depth = 0.2e-3 * sqrt(1 - 0.6**2)
    assert section_loss(GEAR, [one], WIDTH, x).area_m2[0] == pytest.approx(5e-3 * depth, rel=1e-12)


@settings(max_examples=12, deadline=None)
@given(mixtures, st.floats(0.4, 5.0))
@example([pit(2.0, 9.0, 2.0, 0.8, 0.4, "dish"), box(1.6, 2.6, 7.5, 10.5, 0.2)], 2.1)  # deeper in its middle alone
@example([box(1.6, 2.6, 7.5, 10.5, 0.2), pit(2.0, 9.0, 2.0, 0.8, 0.4, "dish")], 2.1)
@example([pit(2.0, 8.0, 1.5, 0.5, 0.3, "dish"), pit(2.1, 9.5, 1.5, 0.5, 0.3, "dish")], 2.0)  # they cross once
def test_sections_equal_independent_integration_across_the_face(layout, height_mm):
    x = height_mm * MM
    # At an end itself, rounding decides on which side a height lies.
    assume(all(abs(x - end) > 1e-9 for p in layout for end in p.outline.height_range_m))
    h = float(GEAR.half_thickness_m(GEAR.roll_at_height(x)))
    s0, s1, s2 = depth_integrals(layout, x, h, WIDTH)
    ours = section_loss(GEAR, layout, WIDTH, x)
    assert ours.area_m2[0] == pytest.approx(s0, rel=1e-9, abs=1e-18)
    assert ours.inertia_m4[0] == pytest.approx(s2 + s1**2 / (2 * h * WIDTH - s0), rel=1e-9, abs=1e-24)


@pytest.mark.parametrize(
    "layout",
    [
        [star()],
        [star(floor="dish"), v(floor="dish")],
        [box(), v(), pit(1.8, 8.0, 1.5, 0.5, 0.3)],
        [box(1.0, 3.0, -1.0, 4.0), v(floor="dish"), box(1.6, 2.2, 2.0, 12.0, 0.1)],
    ],
    ids=["star", "dishes", "flat", "mixed"],
)
def test_compliances_equal_slow_quadrature(layout):
    start, roll = float(GEAR.roll_at_height(0.4e-3)), 0.5
    outline = Outline(GEAR)
    kinks = GEAR.roll_at_height(section_kinks(pit_rows(layout), WIDTH))
    points = [float(k) for k in kinks]
    slow = beam_compliances(PAIR, GEAR, roll, start, layout, points) - beam_compliances(PAIR, GEAR, roll, start)
    healthy, damaged = (tooth_compliance(PAIR, "pinion", roll, OPTIONS, p) for p in ((), layout))
    ours = [getattr(damaged, k)[0] - getattr(healthy, k)[0] for k in ("bending", "shear", "axial")]
    assert outline.x(start) < min(p.outline.height_range_m[0] for p in layout)
    assert ours == pytest.approx(slow, rel=1e-8)


@settings(max_examples=20, deadline=None)
@given(mixtures)
def test_kinks_leave_smooth_pieces(layout):
    # Halving every piece changes little only if no piece has a kink inside, none that was taken for hidden either.
    rows = pit_rows(layout)
    breaks = section_breaks(GEAR, rows, WIDTH, (GEAR.involute_start_roll_rad, GEAR.tip_roll_rad))
    fine = np.unique(np.concatenate([breaks, 0.5 * (breaks[1:] + breaks[:-1])]))
    roll, base, half = np.array([GEAR.tip_roll_rad]), GEAR.base_radius_m, GEAR.base_half_angle_rad
    flank = (rows, base, half, WIDTH)
    coarse, halved = (pit_integrals(roll, cuts, *pit_sums(cuts, *flank), *flank) for cuts in (breaks, fine))
    # Thin pieces take few nodes. Of 25,000 random layouts the worst erred by 3.1e-7 of the tooth's own integral, which
    # is what the stiffness feels, and by 3.9e-5 of what the damage adds.
    own = involute_integrals(roll, GEAR.involute_start_roll_rad, base, half, WIDTH)
    assert np.all(np.abs(coarse - halved) <= 1e-6 * own)
    assert coarse == pytest.approx(halved, rel=1e-4)


def test_spalls_are_clipped_to_face_and_flank():
    tip = float(GEAR.height_m(GEAR.tip_roll_rad)) / MM
    beyond, inside = box(4.0, 9.0, -3.0, 2.0), box(4.0, tip, 0.0, 2.0)
    assert union_area_m2(GEAR, [beyond], WIDTH) == pytest.approx(union_area_m2(GEAR, [inside], WIDTH), rel=1e-13)
    assert largest_contact_length_loss(GEAR, [beyond], WIDTH) == pytest.approx(2e-3, rel=1e-14)
    assert np.array_equal(
        pair_stiffness(PAIR, S, OPTIONS, [beyond]), pair_stiffness(PAIR, S, OPTIONS, [box(4.0, 9.0, 0.0, 2.0)])
    )


@pytest.mark.parametrize(
    ("outline", "received"),
    [
        (Polygon(((1e-3, 0.0), (2e-3, 1e-3))), "2 vertices"),
        (Polygon(((1e-3, 1e-3), (2e-3, 5e-3), (2e-3, 1e-3), (1e-3, 5e-3))), "edges 0 and 2 meet"),
        (Polygon(((1e-3, 1e-3), (2e-3, 1e-3), (3e-3, 1e-3))), "meet"),
        (Polygon(((1e-3, 1e-3), (1e-3, 1e-3), (2e-3, 5e-3))), "edges 0 and 0 meet"),
        (Polygon(((1e-3, float("nan")), (2e-3, 5e-3), (2e-3, 1e-3))), "nan"),
        (rectangle((2e-3, 2e-3), (1e-3, 2e-3)), "meet"),
    ],
    ids=str,
)
def test_impossible_polygons_are_named(outline, received):
    problems = damage_problems(PAIR, (pit(), FlankSpall("pinion", 0, outline, 1e-4)))
    assert [(problem.index, problem.name) for problem in problems] == [(1, "vertices_m")]
    assert received in problems[0].received
    assert str(problems[0]).startswith("spall 1: ")


def test_impossible_places_and_depths_of_spalls_are_named():
    for bad, name in (
        (box(5.4, 6.4), "height_m"),
        (box(left=18.0, right=23.0), "face_m"),
        (box(depth=2.8), "depth_m"),
        (replace(box(), floor="cone"), "floor"),
        (replace(box(), tooth=18), "tooth"),
        (box(left=0.0, right=20.0), "contact"),
    ):
        assert [problem.name for problem in damage_problems(PAIR, (bad,))] == [name]
