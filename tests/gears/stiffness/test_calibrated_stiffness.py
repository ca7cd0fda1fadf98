"""The calibrated tooth: factor times rack trochoid, damage as on the trochoid, and notes where a model is stretched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.gears.stiffness.calibration import calibration_factor
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.mesh_stiffness import mesh_stiffness, pair_stiffness
from siggen.gears.stiffness.stiffness_notes import stiffness_notes
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47, pit

PARTS = ("bending", "shear", "axial", "foundation")
CALIBRATED, TROCHOID = StiffnessOptions("calibrated"), StiffnessOptions("rack_trochoid")


def flank_rolls(pair, which, count=31):
    gear = pair.member(which)
    return np.linspace(gear.involute_start_roll_rad, gear.tip_roll_rad, count)


@pytest.mark.parametrize("which", ["pinion", "gear"])
def test_every_part_is_the_factor_times_that_of_the_trochoid(which):
    pair = pair_18_47()
    rolls = flank_rolls(pair, which)
    ours, plain = (tooth_compliance(pair, which, rolls, options) for options in (CALIBRATED, TROCHOID))
    factor = calibration_factor(pair.member(which), rolls)
    for part in PARTS:
        np.testing.assert_array_equal(getattr(ours, part), factor * getattr(plain, part))
    assert np.max(np.abs(factor - 1)) > 0.02


def test_calibrated_teeth_meet_finite_elements_within_half_a_percent():
    # Finite-element compliance times E L of 18 teeth at h_f 2.17, places 0.1 to 0.9 of the flank (0.02 modules).
    expected = (4.8462, 5.0809, 5.9195, 7.7519, 11.5654)
    pair = pair_18_47(bores_m=((9 - 1.25) * 3.5e-3 / 2.17, 20e-3), face_width_m=1.0, youngs_modulus_pa=1.0)
    start, tip = pair.pinion.involute_start_roll_rad, pair.pinion.tip_roll_rad
    rolls = start + np.array([0.1, 0.3, 0.5, 0.7, 0.9]) * (tip - start)
    # The default of the package, so that this guards it; measured 0.2 %, wanted 3 %.
    np.testing.assert_allclose(tooth_compliance(pair, "pinion", rolls, StiffnessOptions()).total, expected, rtol=5e-3)


@given(st.floats(0.5, 4.5), st.floats(0.1, 0.6), st.floats(0.05, 0.5))
def test_damage_adds_what_it_adds_to_the_trochoid(height_mm, half_mm, depth_mm):
    pair = pair_18_47()
    pits = [pit(height_mm, a_mm=half_mm, b_mm=half_mm, depth_mm=depth_mm)]
    rolls = flank_rolls(pair, "pinion")
    for part in PARTS:
        added = [
            getattr(tooth_compliance(pair, "pinion", rolls, options, pits), part)
            - getattr(tooth_compliance(pair, "pinion", rolls, options), part)
            for options in (CALIBRATED, TROCHOID)
        ]
        # Differences of compliances of 1e-9 m/N: a few times their rounding of 2e-25.
        np.testing.assert_allclose(added[0], added[1], rtol=1e-9, atol=2e-24)


def test_contacts_below_the_pits_know_nothing_of_them():
    pair = pair_18_47()
    rolls = flank_rolls(pair, "pinion")
    below = rolls < float(pair.pinion.roll_at_height(1.7e-3))
    pitted = tooth_compliance(pair, "pinion", rolls, CALIBRATED, layers(1, 10)).total
    healthy = tooth_compliance(pair, "pinion", rolls, CALIBRATED).total
    np.testing.assert_array_equal(pitted[below], healthy[below])
    assert np.all(pitted[~below] > healthy[~below])


def test_calibrated_mesh_lies_between_the_models_it_replaces_and_a_stiffer_body():
    pair = pair_18_47()
    angle = np.linspace(0, 2 * np.pi / 18, 200, endpoint=False)
    means = {
        beam: np.mean(mesh_stiffness(pair, angle, StiffnessOptions(beam))) for beam in ("rack_trochoid", "calibrated")
    }
    # The trochoid is 4 to 10 % too compliant per tooth (finite elements), the contact dilutes that.
    assert 1.02 < means["calibrated"] / means["rack_trochoid"] < 1.10


def test_scale_law_holds_for_the_calibrated_tooth():
    small, large = pair_18_47(), pair_18_47(7e-3, (25e-3, 40e-3))
    at = np.linspace(small.contact_start_m, small.contact_end_m, 11)
    # k/(E L) knows no length but through h_f; rounding only.
    np.testing.assert_allclose(
        pair_stiffness(small, at, CALIBRATED), pair_stiffness(large, 2 * at, CALIBRATED), rtol=1e-12
    )


def test_a_usual_pair_needs_no_note():
    assert stiffness_notes(pair_18_47(), StiffnessOptions()) == ()


@pytest.mark.parametrize(
    ("pair", "options", "expected"),
    [
        (pair_18_47(bores_m=(3e-3, 20e-3)), CALIBRATED, ("pinion (18 teeth)", "h_f", "1.4 to 7")),
        (pair_18_47(), TROCHOID, ("pinion (18 teeth)", "theta_f", "0.01 to 0.12")),
        (pair_18_47(), StiffnessOptions("base_circle"), ("gear (47 teeth)", "0.585 mm below the root circle")),
        (pair_18_47(poisson_ratio=0.2), CALIBRATED, ("pair", "0.2", "0.25 to 0.35")),
        (
            pair_18_47(),
            StiffnessOptions(hertz="weber_banaschek", hertz_force_n=1e5),
            ("pair", "100000 N", "up to 0.25"),
        ),
    ],
    ids=["calibration", "foundation", "base circle", "poisson", "contact"],
)
def test_a_note_names_the_gear_the_quantity_and_the_limits(pair, options, expected):
    notes = stiffness_notes(pair, options)
    assert len(notes) == 1
    for words in expected:
        assert words in notes[0]


def test_teeth_beyond_the_calibration_are_named_and_get_the_nearest_factor():
    pair = pair_18_47()
    wide = replace(pair, gear=replace(pair.gear, teeth=120, bore_radius_m=60e-3))
    notes = stiffness_notes(wide, CALIBRATED)
    assert len(notes) == 1
    assert "gear (120 teeth)" in notes[0]
    assert "17 to 100" in notes[0]
    assert np.all(np.isfinite(tooth_compliance(wide, "gear", flank_rolls(wide, "gear"), CALIBRATED).total))
