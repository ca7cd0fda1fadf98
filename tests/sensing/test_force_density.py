"""Densities of force noise: closed forms of their power, and noise that has them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.seeding import Stream, generator
from siggen.sensing.noise import contact_bandwidth_hz, contact_filter, noise_spectrum, rising_floor, tabulated

FS, LENGTH = 25600.0, 51200
GRID = np.arange(LENGTH // 2 + 1) * FS / LENGTH


@pytest.mark.parametrize("steepness", [1.0, 1.37, 2.0])
def test_the_power_behind_a_contact_is_its_closed_form(steepness: float) -> None:
    power = quad(lambda f: float(contact_filter(np.array([f]), 3000.0, steepness)[0]) ** 2, 0.0, np.inf)[0]
    assert contact_bandwidth_hz(3000.0, steepness) == pytest.approx(power, rel=1e-6)


def test_noise_has_its_density_in_every_band() -> None:
    density = 0.2 * rising_floor(GRID, 100.0, 2.0)
    noise = np.fft.irfft(density * noise_spectrum(1.0, LENGTH, FS, generator(3, Stream.BACKGROUND, 0)), LENGTH)
    power = np.abs(np.fft.rfft(noise)) ** 2 / (LENGTH * FS / 2.0)
    for low, high in ((20.0, 60.0), (60.0, 500.0), (500.0, 5000.0), (5000.0, 12000.0)):
        band = (low < GRID) & (high > GRID)
        # a mean over n bins scatters by 1/√n of itself
        assert power[band].mean() == pytest.approx((density[band] ** 2).mean(), rel=5.0 / np.sqrt(band.sum()))


def test_the_floor_rises_below_its_corner_alone() -> None:
    found = rising_floor(np.array([0.0, 1.0, 100.0, 1e5]), 100.0, 2.0)
    assert found == pytest.approx([100.005, 100.005, np.sqrt(2.0), 1.0], rel=1e-4)


def test_a_table_is_straight_in_double_logarithms_and_stays_beyond_its_ends() -> None:
    found = tabulated(np.array([0.0, 10.0, 100.0, 1000.0, 1e4]), (10.0, 1000.0), (1.0, 0.01))
    np.testing.assert_allclose(found, [1.0, 1.0, 0.1, 0.01, 0.01])
    assert tabulated(np.array([0.2]), (0.1, 0.4), (1.0, 4.0)) == pytest.approx(2.0)  # knots may lie close
