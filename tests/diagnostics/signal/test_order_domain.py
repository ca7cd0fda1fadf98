"""Angle from pulses, and the error of evaluating a record at equal angles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diagnostics.signal.order_domain import angle_grid, resample_to_angle

FS_HZ = 51_200.0
TIME_S = np.arange(25_600) / FS_HZ
STEPS = 2304


def constant_speed_pulses(speed_hz: float) -> np.ndarray:
    return np.arange(0.02, 0.48, 1.0 / speed_hz)


@pytest.mark.parametrize(("share", "error"), [(0.05, 1e-6), (0.25, 3e-5), (0.4, 1e-3)])
def test_tone_at_equal_angles_matches_its_formula(share: float, error: float) -> None:
    # the bounds are those that the function states; the two images nearest to a tone err by
    # 2 ((f/(1-f))^6 + (f/(1+f))^6) at f = share / 2, which is 2.0e-5 and 5.3e-4
    grid = angle_grid(constant_speed_pulses(30.0), STEPS)
    tone = np.cos(2 * np.pi * share * FS_HZ * TIME_S + 0.3)
    expected = np.cos(2 * np.pi * share * FS_HZ * grid.time_s + 0.3)
    assert np.abs(resample_to_angle(tone, FS_HZ, grid) - expected).max() < error


def test_changing_speed_is_followed_between_the_pulses() -> None:
    # angle = 30 t + 0.01 sin(2 pi 3 t): +-0.6 % of speed; a cubic spline between pulses 33 ms apart errs by 1e-4
    # revolutions at most, which is 1e-2 rad at order 18
    time_s = np.arange(102_400) / FS_HZ
    turns = 30.0 * time_s + 0.01 * np.sin(2 * np.pi * 3.0 * time_s)
    pulses = np.interp(np.arange(1, 59), turns, time_s)
    grid = angle_grid(pulses, STEPS)
    found = resample_to_angle(np.cos(2 * np.pi * 18 * turns), FS_HZ, grid)
    inner = slice(3 * STEPS, -3 * STEPS)  # the spline's ends are less exact: no pulse beyond them
    assert np.abs(found - np.cos(2 * np.pi * 18 * np.arange(found.size) / STEPS))[inner].max() < 1e-2


def test_band_above_the_angle_steps_is_removed() -> None:
    # 64 steps per revolution at 30 Hz carry 960 Hz; 2 kHz would fold to 80 Hz. 1e-3: leakage of the cut-off tone
    grid = angle_grid(constant_speed_pulses(30.0), 64)
    found = resample_to_angle(np.cos(2 * np.pi * 2000.0 * TIME_S), FS_HZ, grid)
    assert np.abs(found[64:-64]).max() < 1e-3


@given(speed_hz=st.floats(8.0, 60.0), offset_s=st.floats(0.0, 0.01))
@settings(max_examples=25, deadline=None)
def test_steps_lie_evenly_between_pulses_at_constant_speed(speed_hz: float, offset_s: float) -> None:
    pulses = offset_s + np.arange(6) / speed_hz
    grid = angle_grid(pulses, 100)
    assert grid.revolutions == 5
    # 1e-12 s: rounding of a spline that is exactly linear
    np.testing.assert_allclose(grid.time_s, offset_s + np.arange(500) / (100 * speed_hz), atol=1e-12)
    assert grid.slowest_hz == pytest.approx(speed_hz)


def test_two_pulses_give_one_revolution_of_constant_speed() -> None:
    grid = angle_grid(np.array([0.1, 0.2]), 10)
    np.testing.assert_allclose(grid.time_s, 0.1 + 0.01 * np.arange(10))


@pytest.mark.parametrize("pulses", [[], [0.1], [0.2, 0.1], [0.1, 0.1]])
def test_pulses_that_give_no_angle_are_refused(pulses: list[float]) -> None:
    with pytest.raises(ValueError, match="at least 2 increasing"):
        angle_grid(np.array(pulses), 10)
