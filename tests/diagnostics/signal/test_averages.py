"""Hunting period, what averages leave of the rest, bands round a mesh harmonic and their demodulation."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import hilbert

from diagnostics.signal.averaging_bias import comb_gain
from diagnostics.signal.demodulation import demodulated
from diagnostics.signal.difference_signal import separated_average
from diagnostics.signal.hunting_average import hunting_average, hunting_meshes
from diagnostics.signal.mesh_band import mesh_band, mesh_baseband
from diagnostics.signal.synchronous_average import synchronous_average
from siggen.errors import UsageError

TEETH, STEPS = (6, 7), 16
TURN = TEETH[0] * STEPS
ANGLE = 2 * np.pi * np.arange(18 * 64) / (18 * 64)


def both_shafts(periods: int) -> np.ndarray:
    angle = 2 * np.pi * np.arange(periods * hunting_meshes(TEETH) * STEPS) / TURN
    return np.cos(6 * angle) + 0.5 * np.cos(5 * angle) + 0.3 * np.cos(6 / 7 * angle)


def test_hunting_average_keeps_what_belongs_to_both_shafts() -> None:
    period = both_shafts(1)
    np.testing.assert_allclose(hunting_average(both_shafts(3)[:-10], TEETH, STEPS), period, atol=1e-12)
    assert hunting_meshes((18, 47)) == 18 * 47
    assert hunting_meshes((18, 36)) == 36


def test_record_shorter_than_a_hunting_period_is_refused_with_the_revolutions_it_needs() -> None:
    with pytest.raises(UsageError, match=r"6/7 teeth takes 7"):
        hunting_average(both_shafts(1)[:-1], TEETH, STEPS)


def test_pinion_average_over_a_hunting_period_is_free_of_the_gear_and_else_holds_the_comb_gain() -> None:
    gear = 0.3 * np.cos(6 / 7 * 2 * np.pi * np.arange(21 * TURN) / TURN)
    assert np.abs(synchronous_average(gear, 6, STEPS).signal).max() < 1e-14
    left = np.abs(synchronous_average(gear[: 10 * TURN], 6, STEPS).signal).max()
    gain = 0.3 * comb_gain(np.array([6 / 7]), 10)[0]
    # the comb gain is that of the largest phase, met within one of 96 angle steps
    assert 0.99 * gain < left <= gain * (1 + 1e-12)


@given(order=st.floats(0.05, 5.95), revolutions=st.integers(1, 60))
def test_comb_gain_is_the_magnitude_of_the_mean_of_the_phasors(order: float, revolutions: int) -> None:
    naive = abs(sum(np.exp(2j * np.pi * order * m) for m in range(revolutions))) / revolutions
    assert comb_gain(np.array([order]), revolutions)[0] == pytest.approx(naive, abs=1e-9)


def test_band_is_what_orders_it_names() -> None:
    inside = np.cos(18 * ANGLE) + 0.2 * np.cos(14 * ANGLE + 1)
    average = inside + np.cos(13 * ANGLE) + np.cos(36 * ANGLE) + 5.0
    np.testing.assert_allclose(mesh_band(average, 18, 1, 4), inside, atol=1e-12)
    with pytest.raises(ValueError, match="half width"):
        mesh_band(average, 18, 1, 9)


def test_amplitude_and_phase_are_read_apart() -> None:
    amplitude, phase = 3.0 * (1 + 0.2 * np.cos(2 * ANGLE)), 0.1 * np.sin(ANGLE)
    average = amplitude * np.cos(36 * ANGLE + phase + 0.4) + np.cos(18 * ANGLE)
    found = demodulated(average, 18, 2, 8)
    # sidebands beyond the eighth hold J_7(0.1) < 1e-12 of the line
    np.testing.assert_allclose(found.amplitude, amplitude, atol=1e-8)
    np.testing.assert_allclose(found.phase_rad, phase, atol=1e-8)


def test_number_of_removed_harmonics_can_be_stated() -> None:
    average = sum(np.cos(18 * h * ANGLE) for h in (1, 2, 3))
    np.testing.assert_allclose(separated_average(average, 18, harmonics=2).residual, np.cos(54 * ANGLE), atol=1e-12)


@pytest.mark.parametrize(("harmonic", "half_width"), [(1, 6), (3, 8), (1, 0)])
def test_baseband_has_the_envelope_and_the_lines_of_the_mesh_band(harmonic: int, half_width: int) -> None:
    average = np.random.default_rng(4).standard_normal(18 * 128)
    band = mesh_band(average, 18, harmonic, half_width)
    baseband = mesh_baseband(average, 18, harmonic, half_width)
    np.testing.assert_allclose(np.abs(baseband), np.abs(hilbert(band)), rtol=1e-12, atol=1e-14)
    carrier = np.exp(2j * np.pi * (harmonic * 18 * np.arange(average.size) % average.size) / average.size)
    np.testing.assert_allclose((baseband * carrier).real, band, atol=1e-14)


def test_baseband_weighs_the_last_line_of_an_even_length_once() -> None:
    average = np.random.default_rng(4).standard_normal(2 * (18 + 4))
    np.testing.assert_allclose(np.abs(mesh_baseband(average, 18, 1, 4)), np.abs(hilbert(mesh_band(average, 18, 1, 4))))
