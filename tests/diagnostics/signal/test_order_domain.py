"""Angle from pulses, and the error of evaluating a record at equal angles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.quintic_spline import spline_values

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
    # 64 steps per revolution at 30 Hz carry 960 Hz; 1 kHz would fold to 920 Hz. 1e-3: leakage of the cut-off tone
    grid = angle_grid(constant_speed_pulses(30.0), 64)
    found = resample_to_angle(np.cos(2 * np.pi * 1000.0 * TIME_S), FS_HZ, grid)
    assert np.abs(found[64:-64]).max() < 1e-3


def test_band_below_nine_tenths_of_what_the_angle_steps_carry_is_kept() -> None:
    grid = angle_grid(constant_speed_pulses(30.0), 64)
    tone = np.cos(2 * np.pi * 0.88 * 960.0 * TIME_S)
    expected = np.cos(2 * np.pi * 0.88 * 960.0 * grid.time_s)
    # 1e-3: what the ends of the record leave after some milliseconds
    assert np.abs(resample_to_angle(tone, FS_HZ, grid) - expected)[64:-64].max() < 1e-3


@given(speed_hz=st.floats(8.0, 60.0), offset_s=st.floats(0.0, 0.01))
@settings(max_examples=25, deadline=None)
def test_steps_lie_evenly_between_pulses_at_constant_speed(speed_hz: float, offset_s: float) -> None:
    pulses = offset_s + np.arange(6) / speed_hz
    grid = angle_grid(pulses, 100)
    assert grid.revolutions == 5
    # 1e-12 s: rounding of a spline that is exactly linear
    np.testing.assert_allclose(grid.time_s, offset_s + np.arange(500) / (100 * speed_hz), atol=1e-12)
    assert grid.slowest_hz == pytest.approx(speed_hz)


def test_band_limit_follows_the_slowest_revolution() -> None:
    # steps per second are fewest there, so that only there could a line fold
    assert angle_grid(np.array([0.0, 0.1, 0.15, 0.19, 0.25]), 64).slowest_hz == pytest.approx(10.0)


def test_two_pulses_give_one_revolution_of_constant_speed() -> None:
    grid = angle_grid(np.array([0.1, 0.2]), 10)
    np.testing.assert_allclose(grid.time_s, 0.1 + 0.01 * np.arange(10))


@pytest.mark.parametrize("pulses", [[], [0.1], [0.2, 0.1], [0.1, 0.1]])
def test_pulses_that_give_no_angle_are_refused(pulses: list[float]) -> None:
    with pytest.raises(ValueError, match="at least 2 increasing"):
        angle_grid(np.array(pulses), 10)


def test_jitter_of_the_pulses_costs_a_line_what_the_phase_error_costs() -> None:
    # pulses off by a Gaussian share s of a revolution, interpolated between: order o keeps about
    # exp(-(2 pi o s)^2 w/2), w the mean over a revolution of the spline's squared weights on the pulses: 0.6 to 1
    rng = np.random.default_rng(5)
    speed_hz, order, jitter = 40.0, 18, 0.004
    pulses = np.arange(0.02, 3.98, 1 / speed_hz)
    late = pulses + jitter / speed_hz * rng.standard_normal(pulses.size)
    time_s = np.arange(round(4 * FS_HZ)) / FS_HZ
    steps = resample_to_angle(np.cos(2 * np.pi * order * speed_hz * time_s), FS_HZ, angle_grid(late, 1152))
    kept = 2 * abs(np.mean(steps * np.exp(-2j * np.pi * order * np.arange(steps.size) / 1152)))
    square = (2 * np.pi * order * jitter) ** 2
    # 158 pulses: their mean square is known to sqrt(2/158) = 11 %, three of which are allowed
    assert np.exp(-square * 1.0 / 2 * 1.34) < kept < np.exp(-square * 0.6 / 2 * 0.66)


@given(change=st.floats(-0.2, 0.2), order=st.integers(1, 150))
@settings(max_examples=15, deadline=None)
def test_chirp_of_known_order_is_a_steady_tone_over_angle(change: float, order: int) -> None:
    # speed from 30 Hz on, by up to a fifth within 2 s; exact pulses. Order 150 at 36 Hz is 0.11 of the sampling rate,
    # where interpolation errs by 2 (0.053/0.947)^6 < 1e-7; the spline through pulses one turn apart by
    # t''''/384 = 15 a^3/v^7/384 = 2e-10 s at 24 Hz, times 2 pi 150 * 24 Hz: 5e-6, and band limits the rest
    time_s = np.arange(round(2 * FS_HZ)) / FS_HZ
    slope = 30.0 * change / 2.0
    turns = 30.0 * time_s + slope / 2 * time_s**2
    whole = np.arange(1, int(turns[-1]))
    pulses = np.interp(whole, turns, time_s) if slope == 0 else 2 * whole / (30 + np.sqrt(30**2 + 2 * slope * whole))
    steps = resample_to_angle(np.cos(2 * np.pi * order * turns + 0.5), FS_HZ, angle_grid(pulses, STEPS))
    inner = slice(3 * STEPS, -3 * STEPS)
    expected = np.cos(2 * np.pi * order * (1 + np.arange(steps.size) / STEPS) + 0.5)
    assert np.abs(steps - expected)[inner].max() < 1e-4


def test_the_spline_between_coefficients_is_scipys_and_held_beyond_its_ends() -> None:
    rng = np.random.default_rng(5)
    coefficients, place = rng.standard_normal(200), rng.uniform(1.0, 98.0, 40_000)  # more than one block
    spline = BSpline(np.arange(-3.0, 203.0), coefficients, 5)
    # weights are sums of some ten terms of order one
    np.testing.assert_allclose(spline_values(coefficients, place), spline(2.0 * place), atol=1e-14)
    ends = spline_values(coefficients, np.array([-50.0, 1.0, 98.0, 500.0]))
    np.testing.assert_allclose(ends, spline(np.array([2.0, 2.0, 196.0, 196.0])), atol=1e-14)
