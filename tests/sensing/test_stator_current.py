"""Currents of an induction motor against closed forms: an even rotor, slow and fast ripples of its speed."""

import numpy as np
import pytest

from siggen.sensing.stator_current import InductionMotor, active_current, lagging, phase_current

MOTOR = InductionMotor(
    pole_pairs=2, rated_torque_nm=60.0, rated_slip=0.03, rated_active_a=10.0, breakdown_slip=0.15, magnetising_a=5.0
)
FS = 20_000.0
SECONDS = np.arange(40_000) / FS


def added(angle_rad: float, hz: float) -> np.ndarray:
    return active_current(MOTOR, angle_rad * np.cos(2 * np.pi * hz * SECONDS), FS, 50.0)[10_000:]


def test_a_line_frequency_gives_the_speed_less_its_slip() -> None:
    assert MOTOR.line_hz(24.25, 60.0) == pytest.approx(50.0)  # 25 turns a second at no load, 3 % less at rated torque
    assert MOTOR.line_hz(25.0, 0.0) == pytest.approx(50.0)


def test_a_lag_is_that_of_the_differential_equation() -> None:
    step, periods = 0.05, 2 * np.pi * 0.02
    course = np.cos(periods * np.arange(4000))
    found = lagging(course, step)[2000:]
    # y' = (x - y) over the time constant of 20 samples; straight lines between samples are (0.126)²/12 of a cosine off
    expected = (np.exp(1j * periods * np.arange(2000, 4000)) / (1 + 1j * periods / step)).real
    assert np.abs(found - expected).max() < 0.02 * np.abs(expected).max()


@pytest.mark.parametrize("hz", [0.5, 12.0, 700.0])
def test_a_ripple_of_the_speed_moves_the_active_current_by_its_slip_behind_the_lag(hz: float) -> None:
    angle, omega = 1e-3, 2 * np.pi * hz
    tau = 1.0 / (2 * np.pi * 50.0 * MOTOR.breakdown_slip)
    slip = 2 * angle * omega / (2 * np.pi * 50.0)
    expected = 10.0 / 0.03 * slip / np.hypot(1.0, omega * tau)
    # the peak of a sine falls between samples, 1 - cos(π 700/20000) = 0.6 %; a record holds 0.75 of a period at 0.5 Hz
    assert np.abs(added(angle, hz)).max() == pytest.approx(expected, rel=0.01)


def test_a_record_begins_in_the_steady_state_of_its_ripple() -> None:
    angle, omega = 1e-3, 2 * np.pi * 12.0
    tau = 1.0 / (2 * np.pi * 50.0 * MOTOR.breakdown_slip)
    found = active_current(MOTOR, angle * np.sin(omega * SECONDS), FS, 50.0)  # a sine goes on as its mirror image
    speed = (angle * 1j * omega * np.exp(1j * omega * SECONDS) / (1 + 1j * omega * tau)).imag
    expected = -2 * (10.0 / 0.03) / (2 * np.pi * 50.0) * speed
    # From the first sample on: e^-16 is left of what was before. Half a sample late: 12 Hz times 25 us.
    assert np.abs(found - expected)[:2000].max() < 0.005 * np.abs(expected).max()


def test_fast_ripples_move_the_phase_by_the_pole_pairs_times_the_angle() -> None:
    # far above the corner the active current is p s_k/s_n times the angle, whatever the frequency
    for hz in (600.0, 1200.0):
        assert np.abs(added(1e-3, hz)).max() == pytest.approx(10.0 * 2 * (0.15 / 0.03) * 1e-3, rel=0.02)


def test_an_even_rotor_gives_a_pure_line_whose_phases_sum_to_nothing() -> None:
    even = active_current(MOTOR, np.zeros(SECONDS.size), FS, 50.0)
    assert not even.any()
    line = 2 * np.pi * 50.0 * SECONDS
    phases = [phase_current(MOTOR, even + 7.0, line, k * 2 * np.pi / 3) for k in range(3)]
    np.testing.assert_allclose(np.sum(phases, axis=0), 0.0, atol=1e-11)
    spectrum = np.abs(np.fft.rfft(phases[0])) / (SECONDS.size / 2)
    assert spectrum[100] == pytest.approx(np.hypot(5.0, 7.0))  # 50 Hz over 2 s
    spectrum[100] = 0.0
    assert spectrum.max() < 1e-11
