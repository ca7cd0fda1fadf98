from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.noise import noise_spectrum

FS = 51200.0


def densities(length: int, draws: int, **changes: float) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies and the one-sided density, averaged over many draws."""
    rng = np.random.default_rng(9)
    power = sum(np.abs(noise_spectrum(0.3, length, FS, rng, **changes)) ** 2 for _ in range(draws)) / draws
    return np.arange(power.size) * FS / length, power * 2.0 / (length * FS)


@pytest.mark.parametrize("length", [4096, 4095])
def test_white_noise_has_its_density_in_every_band(length: int) -> None:
    frequency, density = densities(length, 200)
    for low in (100.0, 1000.0, 10000.0, 20000.0):
        band = (frequency >= low) & (frequency < 1.2 * low)
        # each of n values averages 200 exponential numbers: four standard errors
        assert density[band].mean() == pytest.approx(0.09, rel=4.0 / np.sqrt(200 * band.sum()))


def test_pink_noise_falls_as_one_over_frequency_through_its_corner() -> None:
    frequency, density = densities(8192, 400, pink_corner_hz=800.0)
    for target in (100.0, 800.0, 6400.0):
        band = np.abs(frequency - target) < 0.2 * target
        mean = (density[band] * frequency[band]).mean()
        assert mean == pytest.approx(0.09 * 800.0, rel=4.0 / np.sqrt(400 * band.sum()))
