"""Gear geometry: tabulated heights, the rack-cut root with profile shift, centre distance, impossible pairs."""

from __future__ import annotations

from dataclasses import replace
from math import atan, cos, inf, nan, pi, radians, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.gears.gear_pair import GearPair, SpurGear, geometry_problems
from siggen.gears.involute import involute_function
from tests.gears.builders import pair_18_47, spur_gear


@pytest.mark.parametrize(
    ("module", "sap", "lpstc", "pitch", "hpstc", "tip", "thickness"),
    [
        (1.5, 0.0225, 0.5011, (0.8289, 0.8141, 0.8403), 1.0393, (2.3716, 2.3141), 1.177),
        (3.0, 0.0450, 1.0022, (1.6579, 1.6283, 1.6805), 2.0786, (4.7432, 4.6283), 2.353),
        (3.175, 0.0476, 1.0606, (1.7546, 1.7233, 1.7786), 2.1998, (5.0199, 4.8983), 2.490),
        (3.5, 0.0525, 1.1692, (1.9342, 1.8997, 1.9606), 2.4250, (5.5337, 5.3997), 2.745),
        (4.0, 0.0600, 1.3362, (2.2105, 2.1711, 2.2407), 2.7714, (6.3242, 6.1711), 3.138),
    ],
)
def test_heights_of_18_teeth_are_the_tabulated_ones(module, sap, lpstc, pitch, hpstc, tip, thickness):
    pair = pair_18_47(module * 1e-3, (2e-3, 3e-3))
    gear = pair.pinion
    start, end, base_pitch = pair.contact_start_m, pair.contact_end_m, pair.base_pitch_m
    positions = np.array([start, end - base_pitch, pair.pitch_point_m, start + base_pitch, end])
    rolls = positions / gear.base_radius_m
    radial = gear.radius_m(rolls) - gear.base_radius_m
    arc = 0.5 * gear.base_radius_m * rolls[2] ** 2
    found = [*gear.height_m(rolls), radial[2], radial[4], arc]
    # Half a unit of the last printed digit, 1e-4 mm.
    printed = [sap, lpstc, pitch[0], hpstc, tip[0], pitch[1], tip[1], pitch[2]]
    assert np.array(found) * 1e3 == pytest.approx(printed, abs=5.1e-5)
    assert gear.half_thickness_m(rolls[2]) * 1e3 == pytest.approx(thickness, abs=5.1e-4)


shifted_gears = st.builds(
    lambda z, x, m: SpurGear(z, m, radians(20), x, 1.0, 0.25, 0.1 * m * z),
    st.integers(18, 120),
    st.floats(0.0, 0.6),
    st.floats(0.5e-3, 10e-3),
)


def involute_point(gear, roll):
    y = gear.base_radius_m * (cos(roll - gear.base_half_angle_rad) + roll * sin(roll - gear.base_half_angle_rad))
    return y, gear.base_radius_m * (roll * cos(roll - gear.base_half_angle_rad) - sin(roll - gear.base_half_angle_rad))


@settings(max_examples=60, deadline=None)
@given(shifted_gears)
def test_trochoid_meets_the_involute_with_equal_slope_whatever_the_profile_shift(gear):
    meeting = involute_point(gear, gear.involute_start_roll_rad)
    assert gear.involute_start_gamma_rad == gear.pressure_angle_rad
    # Rounding: both points are sums of lengths of order m z.
    rounding = 4e-16 * gear.module_m * gear.teeth
    one, two = (gear.trochoid_point_m(gear.pressure_angle_rad + step) for step in (0.0, 1e-5))
    assert one == pytest.approx(meeting, abs=rounding)
    fillet = atan((one[1] - two[1]) / (one[0] - two[0]))
    # The involute's normal is tangent to the base circle, so its slope angle at roll psi is psi - alpha_2.
    flank = -(gear.involute_start_roll_rad - gear.base_half_angle_rad)
    # One-sided difference over 1e-5 rad: the slope turns by 1e-5 (1 + a1/(r sin^2 alpha_0)) / 2, below 2e-5.
    assert fillet == pytest.approx(flank, abs=2e-5)


@settings(max_examples=60, deadline=None)
@given(shifted_gears)
def test_trochoid_touches_the_root_circle_at_the_racks_half_angle(gear):
    y, h = gear.trochoid_point_m(pi / 2)
    assert sqrt(y * y + h * h) == pytest.approx(gear.root_radius_m, rel=1e-14)
    assert np.arctan2(h, y) == pytest.approx(gear.rack_root_half_angle_rad, rel=1e-12)


CUT_GEARS = [(18, 0.0), (18, 0.4), (20, 0.0), (31, -0.1), (47, 0.0), (47, 0.9), (12, 0.5)]


@pytest.mark.parametrize(("teeth", "shift"), CUT_GEARS)
def test_trochoid_is_the_envelope_of_the_racks_tip_round(teeth, shift):
    gear = spur_gear(teeth, profile_shift=shift)
    r, rho = gear.pitch_radius_m, gear.rack_round_m
    turns = np.linspace(-1.2, 1.2, 4801)
    # Rack rolled by the gear's turn: its round's centre, seen from the turning gear whose tooth centre line stands
    # upright.
    depth, offset = r - gear.rack_round_depth_m, gear.rack_round_offset_m

    def centre(turn):
        across = offset - r * turn
        return depth * np.cos(turn) - across * np.sin(turn), depth * np.sin(turn) + across * np.cos(turn)

    for gamma in np.linspace(gear.involute_start_gamma_rad, pi / 2, 9):
        y, h = gear.trochoid_point_m(gamma)
        cy, ch = centre(turns)
        nearest = turns[np.argmin(np.hypot(cy - y, ch - h))]
        fine = nearest + np.linspace(-6e-4, 6e-4, 2401)
        cy, ch = centre(fine)
        # The round never cuts into the envelope and touches it: sampling the turn by 5e-7 rad leaves r (5e-7)^2 / rho,
        # 1e-12 m.
        assert np.min(np.hypot(cy - y, ch - h)) == pytest.approx(rho, abs=2e-12)


def test_undercut_tooth_starts_where_the_trochoid_crosses_the_involute():
    gear = spur_gear(12, profile_shift=0.0, bore_radius_m=5e-3)
    assert gear.undercut
    assert not spur_gear(18).undercut
    assert gear.involute_start_roll_rad > 0.0
    crossing = gear.trochoid_point_m(gear.involute_start_gamma_rad)
    assert crossing == pytest.approx(involute_point(gear, gear.involute_start_roll_rad), abs=1e-14)
    # Just below the crossing the round has cut deeper than the involute at the same radius.
    y, h = gear.trochoid_point_m(gear.involute_start_gamma_rad + 0.002)
    roll = float(gear.roll_at_radius(sqrt(y * y + h * h)))
    assert np.arctan2(h, y) < gear.base_half_angle_rad - (roll - atan(roll))


def test_heights_off_the_involute_are_refused():
    gear = spur_gear()
    for height in (-1e-6, nan, 1.0):
        with pytest.raises(ValueError, match="off the involute"):
            gear.roll_at_height(height)
    with pytest.raises(ValueError, match="off the involute"):
        gear.roll_at_radius(0.9 * gear.base_radius_m)


def test_shifted_pair_meshes_without_backlash_at_its_own_centre_distance():
    pair = pair_18_47(shifts=(0.3, 0.1))
    distance = pair.working_centre_distance_m
    assert distance > 0.5 * 3.5e-3 * 65
    wide = pair.working_pressure_angle_rad
    thickness = 0.0
    for gear, ratio in ((pair.pinion, 18 / 65), (pair.gear, 47 / 65)):
        rolling = ratio * distance
        thickness += 2 * rolling * (gear.base_half_angle_rad - involute_function(wide))
    # Tooth thicknesses on the rolling circles fill one pitch exactly.
    assert thickness == pytest.approx(2 * pi * (18 / 65) * distance / 18, rel=1e-13)
    assert replace(pair, centre_distance_m=distance).contact_ratio == pytest.approx(pair.contact_ratio, rel=1e-12)
    assert geometry_problems(replace(pair, centre_distance_m=round(distance, 12))) == ()


def names(pair):
    return {(problem.where, problem.name) for problem in geometry_problems(pair)}


HIGH = spur_gear(25, profile_shift=0.9)


@pytest.mark.parametrize(
    ("pair", "problem"),
    [
        (pair_18_47(shifts=(1.3, 0.0)), ("pinion", "pointed tip")),
        (pair_18_47(bores_m=(12.5e-3, 78e-3)), ("gear", "bore_radius_m")),
        (pair_18_47(centre_distance_m=0.1130), ("pair", "centre_distance_m")),
        (pair_18_47(centre_distance_m=0.1175), ("pair", "contact ratio")),
        (pair_18_47(shifts=(-0.3, 0.0)), ("pinion", "undercut")),
        (GearPair(HIGH, HIGH, 20e-3, 206e9, 0.3), ("gear", "tip touches root")),
        (pair_18_47(youngs_modulus_pa=nan), ("pair", "youngs_modulus_pa")),
        (pair_18_47(face_width_m=-1.0), ("pair", "face_width_m")),
        (pair_18_47(face_width_m=inf), ("pair", "face_width_m")),
        (pair_18_47(poisson_ratio=0.5), ("pair", "poisson_ratio")),
        (pair_18_47(module_m=nan), ("pinion", "module_m")),
        (replace(pair_18_47(), pinion=spur_gear(3)), ("pinion", "teeth")),
        (replace(pair_18_47(), gear=spur_gear(47, 3.0e-3)), ("pair", "module_m")),
        (GearPair(spur_gear(14, bore_radius_m=5e-3), spur_gear(120), 20e-3, 206e9, 0.3), ("pinion", "interference")),
    ],
)
def test_impossible_pairs_are_named(pair, problem):
    assert problem in names(pair)
    assert all("allowed" in found.allowed for found in geometry_problems(pair))


def test_undercut_is_a_problem_only_when_it_reaches_the_flank_in_contact():
    slightly = GearPair(spur_gear(17), spur_gear(17), 20e-3, 206e9, 0.3)
    assert slightly.pinion.undercut
    assert geometry_problems(slightly) == ()


@settings(max_examples=80, deadline=None)
@given(
    st.integers(-3, 200),
    st.one_of(st.floats(-3, 3), st.just(nan)),
    st.one_of(st.floats(-0.1, 1.6), st.just(nan)),
    st.one_of(st.none(), st.floats(-1, 1)),
    st.floats(-0.5, 3.0),
)
def test_geometry_problems_never_raises_and_a_clean_pair_has_a_path_of_contact(teeth, shift, angle, distance, height):
    gear = SpurGear(teeth, 3e-3, angle, shift, height, 0.25, 5e-3)
    pair = GearPair(gear, SpurGear(40, 3e-3, angle, 0.0, height, 0.25, 5e-3), 20e-3, 206e9, 0.3, distance)
    if not geometry_problems(pair):
        assert 0 < pair.contact_start_m < pair.contact_end_m < pair.line_of_action_m
