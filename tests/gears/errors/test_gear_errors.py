from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.gears.errors import FLANK_POINTS, deviations, eccentric_m, slopes, without_line
from siggen.gears.gear_pair import GearPair
from tests.gears.builders import pair_18_47, spur_gear
from tests.gears.erroneous_gears import drawn, limits, only_eccentric

PAIR = pair_18_47(module_m=3e-3, bores_m=(10e-3, 15e-3))
SMALL = GearPair(spur_gear(9, 3e-3, 4e-3, 0.5), spur_gear(11, 3e-3, 5e-3, 0.5), 20e-3, 206e9, 0.3)
SLACK = 1.0 + 1e-9
"""Rounding: sums of numbers near their limit."""


@settings(max_examples=100, deadline=None)
@given(
    st.sampled_from([PAIR, SMALL]),
    st.sampled_from(["pinion", "gear"]),
    st.integers(0, 2**31),
    st.integers(1, 11),
    st.floats(0.01, 1.0),
    st.floats(0.0, 1.0),
)
def test_every_deviation_stays_within_its_share_and_one_of_its_kind_reaches_it(
    pair: GearPair, which: str, seed: int, accuracy_class: int, share: float, runout_share: float
) -> None:
    allowed = limits(pair, which, accuracy_class, share)
    found = deviations(pair, which, drawn(pair, which, seed, accuracy_class, share, runout_share)).largest
    ratio = {name: value / getattr(allowed, name) for name, value in found.items()}
    assert all(value <= SLACK for value in ratio.values()), ratio
    assert max(ratio["pitch_m"], ratio["cumulative_pitch_m"]) == pytest.approx(1.0, abs=1e-9)
    assert max(ratio["profile_slope_m"], ratio["profile_form_m"], ratio["profile_m"]) == pytest.approx(1.0, abs=1e-9)
    if pair is PAIR:
        assert ratio["runout_m"] == pytest.approx(runout_share, abs=1e-9)


def test_few_teeth_turn_so_far_in_mesh_that_eccentricity_alone_can_use_up_the_profile() -> None:
    found = deviations(SMALL, "pinion", drawn(SMALL, "pinion", 3, 6, 0.4, 1.0)).largest
    allowed = limits(SMALL, "pinion", 6, 0.4)
    assert found["runout_m"] < 0.9 * allowed.runout_m
    assert found["profile_slope_m"] == pytest.approx(allowed.profile_slope_m, rel=1e-6)


def test_an_eccentric_gear_measures_as_the_textbook_says() -> None:
    e, angle = 5e-6, PAIR.pinion.pressure_angle_rad
    for which, teeth in (("pinion", 18), ("gear", 47)):
        found = deviations(PAIR, which, only_eccentric(PAIR, which, e)).largest
        assert found["runout_m"] == 2.0 * e
        # Peaks of 18 or 47 samples of a cosine miss its own by 1 - cos(π/z) at most, steps likewise.
        assert found["cumulative_pitch_m"] == pytest.approx(2.0 * e / cos(angle), rel=2.0 * (1.0 - cos(pi / teeth)))
        assert found["pitch_m"] == pytest.approx(2.0 * e / cos(angle) * sin(pi / teeth), rel=1.0 - cos(pi / teeth))


def test_eccentricity_moves_all_pairs_in_mesh_alike() -> None:
    errors = only_eccentric(PAIR, "gear", 5e-6)
    start, pitch = PAIR.contact_start_m, PAIR.base_pitch_m
    newer = eccentric_m(PAIR, "gear", errors, start + np.array([0.1, 0.3]) * pitch)
    older = eccentric_m(PAIR, "gear", errors, start + np.array([1.1, 1.3]) * pitch)
    # At one instant tooth k is where tooth k - 1 was a base pitch earlier.
    np.testing.assert_allclose(newer, np.roll(older, 1, axis=0), atol=1e-20)


def test_slopes_are_those_of_one_tool_and_waves_have_the_cycles_that_were_asked_for() -> None:
    errors = drawn(PAIR, "gear", 8)
    assert (np.sign(errors.slope_m) == np.sign(errors.slope_m[0])).all()
    assert errors.slope_m.std() / abs(errors.slope_m.mean()) == pytest.approx(0.1, rel=0.5)
    np.testing.assert_allclose(slopes(errors.form_m), 0.0, atol=1e-18)
    window = without_line(errors.form_m)
    spectrum = np.abs(np.fft.rfft(window, 20 * FLANK_POINTS, axis=1))
    cycles = spectrum.argmax(axis=1) / 20.0
    # Freeing a wave of its line pulls its peak by up to half a cycle.
    assert ((cycles > 2.0) & (cycles < 4.0)).all()
