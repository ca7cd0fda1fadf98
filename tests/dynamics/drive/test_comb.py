"""Combs of lines against sums of cosines, one by one."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.drivetrain.comb import Comb, harmonic_sum, turns_of

ANGLE = np.linspace(-40.0, 200.0, 3001)


def test_a_comb_is_the_sum_of_its_harmonics_each_with_two_sidebands() -> None:
    comb = Comb(4.125, np.array([3.0, 2.0, 1.0]), np.array([0.3, 1.0, -2.0]), 0.2, 0.38, 0.7)
    expected = np.zeros_like(ANGLE)
    for h, (a, phase) in enumerate(zip(comb.amplitude_n, comb.phase_rad, strict=True), start=1):
        expected += a * np.cos(h * 4.125 * ANGLE + phase)
        for sign in (1.0, -1.0):
            expected += 0.2 * a * np.cos((h * 4.125 + sign * 0.38) * ANGLE + phase + sign * 0.7)
    found = comb.force_n(turns_of(ANGLE, 4.125), turns_of(ANGLE, 0.38))
    np.testing.assert_allclose(found, expected, atol=1e-10)


def test_harmonics_beyond_the_band_are_left_out() -> None:
    comb = Comb(5.0, np.array([1.0, 1.0, 1.0]), np.zeros(3), 0.1, 1.0)
    turns, beside = turns_of(ANGLE, 5.0), turns_of(ANGLE, 1.0)
    kept = Comb(5.0, np.array([1.0, 1.0]), np.zeros(2), 0.1, 1.0).force_n(turns, beside)
    np.testing.assert_array_equal(comb.force_n(turns, beside, 16.0), kept)  # the third's sideband is at 16
    assert comb.force_n(turns, beside, 1.0).any() == np.False_


@pytest.mark.parametrize("count", range(1, 10))
def test_sums_found_side_by_side_are_those_of_the_plain_rule(count: int) -> None:
    rng = np.random.default_rng(count)
    turns, phasors = turns_of(rng.normal(size=count), 1.0), rng.normal(size=5) + 1j * rng.normal(size=5)
    expected = []
    for turn in turns.tolist():
        total = 0j
        for phasor in phasors[::-1].tolist():
            total = (total + phasor) * turn
        expected.append(total.real)
    assert harmonic_sum(turns, phasors).tobytes() == np.array(expected).tobytes()
