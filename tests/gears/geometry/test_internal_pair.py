"""A planet in a ring: conjugate flanks, the rack as limit, the phase between both meshes of a planet."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, radians, sin, tan

import numpy as np
import pytest

from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import RingGear, internal_problems, ring_ahead_pitches, ring_round
from tests.gears.builders import spur_gear


def sun_and_planet(sun=24, planet=27, shifts=(0.0, 0.0)):
    gears = [spur_gear(z, 2e-3, 6e-3, x) for z, x in zip((sun, planet), shifts, strict=True)]
    return GearPair(*gears, 20e-3, 206e9, 0.3)


@pytest.mark.parametrize(("ring", "shifts"), [(78, (0.0, 0.0)), (79, (0.0, 0.0)), (78, (0.3, -0.1))])
def test_flanks_touch_on_the_line_of_action_and_never_cross(ring, shifts):
    """Turned at the ratio of the teeth; the gap round the ring's centre, in angle, from points of both involutes."""
    sun_pair = sun_and_planet(shifts=shifts)
    pair = ring_round(sun_pair, ring)
    assert internal_problems(pair) == ()
    assert pair.working_centre_distance_m == pytest.approx(sun_pair.working_centre_distance_m, rel=1e-12)
    planet, wheel, centre = pair.pinion, pair.gear, pair.working_centre_distance_m
    roll = np.linspace(planet.involute_start_roll_rad, planet.tip_roll_rad, 20_001)
    inv = roll - np.arctan(roll)
    for share in (0.1, 0.4, 0.8):
        position = pair.contact_start_m + share * (pair.contact_end_m - pair.contact_start_m)
        contact = position / planet.base_radius_m
        # centres on the x axis, the planet turns clockwise: strings leave both base circles at the working angle
        tangent = pair.working_pressure_angle_rad
        origin = tangent - contact  # of the involute on the base circle
        radius, angle = planet.base_radius_m * np.hypot(1.0, roll), origin + inv
        x, y = centre + radius * np.cos(angle), radius * np.sin(angle)
        from_ring, at = np.hypot(x, y), np.arctan2(y, x)
        usable = (from_ring > wheel.tip_radius_m) & (from_ring < wheel.root_radius_m)
        slant = np.arccos(wheel.base_radius_m / from_ring[usable])
        ring_origin = tangent - (position - pair.line_of_action_m) / wheel.base_radius_m
        gap = from_ring[usable] * (at[usable] - (ring_origin + np.tan(slant) - slant))
        assert np.abs(gap).min() < 1e-9
        assert abs(from_ring[usable][np.abs(gap).argmin()] - pair.ring_radius_m(np.array([position]))[0]) < 2e-5
        assert gap.min() > -1e-12 or gap.max() < 1e-12


def test_a_ring_without_end_is_a_rack():
    pair = ring_round(sun_and_planet(), 78)
    pair = replace(pair, gear=replace(pair.gear, cut_back_m=0.0))
    wide = replace(pair, gear=replace(pair.gear, teeth=10_000_000))
    alpha, module = radians(20.0), 2e-3
    expected = (pair.contact_end_m - (pair.pitch_point_m - module / sin(alpha))) / (pi * module * cos(alpha))
    assert wide.contact_ratio == pytest.approx(expected, rel=1e-6)
    assert pair.contact_ratio > expected


def test_the_ring_fills_what_the_spaces_leave():
    ring = RingGear(78, 2e-3, radians(20.0), 0.25, 1.0, 0.25, 6e-3)
    at_pitch = float(ring.half_angle_rad(np.array([ring.pitch_radius_m]))[0])
    assert 2.0 * ring.pitch_radius_m * at_pitch == pytest.approx(pi * 1e-3 - 0.5 * 2e-3 * tan(radians(20.0)), rel=1e-12)


@pytest.mark.parametrize(("planet", "ahead"), [(27, 0.0), (26, 0.5)])
def test_meshes_of_a_planet_without_shift_are_in_step_for_odd_teeth_and_half_a_pitch_apart_for_even(planet, ahead):
    sun_pair = sun_and_planet(planet=planet)
    assert ring_ahead_pitches(sun_pair, ring_round(sun_pair, 24 + 2 * planet)) == pytest.approx(ahead, abs=1e-12)


@pytest.mark.parametrize(("ring", "shifts"), [(78, (0.3, -0.1)), (79, (0.0, 0.0)), (77, (0.4, 0.2))])
def test_the_phase_between_both_meshes_is_that_of_strings_unwound_from_the_planets_base_circle(ring, shifts):
    """A contact at s lies R_b · roll along its string: count strings from the feet of both flanks of one tooth."""
    sun_pair = sun_and_planet(shifts=shifts)
    pair = ring_round(sun_pair, ring)
    planet, pitch = pair.pinion, 2.0 * pi / pair.pinion.teeth
    sun_angle, ring_angle = sun_pair.working_pressure_angle_rad, pair.working_pressure_angle_rad
    # the sun on the left, the planet turns clockwise; strings leave its base circle at pi - alpha and at alpha
    foot_behind = pi - sun_angle + tan(sun_angle)
    middle = foot_behind - planet.base_half_angle_rad
    foot_ahead = middle - planet.base_half_angle_rad
    past = (ring_angle - tan(ring_angle) - foot_ahead) / pitch % 1.0
    assert ring_ahead_pitches(sun_pair, pair) == pytest.approx(past, abs=1e-12)


def test_rings_that_do_not_mesh_are_refused_by_name():
    pair = ring_round(sun_and_planet(), 78)
    high = replace(pair, gear=replace(pair.gear, cut_back_m=0.0))
    assert internal_problems(pair) == ()
    assert "interference" in " ".join(map(str, internal_problems(high)))
    with pytest.raises(ValueError, match="line of action"):
        ring_round(sun_and_planet(8, 12), 36)
