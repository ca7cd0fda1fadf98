"""Spalls of every outline: closed forms, unions, invariances and an independent quadrature."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from siggen.gears.damage.flank_damage import damage_problems, pit_rows
from siggen.gears.damage.heights import profile_arc_m
from siggen.gears.damage.kinks import section_kinks
from siggen.gears.damage.outlines import Ellipse, Polygon, rectangle
from siggen.gears.damage.spall import Spall
from siggen.gears.stiffness.beams import involute_integrals
from siggen.gears.stiffness.compliance import section_breaks, tooth_compliance
from siggen.gears.stiffness.mesh_stiffness import pair_stiffness
from siggen.gears.stiffness.pitted_beams import pit_integrals, pit_sums
from siggen.gears.stiffness.sections import (
    contact_length_loss,
    largest_contact_length_loss,
    section_loss,
    union_area_m2,
)
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.gears.builders import pair_18_47, pit
from tests.gears.stiffness.slow_quadrature import Outline, beam_compliances, depth_integrals
from tests.gears.stiffness.test_sections import HEIGHTS

PAIR = pair_18_47()
GEAR, WIDTH = PAIR.pinion, PAIR.face_width_m
OPTIONS = StiffnessOptions()
S = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 173)
MM = 1e-3
STAR = tuple((h * MM, w * MM) for h, w in ((1.0, 4.0), (2.6, 6.0), (1.6, 8.0), (3.1, 12.0), (1.2, 10.0), (0.7, 7.0)))


def box(low=1.5, high=2.5, left=6.0, right=11.0, depth=0.2, floor="flat"):
    return Spall("pinion", 0, rectangle((low * MM, high * MM), (left * MM, right * MM)), depth * MM, floor)


def v(low=1.2, high=2.8, face=9.0, lower=0.0, upper=6.0, depth=0.25, floor="flat"):
    corners = [(low, face - lower / 2), (low, face + lower / 2), (high, face + upper / 2), (high, face - upper / 2)]
    outline = Polygon(tuple(dict.fromkeys((h * MM, w * MM) for h, w in corners)))
    return Spall("pinion", 0, outline, depth * MM, floor)


def star(depth=0.15, floor="flat"):
    return Spall("pinion", 0, Polygon(STAR), depth * MM, floor)


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


@pytest.mark.parametrize(("lower", "upper"), [(0.0, 6.0), (1.0, 6.0), (6.0, 2.0)])
def test_a_v_widens_linearly_along_the_profile(lower, upper):
    one = v(lower=lower, upper=upper)
    share = np.array([0.01, 0.25, 0.6, 0.99])
    width = (lower + share * (upper - lower)) * MM
    assert contact_length_loss([one], WIDTH, (1.2 + 1.6 * share) * MM) == pytest.approx(width, rel=1e-12)
    assert union_area_m2(GEAR, [one], WIDTH, "axial") == pytest.approx(0.5 * (lower + upper) * 1.6e-6, rel=1e-13)


def test_an_l_is_the_union_of_two_rectangles():
    corners = ((1, 4), (1, 12), (1.5, 12), (1.5, 7), (3, 7), (3, 4))
    one = Spall("pinion", 0, Polygon(tuple((h * MM, w * MM) for h, w in corners)), 0.2 * MM)
    two = [box(1, 1.5, 4, 12), box(1, 3, 4, 7)]
    assert union_area_m2(GEAR, [one], WIDTH) == pytest.approx(union_area_m2(GEAR, two, WIDTH), rel=1e-12)
    assert pair_stiffness(PAIR, S, OPTIONS, [one]) == pytest.approx(pair_stiffness(PAIR, S, OPTIONS, two), rel=1e-13)


def test_a_polygon_that_approximates_an_ellipse_converges_to_it():
    ellipse = Spall("pinion", 0, Ellipse(2.0 * MM, 9.0 * MM, 3.0 * MM, 0.8 * MM), 0.2 * MM)
    exact = pair_stiffness(PAIR, S, OPTIONS, [ellipse])
    assert np.array_equal(exact, pair_stiffness(PAIR, S, OPTIONS, [pit(2.0, 9.0, 3.0, 0.8, 0.2)]))

    def error(count):
        angles = 2 * pi * (np.arange(count) + 0.5) / count
        corners = tuple((2e-3 + 0.8e-3 * cos(t), 9e-3 + 3e-3 * sin(t)) for t in angles)
        inscribed = replace(ellipse, outline=Polygon(corners))
        area = union_area_m2(GEAR, [inscribed], WIDTH, "axial")
        assert area == pytest.approx(0.5 * count * sin(2 * pi / count) * 3e-3 * 0.8e-3, rel=1e-12)
        return np.sqrt(np.mean((pair_stiffness(PAIR, S, OPTIONS, [inscribed]) / exact - 1) ** 2))

    # The inscribed area lacks (2 pi/n)^2/6 of the ellipse's: a quarter with twice the corners, about.
    assert error(160) < 0.35 * error(80) < 1e-4


@settings(max_examples=25, deadline=None)
@given(mixtures, st.randoms())
def test_order_and_repetition_change_no_bit(layout, random):
    mixed = [*layout, *layout[:2]]
    random.shuffle(mixed)
    assert np.array_equal(contact_length_loss(layout, WIDTH, HEIGHTS), contact_length_loss(mixed, WIDTH, HEIGHTS))
    assert union_area_m2(GEAR, layout, WIDTH) == union_area_m2(GEAR, mixed, WIDTH)
    roll = np.linspace(0.3, GEAR.tip_roll_rad, 60)
    one, two = (tooth_compliance(PAIR, "pinion", roll, OPTIONS, p).total for p in (layout, mixed))
    assert np.array_equal(one, two)


@settings(max_examples=25, deadline=None)
@given(boxes, mixtures, st.floats(0.05, 0.95), st.booleans())
def test_a_rectangle_in_two_abutting_parts_is_the_rectangle(one, others, share, across):
    (low, high), (left, right) = one.outline.height_range_m, one.outline.face_range_m
    if across:
        cut = left + share * (right - left)
        halves = [rectangle((low, high), (left, cut)), rectangle((low, high), (cut, right))]
    else:
        cut = low + share * (high - low)
        one = replace(one, floor="flat")  # a dish belongs to its whole length
        halves = [rectangle((low, cut), (left, right)), rectangle((cut, high), (left, right))]
    parts = [replace(one, outline=half) for half in halves]
    whole, split = ([*others, one], [*others, *parts])
    # Sums of millimetres in another order.
    assert contact_length_loss(whole, WIDTH, HEIGHTS) == pytest.approx(
        contact_length_loss(split, WIDTH, HEIGHTS), rel=1e-12, abs=1e-17
    )
    assert union_area_m2(GEAR, whole, WIDTH) == pytest.approx(union_area_m2(GEAR, split, WIDTH), rel=1e-12)
    roll = np.linspace(0.3, GEAR.tip_roll_rad, 40)
    one_way, other_way = (tooth_compliance(PAIR, "pinion", roll, OPTIONS, p).total for p in (whole, split))
    # Another cut splits the quadrature elsewhere: 1e-8 of what damage adds.
    assert one_way == pytest.approx(other_way, rel=1e-10)


@settings(max_examples=25, deadline=None)
@given(mixtures, boxes | vs | dents)
def test_a_further_damage_never_raises_the_stiffness(layout, further):
    roll = np.linspace(0.3, GEAR.tip_roll_rad, 40)
    before, after = (tooth_compliance(PAIR, "pinion", roll, OPTIONS, p).total for p in (layout, [*layout, further]))
    assert np.all(after >= before * (1 - 1e-11))
    lost = [contact_length_loss(p, WIDTH, HEIGHTS) for p in (layout, [*layout, further])]
    assert np.all(lost[1] >= lost[0] - 1e-17)


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


def test_where_a_dish_is_as_deep_as_a_flat_floor_sections_have_kinks():
    # 0.4 sqrt(1 - r^2) = 0.2 on the ellipse r = sqrt(3/4); it leaves the rectangle through both of its sides.
    dish, flat = pit(2.0, 9.0, 2.0, 0.8, 0.4, "dish"), box(1.6, 2.6, 7.5, 10.5, 0.2)
    along = 0.8 * sqrt(0.75) * sqrt(1.0 - (1.5 / (2.0 * sqrt(0.75))) ** 2)
    found = section_kinks(pit_rows((dish, flat)), WIDTH) / MM
    for height in (2.0 - along, 2.0 + along):
        assert np.abs(found - height).min() < 1e-9
    # inside a wide rectangle it ends by itself, whichever of them begins the flank
    for right in (12.8, 13.2):
        wide = section_kinks(pit_rows((dish, box(0.9, 3.1, 5.0, right, 0.2))), WIDTH) / MM
        for height in (2.0 - 0.8 * sqrt(0.75), 2.0 + 0.8 * sqrt(0.75)):
            assert np.abs(wide - height).min() < 1e-9


def test_spalls_are_clipped_to_face_and_flank():
    tip = float(GEAR.height_m(GEAR.tip_roll_rad)) / MM
    beyond, inside = box(4.0, 9.0, -3.0, 2.0), box(4.0, tip, 0.0, 2.0)
    assert union_area_m2(GEAR, [beyond], WIDTH) == pytest.approx(union_area_m2(GEAR, [inside], WIDTH), rel=1e-13)
    assert largest_contact_length_loss(GEAR, [beyond], WIDTH) == pytest.approx(2e-3, rel=1e-14)
    assert np.array_equal(
        pair_stiffness(PAIR, S, OPTIONS, [beyond]), pair_stiffness(PAIR, S, OPTIONS, [box(4.0, 9.0, 0.0, 2.0)])
    )


def test_what_a_deeper_damage_hides_changes_no_bit():
    inside = [box(1.6, 2.4, 7.0, 9.0, 0.1), v(1.6, 2.4, 8.0, 0.5, 1.0, 0.2), pit(2.0, 8.0, 0.5, 0.3, 0.2, "dish")]
    assert all(box().hides(p) for p in inside)
    assert not any(p.hides(box()) for p in inside)
    assert np.array_equal(pair_stiffness(PAIR, S, OPTIONS, [box(), *inside]), pair_stiffness(PAIR, S, OPTIONS, [box()]))


def ring(scale: float, shift_mm: float = 0.0, corners: int = 7, depth: float = 0.2):
    """Return a spall of many corners about one middle: several trapezoids, none of which holds another ring."""
    angle = 2.0 * pi * np.arange(corners) / corners + 0.3
    heights, faces = 2.5 + 0.8 * scale * np.sin(angle), 9.0 + shift_mm + 4.0 * scale * np.cos(angle)
    return Spall(
        "pinion", 0, Polygon(tuple(zip((heights * MM).tolist(), (faces * MM).tolist(), strict=True))), depth * MM
    )


def test_a_polygon_of_many_corners_hides_a_smaller_one_and_no_bit_changes():
    large, small = ring(1.0), ring(0.8, depth=0.1)
    assert large.hides(small)
    assert not small.hides(large)
    assert not ring(1.0, depth=0.05).hides(small)
    assert np.array_equal(pair_stiffness(PAIR, S, OPTIONS, [large, small]), pair_stiffness(PAIR, S, OPTIONS, [large]))


@settings(max_examples=60, deadline=None)
@given(st.floats(0.3, 1.1), st.floats(-3.0, 3.0), st.integers(3, 9), st.integers(3, 9))
def test_what_a_polygon_hides_adds_nothing_to_the_union(scale: float, shift: float, corners: int, others: int):
    large, small = ring(1.0, corners=corners), ring(scale, shift, others)
    grown = union_area_m2(GEAR, [large, small], WIDTH) / union_area_m2(GEAR, [large], WIDTH) - 1.0
    if large.hides(small):
        assert grown == pytest.approx(0.0, abs=1e-12)
    else:
        assert grown > 0.0


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
    problems = damage_problems(PAIR, (pit(), Spall("pinion", 0, outline, 1e-4)))
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


def test_crossings_under_crowded_pits_are_no_kinks():
    rng = np.random.default_rng(3)
    crowd = [pit(2.5 + 0.02 * (2 * rng.random() - 1), 20 * rng.random(), 0.4, 0.3, 0.2, "flat") for _ in range(400)]
    kinks = section_kinks(pit_rows(crowd), WIDTH)
    # Every uncovered crossing lies on the union's edge, which has at most two arcs per pit on either side.
    assert kinks.size < 4 * 400
