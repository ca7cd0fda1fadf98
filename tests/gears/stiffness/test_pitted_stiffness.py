"""Stiffness of damaged teeth: tabulated cases, independent integrals, and what must hold exactly."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from siggen.gears.damage.flank_damage import damage_problems, pit_rows
from siggen.gears.damage.kinks import section_kinks
from siggen.gears.stiffness.compliance import tooth_compliance, tooth_compliances
from siggen.gears.stiffness.mesh_stiffness import contact_compliance, mesh_stiffness, pair_stiffness
from siggen.gears.stiffness.sections import contact_length_loss, section_loss
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47, pit
from tests.gears.stiffness.slow_quadrature import beam_compliances
from tests.gears.stiffness.test_sections import layouts, pits

BASE = StiffnessOptions("base_circle")
BASE_FREE = StiffnessOptions("base_circle", "none")
TROCHOID = StiffnessOptions("rack_trochoid")
PAIR = pair_18_47()
ENTRY = PAIR.contact_start_m / PAIR.pinion.base_radius_m
LAST = (PAIR.contact_end_m - PAIR.contact_start_m) / PAIR.pinion.base_radius_m


def fine_angles(damage):
    """Pinion angles over the faulty pair's contact, with all kinks and pit centres."""
    rows = pit_rows(damage)
    heights = np.concatenate([section_kinks(rows, PAIR.face_width_m), rows[:, 0]])
    marks = PAIR.pinion.roll_at_height(heights) - ENTRY
    grid = np.union1d(np.linspace(0, LAST, 6001), marks)
    return grid[(grid >= 0) & (grid <= LAST)]


def loss(damage, options=BASE):
    angle = fine_angles(damage)
    healthy = mesh_stiffness(PAIR, angle, options)
    return angle, healthy - mesh_stiffness(PAIR, angle, options, damage), healthy


def extent(damage):
    """First and last pinion angle [deg] with contact on pits."""
    ends = [p.height_m + side * p.semi_axis_profile_m for p in damage for side in (-1, 1)]
    return tuple(degrees(float(PAIR.pinion.roll_at_height(x)) - ENTRY) for x in (min(ends), max(ends)))


@pytest.mark.parametrize(
    ("damage", "options", "peak", "relative", "length", "contact"),
    [
        (layers(1, 5), BASE, 2.607e6, 1.13, 3.0, (16.110, 18.333)),
        (layers(1, 10), BASE, 6.226e6, 2.71, 6.0, (16.110, 18.333)),
        (layers(3, 10), BASE, 6.292e6, 2.73, 6.0, (16.110, 22.266)),
        (layers(3, 10, 0.5, 0.3), BASE, 5.064e6, 2.20, 5.1, (16.110, 21.333)),
        (layers(1, 10), BASE_FREE, 7.36e7, 9.00, 6.0, (16.110, 18.333)),
    ],
    ids=["slight", "moderate", "severe", "overlapped", "moderate without foundation"],
)
def test_tabulated_cases_are_met_to_the_printed_digits(damage, options, peak, relative, length, contact):
    _, lost, healthy = loss(damage, options)
    digit = 10 ** (np.floor(np.log10(peak)) - (2 if peak == 7.36e7 else 3))
    assert lost.max() == pytest.approx(peak, abs=0.51 * digit)
    assert 100 * (lost / healthy).max() == pytest.approx(relative, abs=0.0051)
    heights = np.linspace(1e-3, 5e-3, 8001)
    # Sampled within 0.5 um of the peak, where the length is flat to (0.5/200)^2/2.
    assert contact_length_loss(damage, 20e-3, heights).max() * 1e3 == pytest.approx(length, rel=1e-5)
    assert extent(damage) == pytest.approx(contact, abs=5.1e-4)


@pytest.mark.parametrize(
    ("sizes", "peak"),
    [
        ({"a_mm": 0.2}, 3.675e6),
        ({"a_mm": 0.4}, 9.536e6),
        ({"a_mm": 0.5}, 14.005e6),
        ({"b_mm": 0.1}, 6.213e6),
        ({"b_mm": 0.3}, 6.238e6),
        ({"b_mm": 0.4}, 6.250e6),
        ({"height_mm": 1.0}, 5.53e6),
        ({"height_mm": 2.8}, 6.09e6),
        ({"height_mm": 3.7}, 5.45e6),
        ({"height_mm": 4.6}, 4.55e6),
        ({"depth_mm": 0.1}, 6.21e6),
        ({"depth_mm": 0.8}, 6.25e6),
    ],
    ids=str,
)
def test_tabulated_sweeps_around_moderate_are_met_to_the_printed_digits(sizes, peak):
    _, lost, _ = loss(layers(1, 10, **sizes))
    # b = 0.4 mm gives 6.2505e6, printed 6.250: half a unit of the printed digit and a little.
    fine = "a_mm" in sizes or "b_mm" in sizes
    assert lost.max() == pytest.approx(peak, abs=0.55e3 if fine else 0.51e4)


@pytest.mark.parametrize(
    ("damage", "tail"),
    [(layers(1, 5), (2.2e4, 4.1e4)), (layers(1, 10), (4.5e4, 8.5e4)), (layers(3, 10), (1.4e5, 2.4e5))],
)
def test_a_tail_of_beam_losses_remains_above_the_pits(damage, tail):
    angle, lost, _ = loss(damage)
    beyond = lost[angle > radians(extent(damage)[1] + 1e-6)]
    digit = 10 ** np.floor(np.log10(tail[0]))
    assert (beyond.min(), beyond.max()) == pytest.approx(tail, abs=0.055 * digit)


def test_depth_scales_the_tail_and_hardly_the_peak():
    maxima, peaks = [], []
    for depth in (0.1, 0.8):
        damage = layers(1, 10, depth_mm=depth)
        angle, lost, _ = loss(damage)
        maxima.append(lost[angle > radians(extent(damage)[1])].max())
        peaks.append(lost.max())
    assert maxima == pytest.approx([2.2e4, 1.6e5], rel=0.025)
    assert peaks[1] / peaks[0] - 1 < 0.01


def test_dish_floors_keep_the_contact_lower_the_tail_and_the_peak_by_0_14_percent():
    flat, dish = layers(1, 10), layers(1, 10, floor="dish")
    s = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 301)
    assert np.array_equal(contact_compliance(PAIR, s, flat), contact_compliance(PAIR, s, dish))
    (angle, lost, _), (_, dished, _) = loss(flat), loss(dish)
    assert dished.max() / lost.max() - 1 == pytest.approx(-0.0014, abs=5.1e-5)
    beyond = angle > radians(extent(flat)[1])
    assert np.all(dished[beyond] < lost[beyond])


@pytest.mark.parametrize(
    "layout",
    [
        [pit(face_mm=4.0, a_mm=1.2, b_mm=0.5), pit(2.1, 5.0, 0.9, 0.3, 0.25), pit(2.4, 4.5, 0.5, 0.7, 0.5)],
        [pit(0.25, 0.3, 0.9, 0.4), pit(3.0, 19.8, 0.7, 0.6, 0.3), pit(3.2, 19.0, 0.7, 0.6, 0.2)],
    ],
    ids=["overlapping", "clipped by face and base circle"],
)
def test_beam_losses_equal_adaptive_quadrature(layout):
    gear = PAIR.pinion
    rolls = [0.3, 0.45, 0.6]
    ours = tooth_compliance(PAIR, "pinion", rolls, BASE_FREE, layout)
    healthy = tooth_compliance(PAIR, "pinion", rolls, BASE_FREE)
    kinks = section_kinks(pit_rows(layout), PAIR.face_width_m)
    points = gear.roll_at_height(kinks[(kinks > 0) & (kinks < 5e-3)])
    for i, roll in enumerate(rolls):
        slow = beam_compliances(PAIR, gear, roll, 0.0, layout, points)
        # The adaptive rule stops at 1e-11.
        assert [ours.bending[i], ours.shear[i], ours.axial[i]] == pytest.approx(slow, rel=2e-11)
    assert np.all(ours.bending[1:] > healthy.bending[1:] * (1 + 1e-5))


@settings(max_examples=30, deadline=None)
@given(layouts)
def test_coarse_and_dense_contacts_agree(layout):
    """A converged quadrature: between 200 extra contacts every piece is a hundredth as wide."""
    gear = PAIR.pinion
    kinks = section_kinks(pit_rows(layout), PAIR.face_width_m)
    roll = np.array([0.9 * gear.tip_roll_rad])
    ours = tooth_compliance(PAIR, "pinion", roll, BASE_FREE, layout)
    edges = np.unique(np.clip(np.concatenate([gear.roll_at_height(np.clip(kinks, 0, 5.5e-3)), [0.0]]), 0.0, roll[0]))
    edges = np.append(edges, roll)
    nodes, weights = np.polynomial.legendre.leggauss(64)
    t = np.concatenate([np.pi * (part + 0.5 * (1 + nodes)) / 4 for part in range(4)])
    low, high = edges[:-1, np.newaxis], edges[1:, np.newaxis]
    psi = (0.5 * (low + high) - 0.5 * (high - low) * np.cos(t)).ravel()
    step = (0.5 * (high - low) * np.sin(t) * np.tile(weights, 4) * np.pi / 8).ravel()
    x, h = gear.height_m(psi), gear.half_thickness_m(psi)
    lost = section_loss(gear, layout, PAIR.face_width_m, x)
    inertia = 2 / 3 * h**3 * PAIR.face_width_m
    slant = roll[0] - gear.base_half_angle_rad
    lever = np.cos(slant) * (gear.height_m(roll[0]) - x) - np.sin(slant) * gear.half_thickness_m(roll[0])
    dx = step * gear.base_radius_m * psi * np.cos(psi - gear.base_half_angle_rad)
    bending = np.sum(lever**2 / (PAIR.youngs_modulus_pa * (inertia - lost.inertia_m4)) * dx)
    assert ours.bending[0] == pytest.approx(bending, rel=1e-9)


@pytest.mark.parametrize("options", [BASE, StiffnessOptions("root_circle"), TROCHOID])
@pytest.mark.parametrize(
    "damage", [layers(1, 5), layers(3, 10), layers(3, 10, 0.5, 0.3, stagger_mm=0.25, floor="dish")]
)
def test_contacts_below_the_pits_are_healthy_to_the_bit_and_none_is_stiffer(options, damage):
    angle, lost, _ = loss(damage, options)
    assert np.all(lost >= 0.0)
    height = PAIR.pinion.height_m(angle + ENTRY)
    lowest = min(p.height_m - p.semi_axis_profile_m for p in damage)
    assert np.all(lost[height <= lowest] == 0.0)
    beyond = height > max(p.height_m + p.semi_axis_profile_m for p in damage)
    assert np.all(lost[beyond] > 0.0)


@pytest.mark.parametrize("step", [0.4, 0.3, 0.15])
def test_layers_above_the_contact_do_not_change_a_bit(step):
    moderate, severe = layers(1, 10), layers(3, 10, step_height_mm=step)
    angle = fine_angles(severe)
    one, two = (mesh_stiffness(PAIR, angle, BASE, d) for d in (moderate, severe))
    second = severe[10]
    below = PAIR.pinion.height_m(angle + ENTRY) <= second.height_m - second.semi_axis_profile_m
    assert np.array_equal(one[below], two[below])
    # Aligned overlapping columns: the second layer hides behind the first one up to half-way between them.
    visible = PAIR.pinion.height_m(angle + ENTRY) > 1e-9 + max(
        second.height_m - 0.5e-3 * step, second.height_m - second.semi_axis_profile_m
    )
    assert np.all(two[visible] < one[visible])
    assert np.all(two <= one)


def test_half_the_pits_lose_less_than_half_the_stiffness():
    assert loss(layers(1, 10))[1].max() > 2.3 * loss(layers(1, 5))[1].max()


def test_lost_contact_compliance_is_convex_in_the_lost_length():
    damage = layers(1, 10)
    s = float(PAIR.pinion.roll_at_height(1.9e-3)) * PAIR.pinion.base_radius_m
    gain = contact_compliance(PAIR, s, damage) - contact_compliance(PAIR, s)
    lost, width = 6e-3, PAIR.face_width_m
    exact = 4 * (1 - 0.3**2) / (np.pi * 206e9) * lost / (width * (width - lost))
    assert gain[0] == pytest.approx(exact, rel=1e-9)


@pytest.mark.parametrize("options", [BASE, TROCHOID])
def test_height_moves_the_loss_and_keeps_the_lost_length(options):
    peaks = []
    for height in (1.0, 1.9, 2.8, 3.7, 4.6):
        damage = layers(1, 10, height_mm=height)
        _, lost, healthy = loss(damage, options)
        peaks.append((lost / healthy).max())
        assert contact_length_loss(damage, 20e-3, height * 1e-3)[0] == pytest.approx(6e-3, rel=1e-12)
    if options is BASE:
        assert 100 * np.array(peaks) == pytest.approx([1.4, 2.7, 1.6, 1.4, 1.1], abs=0.051)
    assert peaks[1] > 1.6 * max(peaks[0], peaks[2], peaks[3], peaks[4])


def test_foundation_never_feels_pits():
    rolls = np.linspace(0.06, PAIR.pinion.tip_roll_rad, 50)
    healthy, pitted = (tooth_compliance(PAIR, "pinion", rolls, TROCHOID, d) for d in ((), layers(3, 10)))
    assert np.array_equal(healthy.foundation, pitted.foundation)


def test_moving_pits_across_the_face_changes_nothing():
    one = [pit(face_mm=w) for w in (3.0, 8.0, 15.0)]
    two = [pit(face_mm=w) for w in (1.0, 9.5, 18.0)]
    s = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 101)
    # Interval ends round differently: 1e-18 m of 1e-2 m.
    assert pair_stiffness(PAIR, s, TROCHOID, one) == pytest.approx(pair_stiffness(PAIR, s, TROCHOID, two), rel=1e-12)


S = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, 61)


@settings(max_examples=50, deadline=None)
@given(layouts, st.sampled_from(["pinion", "gear"]), st.randoms())
def test_order_and_repetition_of_pits_change_no_bit(layout, which, random):
    mixed = [*layout, layout[0]]
    random.shuffle(mixed)
    key = f"{which}_pits"
    one, two = (pair_stiffness(PAIR, S, TROCHOID, **{key: p}) for p in (layout, mixed))
    assert np.array_equal(one, two)


@settings(max_examples=20, deadline=None)
@given(layouts, st.sampled_from(["pinion", "gear"]))
def test_teeth_and_contacts_asked_for_together_are_those_asked_for_alone_to_the_bit(layout, which):
    """Healthy parts, sums over pits and rows are computed once for teeth, tables and labels; nothing may tell."""
    rolls = np.linspace(*(np.array(PAIR.active_flank[which == "gear"])), 37)
    together = tooth_compliances(PAIR, which, rolls, TROCHOID, ((), layout, layout[:1]))
    for pits_of_tooth, found in zip(((), layout, layout[:1]), together, strict=True):
        rows = pit_rows(pits_of_tooth)
        # what a caller does to its rows is its own affair
        pit_rows(pits_of_tooth)[:] = np.nan
        assert np.array_equal(pit_rows(pits_of_tooth), rows)
        alone = [tooth_compliance(PAIR, which, roll, TROCHOID, pits_of_tooth).total[0] for roll in rolls[::-1]]
        assert np.array_equal(found.total, alone[::-1])


@settings(max_examples=50, deadline=None)
@given(layouts, pits, st.sampled_from(["base_circle", "root_circle", "rack_trochoid"]))
def test_a_further_pit_never_stiffens(layout, further, beam):
    options = StiffnessOptions(beam)
    healthy = pair_stiffness(PAIR, S, options)
    before = pair_stiffness(PAIR, S, options, layout)
    after = pair_stiffness(PAIR, S, options, [*layout, further])
    assert np.all(before <= healthy)
    # Two damaged states are integrated on different pieces: quadrature of 1e-11 of their losses.
    assert np.all(after <= before * (1 + 1e-11))


@settings(max_examples=30, deadline=None)
@given(layouts)
def test_damage_moves_with_its_gear_when_driver_and_driven_swap(layout):
    assume(all(p.height_m + p.semi_axis_profile_m < 5e-3 for p in layout))
    swapped = replace(PAIR, pinion=PAIR.gear, gear=PAIR.pinion)
    mirrored = pair_stiffness(swapped, PAIR.line_of_action_m - S, TROCHOID, (), layout)
    # Positions round by 1e-18 m; near a pit's end the loss has a square root: 1e-18/2e-4 -> 1e-7 of that pit's 1e-4
    # share.
    assert mirrored == pytest.approx(pair_stiffness(PAIR, S, TROCHOID, layout), rel=1e-9)


def test_two_damaged_flanks_lose_the_union_of_their_intervals():
    s = PAIR.pitch_point_m
    pinion_height = float(PAIR.pinion.height_m(s / PAIR.pinion.base_radius_m))
    gear_height = float(PAIR.gear.height_m((PAIR.line_of_action_m - s) / PAIR.gear.base_radius_m))
    one = pit(pinion_height * 1e3, 10.0, 2.0)
    constant = 4 * (1 - 0.3**2) / (np.pi * 206e9)
    for shift, union in ((0.0, 4.0), (1.0, 5.0), (4.0, 8.0), (7.0, 8.0)):
        two = replace(pit(gear_height * 1e3, 10.0 + shift, 2.0), gear="gear")
        left = constant / contact_compliance(PAIR, s, [one], [two])[0]
        assert left == pytest.approx((20.0 - union) * 1e-3, rel=1e-12)


def test_faulty_pair_recurs_once_per_revolution_and_only_its_contact_changes():
    damage = tuple(replace(p, tooth=5) for p in layers(1, 10))
    angle = np.linspace(0.0, 2 * np.pi, 3601)[:-1] + 1e-4
    lost = mesh_stiffness(PAIR, angle, TROCHOID) - mesh_stiffness(PAIR, angle, TROCHOID, damage)
    local = angle - 5 * 2 * np.pi / 18
    assert np.all(lost[(local < 0) | (local > LAST)] == 0.0)
    assert np.max(lost) > 1e6
    later = mesh_stiffness(PAIR, angle + 4 * np.pi, TROCHOID, damage)
    # Angles after two revolutions round by 2e-15 rad; square-root flanks of the loss make 1e-7 of it of that.
    assert later == pytest.approx(mesh_stiffness(PAIR, angle, TROCHOID, damage), rel=1e-9)


def test_damaged_gear_tooth_recurs_with_its_own_teeth():
    height = float(PAIR.gear.height_m((PAIR.line_of_action_m - PAIR.pitch_point_m) / PAIR.gear.base_radius_m))
    damage = (pit(height * 1e3, 10.0, 3.0, gear="gear", tooth=20),)
    pitch = 2 * np.pi / 18
    angle = (PAIR.pitch_point_m - PAIR.contact_start_m) / PAIR.pinion.base_radius_m + pitch * np.arange(3 * 47)
    lost = mesh_stiffness(PAIR, angle, TROCHOID) - mesh_stiffness(PAIR, angle, TROCHOID, damage)
    assert np.flatnonzero(lost > 1e5).tolist() == [20, 67, 114]


def test_a_wholly_lost_contact_and_consumed_sections_are_refused_with_their_limit():
    whole = [pit(1.9, 10.0, 10.5, 0.3)]
    with pytest.raises(ValueError, match=r"contact length; allowed: less than the face width 0\.02"):
        pair_stiffness(PAIR, S, TROCHOID, whole)
    with pytest.raises(ValueError, match="half tooth thickness"):
        tooth_compliance(PAIR, "pinion", 0.5, TROCHOID, [pit(1.9, 10.0, 30.0, 0.3, 12.0)])
    for bad in ({"b_mm": 0.0}, {"a_mm": -1.0}, {"depth_mm": np.nan}, {"height_mm": np.inf}, {"floor": "cone"}):
        with pytest.raises(ValueError, match="allowed"):
            pair_stiffness(PAIR, S, TROCHOID, [pit(**bad)])
    assert damage_problems(PAIR, layers(3, 10)) == ()
