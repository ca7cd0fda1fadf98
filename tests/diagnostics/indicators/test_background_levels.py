"""Shaft lines, floors, lines above mesh 5, modulation and tails of noise on signals where they are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnostics.indicators.background_levels import BACKGROUND_LEVELS, background_levels
from diagnostics.records.sample_bytes import BYTES, sample_bytes

TEETH, SHAFT_HZ, FS_HZ = (18, 47), 30.0, 25_600.0
STEPS, TURNS = 1024, 88
TURN = np.arange(STEPS * TURNS) / STEPS


def levels(signal: np.ndarray) -> dict[str, float]:
    return background_levels(signal.reshape(TURNS, STEPS), SHAFT_HZ, TEETH, FS_HZ)


def noise(seed: int = 1) -> np.ndarray:
    return 0.1 * np.random.default_rng(seed).standard_normal(TURN.size)


def tone(order: float, amplitude: float) -> np.ndarray:
    return amplitude * np.cos(2 * np.pi * order * TURN + 0.4)


def test_lines_and_floors_are_those_that_were_planted() -> None:
    found = levels(tone(18, 2.0) + tone(36, 1.0) + tone(1, 0.2) + tone(2, 0.1) + noise())
    assert set(found) == set(BACKGROUND_LEVELS)
    assert found["shaft_1x_db"] == pytest.approx(-20.0, abs=0.3)
    assert found["shaft_2x_db"] == pytest.approx(20 * math.log10(0.1 / 2.0), abs=0.5)
    assert found["strongest_mesh_rms_m_s2"] == pytest.approx(2.0 / math.sqrt(2), rel=0.01)
    # white noise of 0.1 over half of 30 x 1024 Hz, over a mesh power of 2
    white = 10 * math.log10(0.01 / (0.5 * STEPS * SHAFT_HZ) / 2.0)
    for name in ("floor_40_160hz_db", "floor_5_10khz_db"):
        assert found[name] == pytest.approx(white, abs=1.0)
    assert found["floor_slope_db"] == pytest.approx(0.0, abs=1.5)
    assert found["tonality_3500_5000hz_db"] == pytest.approx(10 * math.log10(1 / math.log(2)), abs=0.4)
    assert found["lines_above_mesh5_per_khz"] == 0.0


def test_lines_above_mesh_five_are_counted_and_those_of_neither_shaft_are_told() -> None:
    signal = tone(18, 2.0) + noise()
    for order in (127.0, 171.0, 215.0, 150.37):
        signal = signal + tone(order, 0.1)
    found = levels(signal)
    span_khz = (10_000 - 5.5 * 18 * SHAFT_HZ) / 1000
    assert found["lines_above_mesh5_per_khz"] == pytest.approx(4 / span_khz)
    assert found["foreign_line_share"] == 0.25


def test_noise_is_gaussian_until_a_shaft_or_bursts_modulate_it() -> None:
    still = levels(tone(18, 2.0) + noise())
    assert still["noise_kurtosis_4_8khz"] == pytest.approx(3.0, abs=0.1)
    assert still["noise_envelope_cv_2_4khz"] == pytest.approx(math.sqrt(4 / math.pi - 1), abs=0.02)
    assert still["shaft_depth"] < 0.05
    depth = 0.4
    power = 1.0 + depth * np.cos(2 * np.pi * TURN + 1.0)
    turning = levels(tone(18, 2.0) + noise() * np.sqrt(power))
    assert turning["shaft_depth"] == pytest.approx(depth, abs=0.05)
    # closed form of a periodic modulation: 3 (1 + d^2/2)
    assert turning["noise_kurtosis_4_8khz"] == pytest.approx(3.0 * (1.0 + depth**2 / 2.0), abs=0.15)
    # its level is that of the quietest half turn: the trough, weighed by the square of a Hann window
    apart = np.linspace(-0.25, 0.25, 1001)
    weight = np.cos(2 * np.pi * apart) ** 4
    trough = 1.0 - depth * float((weight * np.cos(2 * np.pi * apart)).sum() / weight.sum())
    assert turning["noise_band9_db"] - still["noise_band9_db"] == pytest.approx(10 * math.log10(trough), abs=0.3)


def test_what_returns_every_turn_is_coherent_and_the_level_of_noise_is_seen_in_its_band() -> None:
    repeated = np.tile(np.random.default_rng(3).standard_normal(STEPS), TURNS)
    assert levels(repeated + noise())["repeated_coherence"] > 0.99
    assert abs(levels(tone(18, 2.0) + noise())["repeated_coherence"]) < 0.25
    louder = levels(tone(18, 2.0) + 2.0 * noise())
    assert louder["noise_band5_db"] - levels(tone(18, 2.0) + noise())["noise_band5_db"] == pytest.approx(6.02, abs=0.01)


def test_bytes_tell_the_converter_whatever_the_level() -> None:
    signal = np.random.default_rng(4).standard_normal(8000)
    for gain in (0.5, 1.0, 4.0):
        coded = sample_bytes((np.round(gain * signal / 2**-12) * 2**-12).astype(np.float32))
        assert coded["converter_step_log2"] == -12.0
    free = sample_bytes(signal.astype(np.float32))
    assert set(free) == set(BYTES)
    assert math.isnan(free["converter_step_log2"])
    held = np.concatenate([signal[:100], np.full(40, signal[99])]).astype(np.float32)
    assert sample_bytes(held)["longest_run"] == 41
    # a step that the first samples do not show, and a converter whose step is no power of two
    late = np.concatenate([np.round(signal * 2**8) * 2**-8, np.zeros(20_000), np.round(signal * 2**9) * 2**-9])
    assert sample_bytes(np.resize(late, 50_000).astype(np.float32))["converter_step_log2"] == -9.0
    third = np.round(np.resize(signal, 40_000) * 300.0).astype(np.float32) / np.float32(300.0)
    assert sample_bytes(third)["converter_step_log2"] == pytest.approx(-math.log2(300.0), abs=1e-3)
    assert math.isnan(sample_bytes(np.ones(100, np.float32))["converter_step_log2"])
