"""The change of a spectrum's floor gives back the gain and the tilt of a filter."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.audit.spectral_shape import BANDS, LOWEST, floor_levels, shape_changes

SAMPLES = 38_400
NOISE = np.random.default_rng(0).normal(size=SAMPLES)
REFERENCE = np.array([-1, 0])


def change(signal: np.ndarray) -> dict[str, float]:
    floors = {"a": np.stack([floor_levels(NOISE), floor_levels(signal)])}
    return {name: float(values[1]) for name, values in shape_changes(floors, REFERENCE).items()}


def test_a_gain_moves_the_floor_by_its_decibels_and_gives_it_no_shape() -> None:
    found = change(1.01 * NOISE)
    assert found.pop("change of the floor of a") == pytest.approx(20.0 * np.log10(1.01), abs=1e-5)
    assert max(map(abs, found.values())) < 1e-5  # float32 of some 30 dB


def test_a_tilt_comes_back_as_the_slope_over_the_bands_that_count() -> None:
    gain = 10.0 ** (-0.2 / 20.0 * np.fft.rfftfreq(SAMPLES) / 0.5)
    found = change(np.fft.irfft(np.fft.rfft(NOISE) * gain, SAMPLES))
    # frames and bands average the gain over their width, some 2 % of the tilt
    assert found["slope of the floor of a"] == pytest.approx(-0.2 * (1.0 - LOWEST / BANDS), rel=0.03)
