from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.sensing.measurement import Measurement, Recorder, power_of_two_from

SINE = 100.0 * np.sin(2.0 * np.pi * np.arange(20000) / 97.0)


def measured(signal: np.ndarray = SINE, seed: int = 5, **changes) -> Measurement:
    chain = {"limit": 500.0, "bits": None, "noise_floor": None, **changes}
    recorder = Recorder(signal.size, chain.pop("gain", 1.0))
    parts = np.array_split(signal, 3)
    for part in parts:
        recorder.take(part)
    recorder.begin_conversion(rng=np.random.default_rng(seed), **chain)
    for part in parts:
        recorder.convert(part.size, None)
    return recorder.measurement()


@given(st.floats(min_value=1e-200, max_value=1e200))
def test_the_step_is_the_smallest_power_of_two_that_covers_the_value(value: float) -> None:
    step = power_of_two_from(value)
    assert math.frexp(step)[0] == 0.5
    assert step >= value > 0.5 * step


@given(limit=st.floats(0.5, 1e4), bits=st.integers(2, 24), scale=st.floats(0.1, 3.0))
@settings(max_examples=60)
def test_quantised_values_are_exact_multiples_of_the_step_within_the_range(
    limit: float, bits: int, scale: float
) -> None:
    # a channel is kept as float32 until it is converted
    signal = (scale * limit * np.sin(np.arange(200.0))).astype(np.float32).astype(float)
    result = measured(signal, limit=limit, bits=bits)
    assert result.step >= 2.0 * limit / 2.0**bits
    codes = [Fraction(float(value)) / Fraction(result.step) for value in result.values]
    assert all(code.denominator == 1 for code in codes)
    assert max(abs(code) for code in codes) <= 2 ** (bits - 1)
    assert np.abs(result.values.astype(float)).max() <= limit
    inside = np.abs(signal) <= math.floor(limit / result.step) * result.step
    error = np.abs(result.values - signal)[inside]
    assert error.max(initial=0.0) <= 0.5 * result.step
    assert result.clipped_share == pytest.approx(1.0 - inside.mean())


def test_sixteen_bits_over_five_hundred() -> None:
    assert measured(bits=16).step == 2.0**-6


def test_quantisation_noise_is_that_of_a_uniform_error() -> None:
    signal = np.random.default_rng(1).uniform(-80.0, 80.0, 200000)
    result = measured(signal, bits=10)
    error = result.values - signal
    # Standard error of a variance from 200000 uniform errors: 0.2 %.
    assert error.std() == pytest.approx(result.step / math.sqrt(12.0), rel=0.01)


def test_clipping_cuts_at_the_range_and_counts() -> None:
    result = measured(SINE, limit=50.0)
    assert np.abs(result.values).max() == 50.0
    # A sine exceeds half its amplitude for two thirds of the time; 97 samples per period resolve it to 1/97.
    assert result.clipped_share == pytest.approx(2.0 / 3.0, abs=1.0 / 97.0)
    assert measured(SINE).clipped_share == 0.0


def test_the_noise_floor_is_absolute_white_and_independent_of_the_gain() -> None:
    for gain in (0.5, 2.0):
        result = measured(SINE, gain=gain, noise_floor=0.25)
        noise = result.values - gain * SINE
        # 20000 samples: standard error of the deviation 0.5 %, of a correlation 0.7 %; four of each.
        assert noise.std() == pytest.approx(0.25, rel=0.02)
        assert abs(np.corrcoef(noise[:-1], noise[1:])[0, 1]) < 0.03
        assert result.noise_floor == 0.25
        assert result.snr_db == pytest.approx(20.0 * math.log10(gain * SINE.std() / 0.25))


def test_without_noise_the_signal_passes_and_the_ratio_is_infinite() -> None:
    result = measured(SINE, gain=2.0)
    np.testing.assert_array_equal(result.values, (2.0 * SINE).astype(np.float32))
    assert (result.noise_floor, result.snr_db, result.step) == (0.0, math.inf, 0.0)
    assert measured(np.zeros(10), noise_floor=0.1).snr_db == -math.inf


def test_same_generator_same_bytes_and_read_only() -> None:
    first, second, other = (measured(noise_floor=1.0, bits=16, seed=s) for s in (5, 5, 6))
    assert first.values.tobytes() == second.values.tobytes() != other.values.tobytes()
    assert first.values.dtype == np.float32
    assert not first.values.flags.writeable


def test_accelerations_that_are_not_finite_are_refused() -> None:
    with pytest.raises(ValueError, match="allowed"):
        measured(np.array([0.0, np.nan, 0.0]))
