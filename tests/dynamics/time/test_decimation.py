from __future__ import annotations

import numpy as np
import pytest

from siggen.motion.decimation import Decimator, half_length, second_difference_taps, value_taps


def gains_db(taps: np.ndarray, omega: np.ndarray, divisor: np.ndarray) -> np.ndarray:
    """Return the gain of symmetric taps at angular frequencies per step, over a wanted gain."""
    place = np.arange(len(taps)) - len(taps) // 2
    response = np.cos(omega[:, None] * place) @ taps
    return 20.0 * np.log10(np.abs(response / divisor) + 1e-30)


@pytest.mark.parametrize("steps", [1, 2, 3, 4, 8, 16])
def test_pass_band_is_flat_to_a_tenth_of_a_decibel(steps: int) -> None:
    omega = 2.0 * np.pi * np.linspace(1e-3, 0.45, 400) / steps
    assert np.abs(gains_db(value_taps(steps), omega, np.ones_like(omega))).max() < 0.1
    # The second difference stands for -ω² of the displacement.
    assert np.abs(gains_db(second_difference_taps(steps), omega, omega**2)).max() < 0.1


@pytest.mark.parametrize("steps", [2, 3, 4, 8, 16])
def test_stop_band_begins_at_half_the_output_rate_with_eighty_decibels(steps: int) -> None:
    omega = 2.0 * np.pi * np.linspace(0.5, 0.5 * steps, 4000) / steps
    assert gains_db(value_taps(steps), omega, np.ones_like(omega)).max() < -80.0
    assert gains_db(second_difference_taps(steps), omega, omega**2).max() < -80.0


def test_a_constant_displacement_has_no_acceleration_and_its_value_passes() -> None:
    assert abs(second_difference_taps(4).sum()) < 1e-15
    assert abs(value_taps(4).sum() - 1.0) < 1e-14


def decimated(times_to_values, taps: np.ndarray, steps: int, samples: int, blocks: list[int]) -> np.ndarray:
    """Return what a decimator makes of a displacement over time (in output samples), given in blocks of steps."""
    half = half_length(steps)
    states = times_to_values(np.arange(-half, (samples - 1) * steps + half + 1) / steps)[:, None]
    decimator = Decimator(np.array([[1.0]]), taps, steps)
    return np.concatenate([decimator.take(block)[0] for block in np.split(states, np.cumsum(blocks))])


@pytest.mark.parametrize("frequency", [0.01, 0.2, 0.44])
def test_sample_k_belongs_to_time_k(frequency: float) -> None:
    taps = second_difference_taps(4) * 16.0
    result = decimated(lambda t: np.sin(2.0 * np.pi * frequency * t + 0.4), taps, 4, 200, [300])
    expected = -((2.0 * np.pi * frequency) ** 2) * np.sin(2.0 * np.pi * frequency * np.arange(200) + 0.4)
    # Ripple of the pass band, 90 dB: 3e-5 of the amplitude; any shift in time would show as 2π f times it.
    np.testing.assert_allclose(result, expected, atol=1e-4 * (2.0 * np.pi * frequency) ** 2)


def test_blocks_do_not_change_a_byte() -> None:
    noise = np.random.default_rng(3).standard_normal(10000)
    runs = [decimated(lambda t: noise[: t.size], value_taps(4), 4, 300, blocks) for blocks in ([], [7, 600, 1], [1200])]
    assert runs[0].tobytes() == runs[1].tobytes() == runs[2].tobytes()


def test_an_acceleration_that_jumps_hardly_aliases() -> None:
    """A square-wave acceleration of an odd period, known exactly, against its Fourier series within the band."""
    period, samples, steps = 94.7318, 9000, 4

    def displacement(t: np.ndarray) -> np.ndarray:
        place = np.mod(t, period) / period
        half = np.where(place < 0.5, place * (0.5 - place), (place - 0.5) * (place - 1.0))
        return -0.5 * half * period**2

    result = decimated(displacement, second_difference_taps(steps) * steps**2, steps, samples, [])
    time = np.arange(samples)
    orders = np.arange(1, int(0.45 * period), 2)
    series = (4.0 / np.pi / orders * np.sin(2.0 * np.pi * orders * time[:, None] / period)).sum(axis=1)
    window = np.hanning(samples) ** 2
    spectrum = np.abs(np.fft.rfft((result - series) * window)) ** 2
    whole = np.abs(np.fft.rfft(result * window)) ** 2
    below = np.fft.rfftfreq(samples) < 0.44
    # Power of the aliases in the pass band: measured -74 dB of the signal's.
    assert spectrum[below].sum() < 10.0**-7.0 * whole.sum()


@pytest.mark.parametrize("steps", [1, 2, 3, 4])
def test_a_sample_is_the_plain_sum_of_projected_states_in_the_order_of_the_taps(steps: int) -> None:
    rng = np.random.default_rng(steps)
    states, rows, taps = rng.standard_normal((19 * steps + 5, 6)), rng.standard_normal((3, 6)), rng.standard_normal(19)
    rows[:, [1, 4]], rows[2, 0] = 0.0, 0.0
    found = Decimator(rows, taps, steps).take(states)
    expected = np.zeros_like(found)
    for channel, row in enumerate(rows):
        projected = [sum(float(w * x) for w, x in zip(row, state, strict=True) if w != 0.0) for state in states]
        for sample in range(found.shape[1]):
            for tap, value in zip(taps, projected[sample * steps :], strict=False):
                expected[channel, sample] += tap * value
    assert found.shape[1] > 0
    assert found.tobytes() == expected.tobytes()
