"""The mesh of planet and ring: the rack's tooth as limit, slow quadrature, the level of published stiffness."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import RingGear, ring_round
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import ROTATION, tooth_compliance
from tests.gears.builders import spur_gear

PARTS = ("bending", "shear", "axial")


def sets():
    sun_pair = GearPair(spur_gear(24, 2e-3, 6e-3), spur_gear(27, 2e-3, 6e-3), 20e-3, 206e9, 0.3)
    return sun_pair, ring_round(sun_pair, 78)


def test_the_tooth_of_a_wide_ring_is_that_of_a_wide_gear():
    """Both are the rack's tooth: two ways, roll angles and radii, outwards and inwards."""
    sun_pair, pair = sets()
    teeth = 100_000
    wide = replace(pair, gear=RingGear(teeth, 2e-3, pair.pinion.pressure_angle_rad, 0.0, 1.0, 0.25, 6e-3))
    gear = spur_gear(teeth, 2e-3, 50.0)
    outer = replace(sun_pair, gear=gear)
    for height in (-0.8e-3, 0.0, 0.9e-3):  # from the pitch line to the tip
        roll = gear.roll_at_radius(gear.pitch_radius_m + height)
        roll_of_ring = wide.gear.roll_at_radius(wide.gear.pitch_radius_m - height)
        found = tooth_compliance(wide, "gear", [roll_of_ring], StiffnessOptions())
        expected = tooth_compliance(outer, "gear", [roll], StiffnessOptions(beam="root_circle", foundation="none"))
        for part in PARTS:
            assert getattr(found, part)[0] == pytest.approx(getattr(expected, part)[0], rel=3e-4), part  # 1/z


def test_ring_tooth_against_slow_quadrature_of_its_outline():
    _, pair = sets()
    ring = pair.gear
    for share in (0.0, 0.5, 1.0):
        position = pair.contact_start_m + share * (pair.contact_end_m - pair.contact_start_m)
        roll = (position - pair.line_of_action_m) / ring.base_radius_m
        found = tooth_compliance(pair, "gear", [roll], StiffnessOptions())
        radii = np.linspace(ring.tip_radius_m, ring.root_radius_m, 200_001)
        half = ring.half_angle_rad(radii)
        height, width = radii * np.cos(half), radii * np.sin(half)
        at = np.hypot(ring.base_radius_m, position - pair.line_of_action_m)
        place = np.interp(at, radii, height), np.interp(at, radii, width)
        slope = np.interp(place[0], height, np.gradient(width, height))  # flank against the centre line
        along, across = np.sin(np.arctan(slope)), np.cos(np.arctan(slope))

        def inertia(y, height=height, width=width):
            return 2.0 / 3.0 * np.interp(y, height, width) ** 3 * 20e-3

        def energy(y, place=place, along=along, across=across):
            return (across * (y - place[0]) - along * place[1]) ** 2 / (206e9 * inertia(y))

        slow = quad(energy, place[0], height[-1], limit=200, epsrel=1e-8)[0]
        assert found.bending[0] == pytest.approx(slow, rel=1e-4)  # differences of the outline

        def slenderness(y, height=height, width=width):
            return 1.0 / (2.0 * np.interp(y, height, width) * 20e-3)

        area = quad(slenderness, place[0], height[-1], limit=200)[0]
        assert found.axial[0] == pytest.approx(along**2 * area / 206e9, rel=1e-4)
        assert found.shear[0] == pytest.approx(1.2 * across**2 * area * 2.6 / 206e9, rel=1e-4)
        # Cornell's foot, the load where its line crosses the centre line: turned, both ways coupled, shifted
        lever = (height[-1] - place[0] - place[1] * along / across) / (2.0 * width[-1])
        shifted = 1.534 * (1.0 + (along / across) ** 2 / (2.4 * 1.3))
        foot = 16.67 / pi * lever**2 + 2.0 * 0.7 * lever + shifted
        assert found.foundation[0] == pytest.approx(across**2 * foot / (206e9 * 20e-3), rel=1e-4)


def spalled(pair, depth_m, heights_m=(2.0e-3, 3.0e-3)):
    """Return a spall across the face between two heights of a ring's tooth, which grow towards its root."""
    return (FlankSpall("gear", 0, rectangle(heights_m, (0.0, pair.face_width_m)), depth_m),)


def test_a_spall_across_the_face_leaves_a_tapered_beam_that_is_thinner_by_its_depth():
    """Closed form: a thickness of 2h - D, about its own axis; integrated over the outline's points."""
    _, pair = sets()
    ring, depth = pair.gear, 0.3e-3
    low, high = 2.0e-3, 3.0e-3
    rolls = ring.roll_at_height(np.array([1.2e-3, 1.9e-3, 2.5e-3]))  # before the spall, and in its middle
    sound, damaged = (
        tooth_compliance(pair, "gear", rolls, StiffnessOptions(), pits) for pits in ((), spalled(pair, depth))
    )
    radii = np.linspace(ring.tip_radius_m, ring.root_radius_m, 400_001)
    half = ring.half_angle_rad(radii)
    height, width = radii * np.cos(half), radii * np.sin(half)
    above = height - float(height[0] - ring.height_m(ring.tip_roll_rad))  # from the base circle's point
    for i, roll in enumerate(rolls):
        place = float(ring.height_m(roll)), float(ring.half_thickness_m(roll))
        slant = roll - ring.base_half_angle_rad
        along, across = np.sin(slant), np.cos(slant)
        inside = (above >= max(low, place[0])) & (above <= high)
        y, thick = above[inside], 2.0 * width[inside]
        lever = across * (y - place[0]) - along * place[1]
        more = 12.0 / (20e-3 * (thick - depth) ** 3) - 12.0 / (20e-3 * thick**3)
        assert (damaged.bending - sound.bending)[i] == pytest.approx(np.trapezoid(lever**2 * more, y) / 206e9, rel=1e-4)
        area = np.trapezoid(1.0 / (thick - depth) - 1.0 / thick, y) / 20e-3
        assert (damaged.shear - sound.shear)[i] == pytest.approx(1.2 * across**2 * area * 2.6 / 206e9, rel=1e-4)
        assert (damaged.axial - sound.axial)[i] == pytest.approx(along**2 * area / 206e9, rel=1e-4)
    assert (damaged.foundation == sound.foundation).all()


def test_what_a_spall_takes_of_a_ring_tooth_softens_it_and_ends_with_its_depth():
    _, pair = sets()
    roll = pair.gear.roll_at_height(np.linspace(1.2e-3, 3.5e-3, 9))
    sound = tooth_compliance(pair, "gear", roll, StiffnessOptions()).total
    more = [tooth_compliance(pair, "gear", roll, StiffnessOptions(), spalled(pair, d)).total - sound for d in DEPTHS]
    assert (more[0][:6] > 0.0).all()  # loaded before or in it
    assert more[0][-1] == pytest.approx(0.0, abs=1e-9 * sound.max())  # loaded behind it, nearer to the root
    assert more[1] == pytest.approx(0.1 * more[0], rel=0.02, abs=1e-9 * sound.max())  # first order in the depth
    assert np.abs(more[2]).max() < 1e-6 * sound.max()


DEPTHS = (1e-5, 1e-6, 1e-12)


def test_the_foot_turns_on_the_half_plane_as_its_potential_says():
    """Work of linear pressure on Flamant's half plane: 18/pi (closed form); the published fit is 7 % below."""
    nodes, weights = np.polynomial.legendre.leggauss(400)
    logs = np.log(np.abs(nodes[:, None] - nodes[None, :] + 1e-3 * np.eye(400)))
    np.fill_diagonal(logs, np.log(weights / 2.0) - 1.0)  # mean of ln|x| over a node's own strip
    work = -(2.0 / pi) * 9.0 * (weights * nodes) @ logs @ (weights * nodes)
    assert work == pytest.approx(18.0 / pi, rel=5e-3)
    assert abs(ROTATION - work) < 0.08 * work
