"""Pulses of a disc against closed forms: even and vibrating shafts, discs off the axis, ticks of the counter."""

import numpy as np
import pytest

from siggen.sensing.pulses import counted_speed, disc_marks, interpolated, pulse_times

FS = 20_000.0
TIMES = np.arange(10_000) / FS
TURN = 2.0 * np.pi


def even_marks(per_turn: int) -> np.ndarray:
    return disc_marks(per_turn, np.zeros(per_turn), 0.0, 0.0)


def test_an_even_shaft_gives_even_pulses_and_its_speed_at_every_sample() -> None:
    omega = TURN * 30.0
    numbers, times = pulse_times(omega * TIMES + 1.0, FS, even_marks(360))
    np.testing.assert_allclose(times, (TURN / 360 * numbers - 1.0) / omega, atol=1e-13)  # rounding of 0.5 s at 1e-16
    speed = counted_speed(numbers, times, 360, FS, TIMES.size)
    np.testing.assert_allclose(speed, omega, rtol=1e-8)  # rounding of the angle, 1e-14 rad, times fs over omega
    late = counted_speed(numbers + 1e12, times, 360, FS, TIMES.size)
    np.testing.assert_allclose(late, omega, rtol=1e-8)  # of as many pulses the angle itself is rounded to 4e-6 rad


@pytest.mark.parametrize(("share_of_fs", "tolerance"), [(0.02, 1e-10), (0.1, 4e-5), (1 / 6, 2e-3)])
def test_an_angle_between_samples_is_that_of_the_vibration(share_of_fs: float, tolerance: float) -> None:
    # Lagrange through 8 points: (ω h)^8 (1·3·5·7)²/(2^8 8!), between the middle two: (ω h)^8/936
    omega = TURN * share_of_fs
    instants = np.linspace(3.0, TIMES.size - 4.0, 3001)
    wrong = interpolated(np.sin(omega * np.arange(TIMES.size)), instants) - np.sin(omega * instants)
    assert np.abs(wrong).max() < tolerance


def test_a_vibrating_shaft_passes_its_marks_when_its_angle_is_theirs() -> None:
    omega, amplitude, at = TURN * 25.0, 1e-3, TURN * 500.0

    def angle(times: np.ndarray) -> np.ndarray:
        return omega * times + amplitude * np.sin(at * times + 0.4)

    numbers, times = pulse_times(angle(TIMES), FS, even_marks(1000))
    inner = (times > 5 / FS) & (times < TIMES[-5])
    # interpolation error of (0.157)^8/936 of the amplitude is below rounding
    np.testing.assert_allclose(angle(times)[inner], TURN / 1000 * numbers[inner], atol=1e-11)
    speed = counted_speed(numbers, times, 1000, FS, TIMES.size)
    expected = np.diff(angle((np.arange(TIMES.size + 1) - 0.5) / FS)) * FS
    # even speed between pulses: the chord of a sine over 1/50 of its period is (π/50)²/2 = 0.2 % off
    assert np.abs(speed - expected)[10:-10].max() < 0.02 * amplitude * at


def test_a_disc_off_the_axis_shows_its_eccentricity_once_per_turn() -> None:
    share = 1e-3
    marks = disc_marks(2000, np.zeros(2000), share, 0.7)
    numbers, times = pulse_times(TURN * 40.0 * TIMES, FS, marks)
    ahead = TURN / 2000 * numbers - TURN * 40.0 * times  # nominal less true angle: the marks lie ahead by e/r sin
    np.testing.assert_allclose(ahead, -share * np.sin(TURN / 2000 * numbers + 0.7), atol=1e-12)


def test_ticks_of_the_counter_move_the_speed_by_their_share_of_a_pulse() -> None:
    omega, clock = TURN * 30.0, 1e6
    numbers, times = pulse_times(omega * TIMES, FS, even_marks(100))
    counted = np.round(times * clock) / clock
    speed = counted_speed(numbers, counted, 100, FS, TIMES.size)
    pulses_hz = 100 * 30.0
    assert 0.1 * pulses_hz / clock < np.abs(speed / omega - 1.0).max() <= 1.01 * pulses_hz / clock


def test_the_sum_of_speeds_is_the_angle() -> None:
    angle = TURN * 20.0 * TIMES + 0.01 * np.sin(TURN * 30.0 * TIMES)
    numbers, times = pulse_times(angle, FS, even_marks(5000))
    speed = counted_speed(numbers, times, 5000, FS, TIMES.size)
    turned = np.cumsum(speed)[:-1] / FS
    middles = TURN * 20.0 * (TIMES + 0.5 / FS) + 0.01 * np.sin(TURN * 30.0 * (TIMES + 0.5 / FS))
    np.testing.assert_allclose(turned - turned[10], (middles - middles[10])[:-1], atol=2e-7)  # chords: 1e-2 (π/3333)²


def test_a_shaft_that_turns_back_is_refused() -> None:
    with pytest.raises(ValueError, match="turns back"):
        pulse_times(TURN * 1.0 * TIMES + 0.1 * np.sin(TURN * 50.0 * TIMES), FS, even_marks(100))
