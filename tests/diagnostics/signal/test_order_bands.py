"""Bands of shaft orders: what passes, what the record does not carry, and the two limits of the localised energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.signal.order_bands import EDGES, ORDER_BANDS, band_signals, localised_energy

TEETH, STEPS = 18, 18 * 128
ANGLE = 2 * np.pi * np.arange(STEPS) / STEPS


def band_signal(part: np.ndarray, *orders: int, highest_order: float = math.inf) -> np.ndarray:
    return np.asarray(band_signals(part, highest_order, [orders])[0])  # type: ignore[list-item]


def test_bands_are_octaves_that_overlap_by_half() -> None:
    ratios = np.array(EDGES[1:]) / EDGES[:-1]
    np.testing.assert_allclose(ratios, math.sqrt(2), rtol=0.05)  # whole orders, the lowest of which are few
    assert (75, 150) in ORDER_BANDS
    assert (106, 212) in ORDER_BANDS


def test_a_band_keeps_its_orders_and_nothing_else() -> None:
    inside = 0.7 * np.cos(75 * ANGLE + 0.3) + 0.2 * np.cos(149 * ANGLE)
    found = band_signal(3.0 + inside + 5.0 * np.cos(74 * ANGLE) + 2.0 * np.cos(150 * ANGLE), 75, 150)
    np.testing.assert_allclose(found.real, inside, atol=1e-12)


def test_envelope_of_a_modulated_tone_is_its_modulation() -> None:
    envelope = 1.0 + 0.4 * np.cos(3 * ANGLE)
    np.testing.assert_allclose(np.abs(band_signal(envelope * np.cos(100 * ANGLE), 75, 150)), envelope, atol=1e-12)


def test_a_band_that_the_record_carries_by_less_than_half_is_undefined() -> None:
    noise = np.random.default_rng(0).standard_normal(STEPS)
    cut = band_signal(noise, 150, 300, highest_order=240.5)
    np.testing.assert_allclose(cut, band_signal(noise, 150, 241), atol=1e-12)
    assert np.isnan(band_signal(noise, 150, 300, highest_order=223.5)).all()
    assert math.isnan(localised_energy(band_signal(noise, 150, 300, highest_order=223.5), TEETH))


@given(pitch=st.integers(0, TEETH - 1), orders=st.sampled_from(ORDER_BANDS[:-1]))
def test_energy_on_one_pitch_gives_the_teeth_and_a_steady_tone_one(pitch: int, orders: tuple[int, int]) -> None:
    burst = np.zeros(STEPS, dtype=complex)
    burst[pitch * 128 : (pitch + 1) * 128] = 1.0 + 2.0j
    assert localised_energy(np.roll(burst, 57), TEETH) == pytest.approx(TEETH)
    tone = band_signal(np.cos(orders[0] * ANGLE), *orders)
    assert localised_energy(tone, TEETH) == pytest.approx(1.0)


def test_a_band_without_energy_has_no_place_of_it() -> None:
    assert math.isnan(localised_energy(np.zeros(STEPS, dtype=complex), TEETH))
