"""Indicators made of moments: closed forms, and a second computation in plain loops or by scipy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.indicators import history
from diagnostics.indicators.average import energy_operator_lebold, energy_operator_teager, fm4, m6a, m8a, teager_energy
from diagnostics.indicators.history import central_moments, dominant_harmonic
from diagnostics.indicators.level import spectral_kurtosis_maximum
from diagnostics.signal.mesh_band import mesh_basebands
from diagnostics.signal.spectrum import line_amplitudes

TEETH, SAMPLES = 18, 18 * 128
ANGLE = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
TONE = 0.7 * np.cos(7 * ANGLE)


def moments(signals: list[np.ndarray]) -> tuple[float, list[float]]:
    """Return the fourth moment of the last signal and the variances of all."""
    found = [central_moments(signal) for signal in signals]
    return found[-1][0], [second for _, second in found]


def na4(residuals: list[np.ndarray]) -> float:
    return history.na4(*moments(residuals))


def na4_star(residuals: list[np.ndarray], healthy: int) -> float:
    fourth, second = moments(residuals)
    return history.na4_star(fourth, second[:healthy])


def nb4(averages: list[np.ndarray], teeth: int, harmonic: int, half_width: int) -> float:
    return history.nb4(*moments([np.abs(mesh_basebands(a, teeth, harmonic, half_width)[-1]) for a in averages]))


@pytest.mark.parametrize(("indicator", "order", "value"), [(fm4, 4, 3.0), (m6a, 6, 15.0), (m8a, 8, 105.0)])
def test_gaussian_values_within_four_standard_errors(indicator: object, order: int, value: float) -> None:
    count = 400_000
    noise = np.random.default_rng(order).standard_normal(count)
    # mu_k/mu_2^(k/2) has variance (E x^2k - (E x^k)^2 - k^2/4 * 2 (E x^k)^2 ...)/N <= (E x^2k - (E x^k)^2)/N
    spread = math.sqrt((math.prod(range(1, 2 * order, 2)) - value**2) / count)
    assert indicator(noise, noise) == pytest.approx(value, abs=4 * spread)  # type: ignore[operator]


@pytest.mark.parametrize(("indicator", "value"), [(fm4, 1.5), (m6a, 2.5), (m8a, 4.375)])
def test_sine_values(indicator: object, value: float) -> None:
    assert indicator(TONE, TONE) == pytest.approx(value, rel=1e-12)  # type: ignore[operator]
    assert math.isnan(indicator(1e-12 * TONE, TONE))  # type: ignore[operator]


@given(seed=st.integers(0, 10_000), count=st.integers(8, 200))
def test_moments_are_those_of_the_sums_with_their_powers_of_n(seed: int, count: int) -> None:
    signal = np.random.default_rng(seed).standard_normal(count) ** 3
    mean = sum(signal.tolist()) / count
    second, sixth, eighth = (sum((x - mean) ** k for x in signal.tolist()) for k in (2, 6, 8))
    assert m6a(signal, signal) == pytest.approx(count**2 * sixth / second**3)
    assert m8a(signal, signal) == pytest.approx(count**3 * eighth / second**4)


def naive_na4(records: list[np.ndarray]) -> float:
    last, count = records[-1].tolist(), records[-1].size
    mean = sum(last) / count
    numerator = count * sum((x - mean) ** 4 for x in last)
    total = 0.0
    for record in records:
        mean = sum(record.tolist()) / count
        total += sum((x - mean) ** 2 for x in record.tolist())
    return numerator / (total / len(records)) ** 2


def test_na4_is_kurtosis_at_first_and_then_compares_with_the_history() -> None:
    rng = np.random.default_rng(5)
    records = [scale * rng.standard_normal(500) for scale in (1.0, 1.1, 0.9, 2.0)]
    assert na4([TONE]) == pytest.approx(1.5)
    assert na4(records[:1]) == pytest.approx(3.0, abs=4 * math.sqrt(24 / 500))  # four standard errors
    for count in range(1, 5):
        assert na4(records[:count]) == pytest.approx(naive_na4(records[:count]))


def test_growing_fault_tone_follows_its_closed_form_and_a_published_worked_example() -> None:
    # amplitude k/3 in record k: 1.5 k^4 / (mean of j^2, j = 1 ... k)^2; the values printed in the documentation of
    # onebone 1.3.1 are for records that are no whole number of samples long, whose leakage adds up to 2.5 %
    published = (1.5370, 3.8577, 5.5903, 6.8353, 7.7552, 8.4577, 9.0097, 9.4542, 9.8194, 10.1245)
    records = [k / 3 * np.sin(10 * ANGLE) for k in range(1, 11)]
    for k, printed in enumerate(published, start=1):
        found = na4(records[:k])
        assert found == pytest.approx(1.5 * k**4 / ((k + 1) * (2 * k + 1) / 6) ** 2)
        assert found == pytest.approx(printed, rel=0.025)


def test_level_that_doubles_against_one_healthy_record() -> None:
    # mean variance (1 + 4)/2: 1.5 * 16 / 2.5^2; frozen: 1.5 * 16
    assert na4([TONE, 2 * TONE]) == pytest.approx(1.5 * 16 / 2.5**2)
    assert na4_star([TONE, 2 * TONE], healthy=1) == pytest.approx(24.0)
    assert na4_star([TONE, 2 * TONE], healthy=2) == pytest.approx(na4([TONE, 2 * TONE]))


def test_na4_without_a_reference_is_undefined() -> None:
    assert math.isnan(na4([np.zeros(10)]))
    assert math.isnan(na4_star([TONE], healthy=0))


def test_nb4_of_a_modulated_mesh_line_is_that_of_its_modulation() -> None:
    average = (1 + 0.3 * np.cos(ANGLE)) * np.cos(2 * TEETH * ANGLE) + 0.5 * np.cos(TEETH * ANGLE)
    harmonic = dominant_harmonic(line_amplitudes(average), TEETH, 5)
    assert harmonic == 2
    assert nb4([average], TEETH, harmonic, 6) == pytest.approx(1.5)
    deeper = (1 + 0.6 * np.cos(ANGLE)) * np.cos(2 * TEETH * ANGLE)
    assert nb4([average, deeper], TEETH, harmonic, 6) == pytest.approx(1.5 * 16 / 2.5**2)


def test_nb4_by_scipys_envelope() -> None:
    from scipy.signal import hilbert

    average = np.random.default_rng(6).standard_normal(SAMPLES)
    spectrum = np.fft.rfft(average)
    order = np.arange(spectrum.size)
    band = np.fft.irfft(np.where(np.abs(order - 2 * TEETH) <= 6, spectrum, 0), n=SAMPLES)
    assert nb4([average], TEETH, 2, 6) == pytest.approx(naive_na4([np.abs(hilbert(band))]))


def test_teager_energy_of_a_tone_is_constant_so_its_kurtosis_is_undefined() -> None:
    step = 7 * 2 * np.pi / SAMPLES
    np.testing.assert_allclose(teager_energy(TONE), 0.49 * math.sin(step) ** 2, rtol=1e-9)
    loud = 1e3 * np.cos(600 * ANGLE)  # rounding of squares near each other stays below the guard only for steep tones
    assert math.isnan(energy_operator_teager(np.zeros(SAMPLES)))
    assert teager_energy(loud).std() < 1e-9 * teager_energy(loud).mean()
    assert math.isnan(energy_operator_teager(loud))


def test_lebold_operator_of_a_sine_is_a_sine_of_twice_the_order() -> None:
    assert energy_operator_lebold(TONE) == pytest.approx(1.5)
    assert math.isnan(energy_operator_lebold(np.ones(SAMPLES)))


@given(seed=st.integers(0, 10_000))
def test_energy_operators_by_plain_loops(seed: int) -> None:
    x = np.random.default_rng(seed).standard_normal(64).tolist()
    teager = np.array([x[i] ** 2 - x[i - 1] * x[(i + 1) % 64] for i in range(64)])
    lebold = np.array([x[(i + 1) % 64] ** 2 - x[i] ** 2 for i in range(64)])
    for values, found in (
        (teager, energy_operator_teager(np.array(x))),
        (lebold, energy_operator_lebold(np.array(x))),
    ):
        assert found == pytest.approx(naive_na4([values]))


def test_largest_spectral_kurtosis_leaves_out_the_ends_and_empty_bands() -> None:
    assert spectral_kurtosis_maximum(np.array([9.0, 9.0, 0.5, np.nan, 1.5, 9.0, 9.0])) == 1.5
    assert math.isnan(spectral_kurtosis_maximum(np.full(10, np.nan)))
