"""Noise and lines as recordings showed them: what was asked for is found again in the signal, by its own estimators."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.noise.line_table import LineTable, TableLines
from siggen.noise.source import Draws
from siggen.noise.spectrum import NoiseModulation, NoiseStrength

FS_HZ, SAMPLES, GEAR_ORDER = 10_000.0, 200_000, 18.0 / 47.0
ANGLE_RAD = 2.0 * np.pi * 25.0 * np.arange(SAMPLES) / FS_HZ


def draws(seed: int = 0) -> Draws:
    rng = np.random.default_rng(seed)
    return Draws(lambda _: float(rng.random()), lambda _: 0.5, lambda _: np.random.default_rng(seed + 1))


def depth(strength: np.ndarray, order: float) -> float:
    return float(2.0 * abs((strength * np.exp(-1j * order * ANGLE_RAD)).mean()) / strength.mean())


def test_the_strength_has_mean_one_and_the_depths_that_were_asked_for() -> None:
    asked = NoiseModulation(driver_depth=0.3, driven_depth=0.2, level_std=0.0)
    strength = NoiseStrength(asked, draws(), GEAR_ORDER, FS_HZ).take(ANGLE_RAD)
    # 500 turns of the pinion, 191.5 of the gear: what half a turn leaves is below 1/100
    assert strength.mean() == pytest.approx(1.0, abs=0.01)
    for order, value in ((1.0, 0.3), (2.0, 0.3 / 2**0.5), (GEAR_ORDER, 0.2)):
        assert depth(strength, order) == pytest.approx(value, abs=0.01)


def test_the_random_level_gives_the_kurtosis_of_its_closed_form(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("siggen.noise.spectrum.LEVEL_TIME_MS", 1.0)
    asked = NoiseModulation(level_std=0.4)
    level = NoiseStrength(asked, draws(), GEAR_ORDER, FS_HZ).take(ANGLE_RAD)
    noise = np.random.default_rng(5).standard_normal(SAMPLES) * np.sqrt(level)
    kurtosis = np.mean(noise**4) / np.mean(noise**2) ** 2
    # 20,000 independent levels and 200,000 samples: 3 exp(0.16) = 3.52 within 2 %, twice its standard error
    assert kurtosis == pytest.approx(3.0 * np.exp(0.16), rel=0.03)


def test_lines_stand_at_their_order_and_frequency_and_none_beyond_the_band() -> None:
    table = LineTable(order=(4.125, 0.0, 230.0), frequency_hz=(0.0, 777.0, 0.0), amplitude_m_s2=(2.0, 0.5, 9.0))
    signal = TableLines(table, draws(), FS_HZ, 2.0 * np.pi * 25.0 / FS_HZ).at(ANGLE_RAD, 0)
    time_s = np.arange(SAMPLES) / FS_HZ
    found = [2.0 * abs((signal * np.exp(-2j * np.pi * hz * time_s)).mean()) for hz in (4.125 * 25.0, 777.0)]
    assert found == pytest.approx([2.0, 0.5], rel=1e-3)
    assert signal.std() == pytest.approx(np.sqrt(0.5 * (2.0**2 + 0.5**2)), rel=1e-3)
