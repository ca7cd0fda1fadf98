"""Unions of pits: contact length, area, second moment and flank area, against closed forms and independent cuts."""

from __future__ import annotations

from dataclasses import replace
from math import acos, pi, sqrt

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from siggen.damage.flank_damage import pit_rows
from siggen.damage.heights import flank_heights
from siggen.damage.kinks import roots_between, section_kinks
from siggen.mesh.sections import contact_length_loss, largest_contact_length_loss, section_loss, union_area_m2
from tests.gears.builders import layers, pit, spur_gear
from tests.gears.stiffness.slow_quadrature import Outline, depth_integrals

WIDTH = 20e-3
GEAR = spur_gear()

pits = st.builds(
    pit,
    height_mm=st.floats(0.3, 5.2),
    face_mm=st.floats(0.0, 20.0),
    a_mm=st.floats(0.05, 1.5),
    b_mm=st.floats(0.05, 0.8),
    depth_mm=st.floats(0.05, 0.5),
    floor=st.sampled_from(["flat", "dish"]),
)
layouts = st.lists(pits, min_size=1, max_size=8)
HEIGHTS = np.linspace(0.05e-3, 5.4e-3, 143)


def lens(one, two, step):
    """Area common to two equal ellipses whose centres are `step` apart across the face (closed form)."""
    a, b = one.semi_axis_face_m, one.semi_axis_profile_m
    share = step / (2 * a)
    return 2 * a * b * (acos(share) - share * sqrt(1 - share**2)) if two is not None and share < 1 else 0.0


def test_one_pit_has_the_area_of_its_ellipse():
    assert union_area_m2(GEAR, [pit()], WIDTH, "axial") == pytest.approx(pi * 0.3e-3 * 0.2e-3, rel=1e-12)


@pytest.mark.parametrize("step", [0.01, 0.1, 0.35, 0.59, 0.7])
@pytest.mark.parametrize("floor", ["flat", "dish"])
def test_two_overlapping_pits_follow_inclusion_and_exclusion(step, floor):
    one = pit(face_mm=10.0, floor=floor)
    two = replace(one, face_m=10e-3 + step * 1e-3)
    exact = 2 * pi * 0.3e-3 * 0.2e-3 - lens(one, two, step * 1e-3)
    assert union_area_m2(GEAR, [one, two], WIDTH, "axial") == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("step", [0.05, 0.2, 0.39])
def test_two_pits_above_one_another_follow_inclusion_and_exclusion(step):
    one = pit()
    two = replace(one, height_m=one.height_m + step * 1e-3)
    share = step * 1e-3 / (2 * one.semi_axis_profile_m)
    common = 2 * one.semi_axis_face_m * one.semi_axis_profile_m * (acos(share) - share * sqrt(1 - share**2))
    exact = 2 * pi * 0.3e-3 * 0.2e-3 - common
    assert union_area_m2(GEAR, [one, two], WIDTH, "axial") == pytest.approx(exact, rel=1e-12)


def test_pits_are_clipped_to_the_face_and_to_the_flank():
    half = 0.5 * pi * 0.3e-3 * 0.2e-3
    assert union_area_m2(GEAR, [pit(face_mm=0.0)], WIDTH, "axial") == pytest.approx(half, rel=1e-12)
    assert union_area_m2(GEAR, [pit(face_mm=20.0)], WIDTH, "axial") == pytest.approx(half, rel=1e-12)
    tip = float(GEAR.height_m(GEAR.tip_roll_rad))
    at_tip = replace(pit(), height_m=tip)
    assert union_area_m2(GEAR, [at_tip], WIDTH, "axial") == pytest.approx(half, rel=1e-12)
    assert contact_length_loss([pit(face_mm=0.1)], WIDTH, 1.9e-3)[0] == pytest.approx(0.4e-3, rel=1e-13)


def test_area_on_the_flank_is_the_integral_of_face_length_over_arc():
    outline = Outline(GEAR)
    one = pit()
    ends = GEAR.roll_at_height(np.array([1.7e-3, 2.1e-3]))

    def element(roll):
        u = (outline.x(roll) - one.height_m) / one.semi_axis_profile_m
        return 2 * one.semi_axis_face_m * sqrt(max(1 - u * u, 0.0)) * outline.radius * roll

    slow = quad(element, *ends, epsabs=0, epsrel=1e-11, limit=400)[0]
    assert union_area_m2(GEAR, [one], WIDTH) == pytest.approx(slow, rel=1e-10)


@settings(max_examples=15, deadline=None)
@given(st.lists(pits, min_size=1, max_size=5), st.floats(0.3, 5.0))
def test_section_losses_equal_independent_integration_across_the_face(layout, height_mm):
    x = height_mm * 1e-3
    h = float(GEAR.half_thickness_m(GEAR.roll_at_height(x)))
    s0, s1, s2 = depth_integrals(layout, x, h, WIDTH)
    ours = section_loss(GEAR, layout, WIDTH, x)
    # The adaptive rule stops at 1e-10 of each piece.
    assert ours.area_m2[0] == pytest.approx(s0, rel=1e-9, abs=1e-20)
    inertia = s2 + s1**2 / (2 * h * WIDTH - s0)
    assert ours.inertia_m4[0] == pytest.approx(inertia, rel=1e-9, abs=1e-26)


def test_one_depth_gives_the_published_form_of_the_losses():
    x, depth = 1.95e-3, 0.4e-3
    h = float(GEAR.half_thickness_m(GEAR.roll_at_height(x)))
    ours = section_loss(GEAR, layers(1, 10), WIDTH, x)
    length = 10 * 2 * 0.3e-3 * sqrt(1 - ((x - 1.9e-3) / 0.2e-3) ** 2)
    area, lost = 2 * h * WIDTH, depth * length
    assert ours.contact_length_m[0] == pytest.approx(length, rel=1e-13)
    assert ours.area_m2[0] == pytest.approx(lost, rel=1e-13)
    published = length * depth**3 / 12 + area * lost * (h - depth / 2) ** 2 / (area - lost)
    assert ours.inertia_m4[0] == pytest.approx(published, rel=1e-12)


@settings(max_examples=30, deadline=None)
@given(layouts)
def test_largest_length_loss_is_a_tight_upper_bound(layout):
    heights = np.linspace(*flank_heights(GEAR), 20001)
    sampled = contact_length_loss(layout, WIDTH, heights).max()
    largest = largest_contact_length_loss(GEAR, layout, WIDTH)
    assert largest >= sampled - 1e-15
    # Square-root ends: between samples 0.27 um apart a pit of b = 0.05 mm changes by 2 a sqrt(2 * 0.27/50) at most.
    steepest = max(2 * p.semi_axis_face_m * sqrt(2 * 0.28e-6 / p.semi_axis_profile_m) for p in layout)
    assert largest <= sampled + steepest


@settings(max_examples=60, deadline=None)
@given(pits, pits)
def test_kinks_hold_every_crossing_of_two_outlines(one, two):
    rows = pit_rows([one, two])
    assume(len(rows) == 2)  # a pit inside a deeper one that it touches crosses nothing
    kinks = section_kinks(rows, WIDTH)
    t = np.linspace(0, 2 * pi, 4001)
    x = one.height_m + one.semi_axis_profile_m * np.cos(t)
    w = one.face_m + one.semi_axis_face_m * np.sin(t)
    f = ((x - two.height_m) / two.semi_axis_profile_m) ** 2 + ((w - two.face_m) / two.semi_axis_face_m) ** 2 - 1
    for i in np.flatnonzero(np.sign(f[1:]) != np.sign(f[:-1])):
        if max(abs(f[i]), abs(f[i + 1])) < 1e-9:
            continue  # the same outline twice: rounding, not a crossing
        low, high = sorted((x[i], x[i + 1]))
        # A crossing lies between two samples of the outline; near its highest point x turns between them.
        slack = 2e-6 * one.semi_axis_profile_m
        assert np.any((kinks >= low - slack) & (kinks <= high + slack))


def test_polynomial_roots_are_found_also_where_they_touch():
    poly = np.polynomial.polynomial.polyfromroots([-0.5, 0.25, 0.25, 0.75])
    found = roots_between(poly, -1.0, 1.0, 1e-12)
    for root in (-0.5, 0.25, 0.75):
        # A double root is known to the square root of rounding.
        assert np.min(np.abs(found - root)) < 1e-7
    assert roots_between(np.array([1.0, 0.0, 1.0]), -1.0, 1.0, 0.0).size == 0


@settings(max_examples=100, deadline=None)
@given(st.lists(st.floats(-0.99, 0.99), min_size=4, max_size=4, unique_by=lambda v: round(v, 2)))
def test_separate_roots_of_a_quartic_are_exact(roots):
    found = roots_between(np.polynomial.polynomial.polyfromroots(roots), -1.0, 1.0, 0.0)
    # Roots 0.005 apart: condition number up to (1/0.005)^3.
    assert found == pytest.approx(sorted(roots), abs=1e-8)


def test_a_dish_cut_beside_its_edge_keeps_all_digits():
    layout = [pit(1.0, 0.0, 1.0, 0.5, 0.5), pit(1.0, 1.0, 1.0, 0.5, 0.5, "dish")]
    shallower = pit(1.0, 1.0, 1.0, 0.5, 0.25, "dish")
    one, two = (section_loss(GEAR, p, WIDTH, HEIGHTS) for p in (layout, [*layout, shallower]))
    # The shallower dish is hidden but cuts the face at the deeper one's edges: only rounding may differ.
    assert two.area_m2 == pytest.approx(one.area_m2, rel=1e-14)
    assert two.inertia_m4 == pytest.approx(one.inertia_m4, rel=1e-14)
