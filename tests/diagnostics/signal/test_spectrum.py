"""Line amplitudes, and which sidebands a record resolves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.signal.spectrum import hann_amplitude, line_amplitudes, resolved_lines, revolutions_needed
from diagnostics.signal.turn_spectrum import turn_lines


@given(order=st.integers(1, 30), amplitude=st.floats(1e-3, 1e3), phase=st.floats(0, 6.28))
def test_a_sine_gives_its_amplitude_at_its_order(order: int, amplitude: float, phase: float) -> None:
    lines = line_amplitudes(amplitude * np.cos(2 * np.pi * order * np.arange(64) / 64 + phase))
    assert lines[order] == pytest.approx(amplitude, rel=1e-9)
    assert np.delete(lines, order).max() < 1e-9 * amplitude


def test_mean_and_highest_order_are_not_doubled() -> None:
    np.testing.assert_allclose(line_amplitudes(np.array([3.0, 1.0, 3.0, 1.0])), [2.0, 0.0, 1.0])


def test_gear_sidebands_of_18_to_47_need_the_revolutions_that_separate_them_from_the_pinions() -> None:
    # pinion sidebands lie at multiples of 47/18 = 2.6111 gear orders; Hann needs two bins: 2 / distance
    assert revolutions_needed(1, 47, 18) == pytest.approx(2.0)  # nearest is the mesh line itself, one order away
    assert revolutions_needed(3, 47, 18) == pytest.approx(2 / (3 - 47 / 18))
    assert revolutions_needed(5, 47, 18) == pytest.approx(2 / (2 * 47 / 18 - 5))


def test_shafts_with_common_orders_are_never_told_apart() -> None:
    assert revolutions_needed(2, 40, 20) == np.inf


def test_unresolved_sidebands_are_marked_around_every_mesh_line() -> None:
    marked = resolved_lines(np.ones(100), np.array([True, False, True]), teeth=47)
    assert set(np.flatnonzero(np.isnan(marked))) == {2, 45, 49, 92, 96}


def test_far_from_the_other_shafts_sidebands_the_next_one_of_its_own_shaft_decides() -> None:
    # 47/18 teeth: sideband 4 of the gear is 1.2 orders from the pinion's nearest, but one order from 3 and 5
    assert revolutions_needed(4, 47, 18) == 2.0
    assert revolutions_needed(5, 47, 18) == pytest.approx(2.0 / (2 * 47 / 18 - 5))


@pytest.mark.parametrize("samples", [7, 8, 2305, 6 * 2304])
def test_hann_amplitudes_are_those_of_the_weighted_signal(samples: int) -> None:
    signal = 3.0 + np.random.default_rng(6).standard_normal(samples)
    weights = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(samples) / samples)
    direct = 4.0 / samples * np.abs(np.fft.rfft(signal * weights))
    np.testing.assert_allclose(hann_amplitude(signal), direct, atol=1e-13)


@pytest.mark.parametrize(("turns", "steps"), [(1, 8), (2, 7), (5, 6), (6, 5), (7, 9), (31, 96)])
def test_turns_have_the_spectrum_of_the_whole_record_with_and_without_a_gate(turns: int, steps: int) -> None:
    record, gate = np.random.default_rng(7).standard_normal((turns, steps)), np.hanning(steps)
    found = turn_lines(record)
    np.testing.assert_allclose(found.spectrum(), np.fft.rfft(record.ravel()), atol=1e-12)
    np.testing.assert_allclose(found.spectrum(gate), np.fft.rfft((record * gate).ravel()), atol=1e-12)
