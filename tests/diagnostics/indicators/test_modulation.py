"""Indicators of modulation on mesh lines whose modulation is known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import jv

from diagnostics.indicators.cepstrum import cepstral_peak, shaft_log_spectrum
from diagnostics.indicators.sidebands import (
    amplitude_modulation,
    phase_modulation_rad,
    sideband_asymmetry_db,
    sideband_power,
)
from diagnostics.signal.mesh_band import Modulation, demodulated
from diagnostics.signal.spectrum import hann_amplitude, line_amplitudes

TEETH, SAMPLES = 18, 18 * 128
ANGLE = 2 * np.pi * np.arange(SAMPLES) / SAMPLES


def mesh(depth: float, order: int = 1, harmonics: int = 3) -> np.ndarray:
    line = sum(np.cos(h * TEETH * ANGLE + h) / h for h in range(1, harmonics + 1))
    return np.asarray((1 + depth * np.cos(order * ANGLE + 0.4)) * line)


@given(depth=st.floats(0.01, 1.0), order=st.integers(1, 6))
def test_sideband_power_of_amplitude_modulation_is_half_its_square(depth: float, order: int) -> None:
    lines = line_amplitudes(mesh(depth, order))
    assert sideband_power(lines, TEETH, order, 3) == pytest.approx(depth**2 / 2)
    assert sideband_power(lines, TEETH, order % 6 + 1, 3) == pytest.approx(0.0, abs=1e-20)


def test_sideband_power_by_correlation_with_each_line() -> None:
    signal = np.random.default_rng(1).standard_normal(SAMPLES)

    def power(order: int) -> float:
        return float(np.dot(signal, np.cos(order * ANGLE)) ** 2 + np.dot(signal, np.sin(order * ANGLE)) ** 2)

    expected = sum(power(h * TEETH - 2) + power(h * TEETH + 2) for h in (1, 2, 3)) / sum(
        power(h * TEETH) for h in (1, 2, 3)
    )
    assert sideband_power(line_amplitudes(signal), TEETH, 2, 3) == pytest.approx(expected)


def test_sideband_power_without_a_line_or_outside_the_band_is_undefined() -> None:
    lines = line_amplitudes(np.cos(7 * ANGLE))
    assert math.isnan(sideband_power(lines, TEETH, 1, 3))
    assert math.isnan(sideband_power(line_amplitudes(mesh(0.1)), TEETH, 9, 3))
    assert math.isnan(sideband_power(line_amplitudes(mesh(0.1)), TEETH, 1, 64))
    unresolved = line_amplitudes(mesh(0.1))
    unresolved[TEETH + 1] = np.nan
    assert math.isnan(sideband_power(unresolved, TEETH, 1, 3))


@given(depth=st.floats(0.0, 0.99), harmonic=st.integers(1, 3))
def test_amplitude_modulation_is_its_index(depth: float, harmonic: int) -> None:
    found = demodulated(mesh(depth), TEETH, 3, 8)[harmonic - 1]
    assert amplitude_modulation(found) == pytest.approx(depth, abs=1e-9)
    assert phase_modulation_rad(found) == pytest.approx(0.0, abs=1e-9)


@given(depth=st.floats(0.001, 0.5))
def test_phase_modulation_is_its_depth(depth: float) -> None:
    (found,) = demodulated(np.cos(TEETH * ANGLE + depth * np.sin(ANGLE + 0.3)), TEETH, 1, 8)
    # what lies beyond the eighth sideband, J_9(0.5) = 1e-11, is cut off
    assert phase_modulation_rad(found) == pytest.approx(depth, abs=1e-9)
    assert amplitude_modulation(found) == pytest.approx(0.0, abs=1e-9)


def test_mesh_line_weaker_than_its_sidebands_has_no_phase_depth() -> None:
    weak = 0.2 * np.cos(TEETH * ANGLE) + np.cos((TEETH + 1) * ANGLE)
    assert math.isnan(phase_modulation_rad(demodulated(weak, TEETH, 1, 6)[0]))
    (nothing,) = demodulated(np.zeros(SAMPLES), TEETH, 1, 6)
    assert math.isnan(phase_modulation_rad(nothing))
    assert math.isnan(amplitude_modulation(nothing))


def test_phase_that_swings_by_a_turn_has_no_depth_at_any_order() -> None:
    # cos(z a + 3.3 sin 3a + 0.1 sin a): once per revolution 0.1 rad only, but the carrier is gone at times
    swinging = Modulation(np.ones(SAMPLES), 3.3 * np.sin(3 * ANGLE) + 0.1 * np.sin(ANGLE))
    assert math.isnan(phase_modulation_rad(swinging))
    assert phase_modulation_rad(Modulation(np.ones(SAMPLES), 3.0 * np.sin(3 * ANGLE) + 0.1 * np.sin(ANGLE))) == (
        pytest.approx(0.1)
    )


def test_asymmetry_of_amplitude_and_phase_modulation_together() -> None:
    # (1 + m cos a) cos(z a + b sin a): sidebands J_1 + m/2 (J_0 + J_2) above, the same with -J_1 below
    depth, beta = 0.3, 0.2
    signal = (1 + depth * np.cos(ANGLE)) * np.cos(TEETH * ANGLE + beta * np.sin(ANGLE))
    common = depth / 2 * (jv(0, beta) + jv(2, beta))
    expected = 20 * math.log10(abs(common + jv(1, beta)) / abs(common - jv(1, beta)))
    assert sideband_asymmetry_db(line_amplitudes(signal), TEETH, 1) == pytest.approx(expected)
    assert sideband_asymmetry_db(line_amplitudes(mesh(0.3)), TEETH, 2) == pytest.approx(0.0, abs=1e-9)
    assert math.isnan(sideband_asymmetry_db(line_amplitudes(np.zeros(SAMPLES)), TEETH, 1))


def test_echo_after_one_revolution_stands_in_the_cepstrum_of_that_shaft_only() -> None:
    revolutions, per_turn = 24, 18 * 32
    rng = np.random.default_rng(2)
    noise = rng.standard_normal(revolutions * per_turn)
    echo = noise + 0.5 * np.roll(noise, per_turn)
    highest = per_turn // 2
    pinion, gear = 2 * highest, 2 * highest * 47 / 18
    found = shaft_log_spectrum(hann_amplitude(echo), revolutions, 18, highest)
    # noise in a cepstral bin: log of a Hann-weighted amplitude has deviation 0.64, over sqrt(13824/1.5 bins / 2)
    spread = 4 * 0.64 / math.sqrt(revolutions * per_turn / 3)
    assert cepstral_peak(found, pinion) == pytest.approx(0.25, abs=spread + 0.02)  # 0.02: the window over the echo
    assert abs(cepstral_peak(found, gear)) < spread
    assert math.isnan(cepstral_peak(found, found.size - 1))
    assert math.isfinite(cepstral_peak(found, found.size - 2))


def test_cepstral_peak_is_the_largest_within_one_step_of_the_revolution() -> None:
    size, period = 4001, 320.4
    for aside, share in ((0.0, 1.0), (1.0, 1.0), (-1.0, 1.0), (3.0, 0.0)):
        ripple = 0.6 * np.cos(2 * np.pi * np.arange(size) * (period + aside) / (2 * (size - 1)))
        assert cepstral_peak(ripple, period) == pytest.approx(0.3 * share, abs=0.001)


def test_mesh_lines_alone_leave_nothing_at_the_pinions_quefrency() -> None:
    revolutions, per_turn = 24, 18 * 32
    angle = 2 * np.pi * np.arange(revolutions * per_turn) / per_turn
    tones = sum(np.cos(h * 18 * angle) for h in range(1, 8))
    signal = tones + 0.01 * np.random.default_rng(3).standard_normal(angle.size)
    raw = shaft_log_spectrum(hann_amplitude((1 + 0.5 * np.cos(angle)) * signal), revolutions, 18, per_turn // 2)
    clean = shaft_log_spectrum(hann_amplitude(signal), revolutions, 18, per_turn // 2)
    assert abs(cepstral_peak(clean, per_turn)) < 0.05
    assert cepstral_peak(raw, per_turn) > cepstral_peak(clean, per_turn)
