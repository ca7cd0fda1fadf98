"""The calibrated tooth: factor times rack trochoid, damage as on the trochoid, and notes where a model is stretched."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.mesh.calibration import calibration_factor
from siggen.mesh.stiffness_notes import stiffness_notes
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.gears.builders import bare, pair_18_47

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
    pair = bare(pair_18_47(bores_m=((9 - 1.25) * 3.5e-3 / 2.17, 20e-3), face_width_m=1.0, youngs_modulus_pa=1.0))
    start, tip = pair.pinion.involute_start_roll_rad, pair.pinion.tip_roll_rad
    rolls = start + np.array([0.1, 0.3, 0.5, 0.7, 0.9]) * (tip - start)
    # The default of the package, so that this guards it; measured 0.2 %, wanted 3 %.
    np.testing.assert_allclose(tooth_compliance(pair, "pinion", rolls, StiffnessOptions()).total, expected, rtol=5e-3)


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
