from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.drivetrain.varying_drive import Ripple, SlowVariation, SpeedRamp, VaryingDrive, slow_variation

TURN = 2.0 * np.pi


def process(seed: int = 0, corner_hz: float = 1.0, end_s: float = 12.0) -> SlowVariation:
    return slow_variation(np.random.default_rng(seed), corner_hz, -6.0, end_s)


def everything(start_hz: float = 10.0, end_hz: float = 50.0, start_rad: float = 0.3, seed: int = 0) -> VaryingDrive:
    return VaryingDrive(SpeedRamp(start_hz, end_hz, 1.0), start_rad, Ripple(1e-3, 5e-4, 0.4, 2.0), process(seed), 5e-3)


@given(start_hz=st.floats(2.0, 60.0), end_hz=st.floats(2.0, 60.0), angle=st.floats(0.0, 300.0), seed=st.integers(0, 99))
@settings(max_examples=40, deadline=None)
def test_angle_speed_and_acceleration_are_integrals_of_each_other(
    start_hz: float, end_hz: float, angle: float, seed: int
) -> None:
    drive = everything(start_hz, end_hz, angle, seed)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    cells = np.linspace(-2.5, 3.0, 1376)
    half = 0.5 * np.diff(cells)
    inner = (0.5 * (cells[1:] + cells[:-1]))[:, None] + half[:, None] * nodes
    # Gauss with 8 nodes on 4 ms is exact to 1e-10 but for cells with a knot of the spline or the end of a blend: there
    # the second derivative of the acceleration jumps, by up to 6 × 2π × 58 Hz/s / (2/58 s)² = 2e6 rad/s⁴, of which a
    # thousandth of h³ remains in the speed (1e-4) and of h⁴ in the angle (1e-7 at the most).
    turned = (drive.speed_rad_s(inner) @ weights) * half
    np.testing.assert_allclose(turned, np.diff(drive.angle_rad(cells)), rtol=0, atol=1e-7)
    faster = (drive.acceleration_rad_s2(inner) @ weights) * half
    np.testing.assert_allclose(faster, np.diff(drive.speed_rad_s(cells)), rtol=0, atol=2e-4)
    assert drive.angle_rad(np.zeros(1))[0] == pytest.approx(angle, abs=1e-12)


@given(start_hz=st.floats(2.0, 60.0), end_hz=st.floats(2.0, 60.0), angle=st.floats(0.0, 300.0), seed=st.integers(0, 99))
@settings(max_examples=40, deadline=None)
def test_tacho_marks_are_the_whole_revolutions_of_the_angle(
    start_hz: float, end_hz: float, angle: float, seed: int
) -> None:
    drive = everything(start_hz, end_hz, angle, seed)
    marks = drive.tacho_s(1.0)
    turns = drive.angle_rad(marks) / TURN
    assert np.abs(turns - np.round(turns)).max() < 1e-9
    np.testing.assert_array_equal(np.diff(np.round(turns)), 1.0)
    assert marks[0] >= 0.0
    assert marks[-1] < 1.0
    first, last = drive.angle_rad(np.array([0.0, 1.0])) / TURN
    assert turns[0] - first < 1.0 + 1e-9
    assert last - turns[-1] <= 1.0 + 1e-9


def test_a_run_up_is_linear_over_the_record_and_starts_without_a_jump_of_acceleration() -> None:
    ramp = SpeedRamp(10.0, 50.0, 2.0)
    time = np.linspace(0.0, 2.0, 101)
    np.testing.assert_allclose(ramp.speed_hz(time), 10.0 + 20.0 * time, rtol=1e-14)
    np.testing.assert_allclose(ramp.turns(time), 10.0 * time + 10.0 * time**2, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(ramp.acceleration_hz_s(time), 20.0, rtol=1e-14)
    around = ramp.acceleration_hz_s(np.linspace(-1.0, 3.0, 40001))
    assert np.abs(np.diff(around)).max() < 20.0 * 1.6e-4 / 0.5  # largest slope of the blend times the spacing
    assert ramp.speed_hz(np.array([-9.0]))[0] == ramp.slowest_hz > 0.0


@pytest.mark.parametrize("corner_hz", [0.1, 1.0, 2.0])
def test_slow_speed_has_the_rms_and_the_corner_asked_for(corner_hz: float) -> None:
    length, step = 4000.0 / corner_hz, 1.0 / (32.0 * corner_hz)
    time = step * np.arange(128000)
    values = slow_variation(np.random.default_rng(3), corner_hz, 0.0, length).value(time)
    # 4000 corner periods have about 4000 π independent values: 0.6 % of the rms.
    assert values.std() == pytest.approx(1.0, abs=0.03)
    segments = values.reshape(500, 256) * np.hanning(256)
    power = (np.abs(np.fft.rfft(segments, axis=1)) ** 2).mean(axis=0)
    frequency = np.fft.rfftfreq(256, step) / corner_hz
    inside = (frequency > 0.4) & (frequency < 3.0)
    expected = np.sinc(frequency / 16.0) ** 8 / (1.0 + frequency**2)
    ratio = (power / expected)[inside]
    # 500 segments scatter by 4.5 % per line; the window's width of 0.25 f_c smooths a smooth spectrum by little.
    assert np.abs(ratio / ratio.mean() - 1.0).max() < 0.2


@pytest.mark.parametrize(
    ("ripple", "rms"), [(Ripple(once=0.7, twice=0.4), 0.0), (Ripple(), 0.6)], ids=["ripple", "slow"]
)
def test_speeds_that_would_turn_back_are_refused(ripple: Ripple, rms: float) -> None:
    with pytest.raises(ValueError, match="never stops or turns back"):
        VaryingDrive(SpeedRamp(30.0, 30.0, 1.0), 0.0, ripple, process(), rms)
