from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.dynamics.structure.identification import (
    Resonance,
    identified_support,
    resonance_from_decay,
    resonance_from_half_power,
    series_inertia,
)

RATIOS = st.floats(0.002, 0.2)


def decay(frequency: float, ratio: float, phase: float) -> tuple[np.ndarray, np.ndarray]:
    speed = 2.0 * np.pi * frequency
    time = np.arange(0.0, 12.0 / frequency, 1.0 / (200.0 * frequency))
    return time, np.exp(-ratio * speed * time) * np.cos(speed * np.sqrt(1.0 - ratio**2) * time + phase)


@given(ratio=RATIOS, frequency=st.floats(1.0, 1e4), phase=st.floats(0.0, 6.28))
def test_a_free_decay_gives_back_its_oscillator(ratio: float, frequency: float, phase: float) -> None:
    found = resonance_from_decay(*decay(frequency, ratio, phase))
    # The parabola through three of 200 samples per period is off by (2π/200)² of the curve's skewness.
    assert found.frequency_hz == pytest.approx(frequency, rel=1e-3)
    assert found.damping_ratio == pytest.approx(ratio, rel=2e-3, abs=1e-5)


def test_three_maxima_are_a_decay_and_two_are_none() -> None:
    time, signal = decay(50.0, 0.02, -0.5 * np.pi)  # maxima after 1/4, 5/4 and 9/4 periods
    three, two = time < 2.5 / 50.0, time < 1.5 / 50.0
    assert resonance_from_decay(time[three], signal[three]).damping_ratio == pytest.approx(0.02, rel=2e-3)
    with pytest.raises(ValueError, match="received 2 positive maxima; allowed are at least 3"):
        resonance_from_decay(time[two], signal[two])


@given(
    ratio=st.floats(0.005, 0.3), quantity=st.sampled_from([("displacement", 0), ("velocity", 1), ("acceleration", 2)])
)
def test_half_power_is_exact_also_for_strong_damping(ratio: float, quantity: tuple[str, int]) -> None:
    name, power = quantity
    r = np.linspace(0.01, 6.0, 120_000)
    response = r**power / np.abs(1.0 - r**2 + 2j * ratio * r)
    found = resonance_from_half_power(50.0 * r, response, name)
    # Straight lines between samples 5e-5 apart on a peak 0.01 wide: 1e-4 and better.
    assert found.damping_ratio == pytest.approx(ratio, rel=2e-4)
    assert found.frequency_hz == pytest.approx(50.0, rel=2e-4)


def test_the_support_gives_back_the_resonance() -> None:
    support = identified_support(Resonance(2250.8, 0.03), 1.0, elements=2)
    speed = np.sqrt(2.0 * support.stiffness_n_per_m / 1.0)
    assert speed / (2.0 * np.pi) == pytest.approx(2250.8, rel=1e-12)
    assert 2.0 * support.damping_n_s_per_m / (2.0 * speed * 1.0) == pytest.approx(0.03, rel=1e-12)
    assert series_inertia(4e-3, 1.6e-4) == pytest.approx(1.0 / (1.0 / 4e-3 + 1.0 / 1.6e-4), rel=1e-12)


def test_what_is_no_resonance_is_refused() -> None:
    time = np.linspace(0.0, 1.0, 1000)
    with pytest.raises(ValueError, match="maxima"):
        resonance_from_decay(time, np.exp(-time))
    with pytest.raises(ValueError, match="grow"):
        resonance_from_decay(time, np.exp(time) * np.cos(60.0 * time))
    with pytest.raises(ValueError, match="wider range"):
        resonance_from_half_power([1.0, 2.0, 3.0], [1.0, 1.1, 1.0], "velocity")
    with pytest.raises(ValueError, match="quantity"):
        resonance_from_half_power([1.0, 2.0, 3.0], [1.0, 5.0, 1.0], "force")
    for frequency, ratio in ((0.0, 0.1), (10.0, 1.0), (10.0, -0.1)):
        with pytest.raises(ValueError, match="allowed"):
            Resonance(frequency, ratio)
    for mass, elements in ((0.0, 1), (1.0, 0)):
        with pytest.raises(ValueError, match="allowed"):
            identified_support(Resonance(10.0, 0.1), mass, elements)
