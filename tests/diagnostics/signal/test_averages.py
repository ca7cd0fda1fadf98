"""What averages leave of the rest, bands round a mesh harmonic and their demodulation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import hilbert

from diagnostics.signal.mesh_band import demodulated, mesh_basebands
from diagnostics.signal.shaft_signals import separated_average
from diagnostics.signal.synchronous_average import synchronous_average

TEETH, STEPS = (6, 7), 16
TURN = TEETH[0] * STEPS
ANGLE = 2 * np.pi * np.arange(18 * 64) / (18 * 64)


def test_pinion_average_over_a_hunting_period_is_free_of_the_gear_and_else_holds_the_comb_gain() -> None:
    gear = 0.3 * np.cos(6 / 7 * 2 * np.pi * np.arange(21 * TURN) / TURN)
    assert np.abs(synchronous_average(gear, 6, STEPS).signal).max() < 1e-14
    left = np.abs(synchronous_average(gear[: 10 * TURN], 6, STEPS).signal).max()
    gain = 0.3 * abs(np.sin(np.pi * 6 / 7 * 10) / np.sin(np.pi * 6 / 7)) / 10
    # the gain of a comb filter, McFadden 1987, is that of the largest phase, met within one of 96 angle steps
    assert 0.99 * gain < left <= gain * (1 + 1e-12)


def test_bands_that_meet_are_refused() -> None:
    with pytest.raises(ValueError, match="half width"):
        mesh_basebands(np.cos(18 * ANGLE), 18, 1, 9)


def test_amplitude_and_phase_are_read_apart() -> None:
    amplitude, phase = 3.0 * (1 + 0.2 * np.cos(2 * ANGLE)), 0.1 * np.sin(ANGLE)
    average = amplitude * np.cos(36 * ANGLE + phase + 0.4) + np.cos(18 * ANGLE)
    found = demodulated(average, 18, 2, 8)[1]
    # sidebands beyond the eighth hold J_7(0.1) < 1e-12 of the line
    np.testing.assert_allclose(found.amplitude, amplitude, atol=1e-8)
    np.testing.assert_allclose(found.phase_rad, phase, atol=1e-8)


def test_number_of_removed_harmonics_can_be_stated() -> None:
    average = sum(np.cos(18 * h * ANGLE) for h in (1, 2, 3))
    np.testing.assert_allclose(separated_average(average, 18, harmonics=2).residual, np.cos(54 * ANGLE), atol=1e-12)


def mesh_band(average: np.ndarray, harmonic: int, half_width: int) -> np.ndarray:
    """What an average holds within orders of a mesh line, by the inverse of its chosen lines."""
    lines = np.fft.rfft(average)
    lines[np.abs(np.arange(lines.size) - 18 * harmonic) > half_width] = 0.0
    return np.fft.irfft(lines, n=average.size)


@pytest.mark.parametrize(("harmonic", "half_width"), [(1, 6), (3, 8), (1, 0)])
def test_baseband_has_the_envelope_and_the_lines_of_the_mesh_band(harmonic: int, half_width: int) -> None:
    average = np.random.default_rng(4).standard_normal(18 * 128)
    band = mesh_band(average, harmonic, half_width)
    baseband = mesh_basebands(average, 18, 3, half_width)[harmonic - 1]
    np.testing.assert_allclose(np.abs(baseband), np.abs(hilbert(band)), rtol=1e-12, atol=1e-14)
    carrier = np.exp(2j * np.pi * (harmonic * 18 * np.arange(average.size) % average.size) / average.size)
    np.testing.assert_allclose((baseband * carrier).real, band, atol=1e-14)


def test_baseband_weighs_the_last_line_of_an_even_length_once() -> None:
    average = np.random.default_rng(4).standard_normal(2 * (18 + 4))
    np.testing.assert_allclose(np.abs(mesh_basebands(average, 18, 1, 4)[0]), np.abs(hilbert(mesh_band(average, 1, 4))))
