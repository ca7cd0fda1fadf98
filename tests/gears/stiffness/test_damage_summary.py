"""Extent of a damage in numbers."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.mesh.damage_summary import DamageSummary, damage_summary, flank_arc_m
from siggen.mesh.mesh_stiffness import pair_stiffness
from siggen.mesh.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47, pit

PAIR = pair_18_47()


def test_no_damage_has_no_extent():
    summary = damage_summary(PAIR, ())
    assert summary == DamageSummary(0, 0.0, 0.0, 0.0, 0.0, 0.0, False)


def test_summary_of_moderate_pitting():
    summary = damage_summary(PAIR, layers(1, 10))
    roll = PAIR.pinion.roll_at_height(np.array([1.7e-3, 2.1e-3]))
    arc = 0.5 * PAIR.pinion.base_radius_m * (roll[1] ** 2 - roll[0] ** 2)
    assert summary.count == 10
    assert summary.contact_length_loss_m == pytest.approx(6e-3, rel=1e-12)
    assert summary.largest_face_length_m == pytest.approx(0.6e-3, rel=1e-12)
    assert summary.largest_profile_length_m == pytest.approx(arc, rel=1e-9)
    # Arc over height is 1/cos(psi - alpha_2), between the values at the pit's two ends.
    stretch = 1 / np.cos(roll - PAIR.pinion.base_half_angle_rad)
    plane = 10 * pi * 0.3e-3 * 0.2e-3
    assert plane * stretch[0] < summary.union_area_m2 < plane * stretch[1]
    assert summary.area_share == pytest.approx(summary.union_area_m2 / (20e-3 * flank_arc_m(PAIR.pinion)), rel=1e-12)


def test_area_adds_over_teeth_and_the_share_is_the_most_damaged_flanks():
    small, large = (pit(tooth=1),), tuple(replace(p, tooth=2) for p in layers(2, 5))
    on_gear = (pit(5.0, gear="gear", tooth=2),)
    whole = damage_summary(PAIR, small + large + on_gear)
    parts = [damage_summary(PAIR, d) for d in (small, large, on_gear)]
    assert whole.union_area_m2 == pytest.approx(sum(p.union_area_m2 for p in parts), rel=1e-13)
    assert whole.area_share == max(p.area_share for p in parts)
    assert whole.count == 12


def test_through_face_means_that_no_contact_length_remains_somewhere():
    band = (1.7e-3, 2.1e-3)
    whole = FlankSpall("pinion", 0, rectangle(band, (0.0, 20e-3)), 0.1e-3)
    nearly = replace(whole, outline=rectangle(band, (0.0, 19.99e-3)))
    rest = replace(whole, outline=rectangle((1.9e-3, 1.95e-3), (19.9e-3, 21e-3)))
    assert damage_summary(PAIR, (whole,)).through_face is True
    assert damage_summary(PAIR, (whole,)).contact_length_loss_m == 20e-3
    assert damage_summary(PAIR, (nearly,)).through_face is False
    assert damage_summary(PAIR, (nearly, rest)).through_face is True
    assert damage_summary(PAIR, (pit(5.5, 0.1, 0.3, 0.4, 0.2),)).through_face is False  # runs out of the face's end
    with pytest.raises(ValueError, match=r"allowed: less than the face width"):
        pair_stiffness(
            PAIR,
            PAIR.pitch_point_m,
            StiffnessOptions(),
            (replace(whole, outline=rectangle((0.5e-3, 4e-3), (0.0, 20e-3))),),
        )


def test_the_longest_arc_counts():
    s = PAIR.pitch_point_m
    base = PAIR.pinion.base_radius_m
    middle = s * s / (2 * base)  # arc of the pitch point
    ends = [float(PAIR.pinion.height_m(np.sqrt(2 * (middle + side * 0.75e-3) / base))) for side in (-1, 1)]
    spall = FlankSpall("pinion", 3, rectangle(tuple(ends), (5e-3, 9e-3)), 0.1e-3)
    summary = damage_summary(PAIR, (pit(4.5), spall))
    assert summary.largest_profile_length_m == pytest.approx(1.5e-3, rel=1e-12)
