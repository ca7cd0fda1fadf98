"""Every indicator on a signal whose value follows from its definition."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.indicators.average import energy_ratio, fm0, fm4, noise_share
from diagnostics.indicators.level import crest_factor, kurtosis, rms
from diagnostics.indicators.sidebands import relative_amplitude, sideband_index, sideband_level_factor, sideband_ratio
from diagnostics.signal.shaft_signals import separated_average
from diagnostics.signal.spectrum import line_amplitudes

TEETH = 18
SAMPLES = TEETH * 128
ANGLE = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
SINE = 3.0 * np.cos(TEETH * ANGLE)


def modulated(index: float) -> np.ndarray:
    return 3.0 * (1.0 + index * np.cos(ANGLE)) * np.cos(TEETH * ANGLE)


def test_sine_has_its_textbook_values() -> None:
    assert rms(SINE) == pytest.approx(3.0 / math.sqrt(2))
    assert crest_factor(SINE) == pytest.approx(math.sqrt(2))
    assert kurtosis(SINE) == pytest.approx(1.5)
    assert fm0(SINE, line_amplitudes(SINE), TEETH, 5) == pytest.approx(2.0)


def test_gaussian_noise_has_kurtosis_three() -> None:
    noise = np.random.default_rng(1).standard_normal(200_000)
    assert kurtosis(noise) == pytest.approx(3.0, abs=4 * math.sqrt(24 / 200_000))  # four standard errors


def test_fm4_of_mesh_tones_in_gaussian_noise_is_three() -> None:
    rng = np.random.default_rng(2)
    average = modulated(0.5) + 0.01 * rng.standard_normal(SAMPLES)
    parts = separated_average(average, TEETH)
    assert fm4(parts.difference, average) == pytest.approx(3.0, abs=4 * math.sqrt(24 / SAMPLES))  # four standard errors


def test_fm4_of_a_single_tone_between_the_mesh_lines_is_three_halves() -> None:
    average = SINE + 0.2 * np.cos(7 * ANGLE)
    assert fm4(separated_average(average, TEETH).difference, average) == pytest.approx(1.5)


def test_fm4_of_perfect_gears_is_undefined_not_a_ratio_of_rounding_errors() -> None:
    parts = separated_average(SINE, TEETH)
    assert 0.0 < rms(parts.difference) < 1e-12
    assert math.isnan(fm4(parts.difference, SINE))


@given(index=st.floats(0.01, 1.0), harmonic=st.integers(1, 5))
def test_modulation_index_is_read_back(index: float, harmonic: int) -> None:
    signal = 3.0 * (1.0 + index * np.cos(ANGLE)) * np.cos(harmonic * TEETH * ANGLE)
    lines = line_amplitudes(signal)
    assert sideband_index(lines, TEETH, harmonic) / 3.0 == pytest.approx(index / 2)
    assert sideband_ratio(lines, TEETH, harmonic, 3) == pytest.approx(index, rel=1e-6)
    expected = math.sqrt(2) * index / math.sqrt(1 + index**2 / 2)
    assert sideband_level_factor(lines, signal, TEETH, harmonic) == pytest.approx(expected)


def test_known_lines_give_their_ratios() -> None:
    signal = SINE + sum(a * np.cos((TEETH + k) * ANGLE) for k, a in {-3: 0.3, -1: 0.6, 2: 0.9, 4: 1.5}.items())
    lines = line_amplitudes(signal)
    assert relative_amplitude(lines, TEETH, 1, -3) == pytest.approx(0.1)
    assert relative_amplitude(lines, TEETH, 1, 4) == pytest.approx(0.5)
    assert sideband_ratio(lines, TEETH, 1, 3) == pytest.approx(0.6)  # the fourth sideband does not count
    assert sideband_ratio(lines, TEETH, 1, 6) == pytest.approx(1.1)


def test_energy_ratio_is_that_of_the_known_parts() -> None:
    average = SINE + 0.6 * np.cos(7 * ANGLE)
    parts = separated_average(average, TEETH)
    assert energy_ratio(parts.difference, parts.regular) == pytest.approx(0.2)


def test_ratios_without_a_denominator_are_undefined() -> None:
    nothing = np.zeros(SAMPLES)
    lines = line_amplitudes(np.cos(7 * ANGLE))
    assert math.isnan(crest_factor(nothing))
    assert math.isnan(kurtosis(nothing))
    assert math.isnan(kurtosis(np.full(SAMPLES, 0.1)))
    assert math.isnan(energy_ratio(nothing, nothing))
    assert math.isnan(fm0(np.cos(7 * ANGLE), lines, TEETH, 5))
    assert math.isnan(relative_amplitude(lines, TEETH, 1, 1))
    assert math.isnan(sideband_ratio(lines, TEETH, 1))
    assert math.isnan(sideband_level_factor(lines, nothing, TEETH))


def test_sidebands_outside_the_band_or_nearer_to_another_mesh_line_are_undefined() -> None:
    lines = line_amplitudes(SINE)
    assert math.isnan(relative_amplitude(lines, TEETH, 64, 1))
    assert math.isnan(relative_amplitude(lines, TEETH, 1, 9))
    assert math.isnan(sideband_index(lines, TEETH, 64))


@given(scale=st.floats(1e-4, 1e4), seed=st.integers(0, 1000))
def test_ratios_do_not_depend_on_the_unit(scale: float, seed: int) -> None:
    signal = modulated(0.3) + 0.1 * np.random.default_rng(seed).standard_normal(SAMPLES)
    for value in (kurtosis, crest_factor, lambda x: sideband_ratio(line_amplitudes(x), TEETH, 1)):
        assert value(scale * signal) == pytest.approx(value(signal), rel=1e-9)


def test_noise_share_is_that_of_the_noise_put_in() -> None:
    rng = np.random.default_rng(3)
    turn, count = 2.0 * np.cos(2 * np.pi * np.arange(2000) / 2000), 25
    angle_signal = np.tile(turn, count) + rng.standard_normal(turn.size * count)

    def share(steps: np.ndarray) -> float:
        turns = steps.reshape(-1, turn.size)
        return noise_share(turns, turns.mean(axis=0))

    expected = (1 / count) / (2.0 + 1 / count)
    # standard error: sqrt(2/2000) of the average's noise variance and cross terms 2 sqrt(2 s^2/M / 2000)
    assert share(angle_signal) == pytest.approx(expected, rel=0.05)
    assert share(rng.standard_normal(turn.size * count)) == pytest.approx(1.0, abs=0.2)
    assert math.isnan(share(turn))
