"""Angle from a mesh line alone, against the true angle of a record that drifts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diagnostics.signal.mesh_pulses import mesh_pulses
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.synchronous_average import synchronous_average
from diagnostics.signal.tacholess_angle import mesh_ridge, tacholess_pulses
from siggen.errors import UsageError

FS_HZ, TEETH, RATIO = 12_800.0, 18, 18 / 47


def drifting(drift: float, noise: float, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Return a modulated mesh signal whose speed drifts by `drift` in 2 s, and its true pinion turns."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(round(2.0 * FS_HZ)) / FS_HZ
    speed_hz = 30.0 * (1.0 + drift * (time_s / 2.0 - 0.5)) * (1 + 0.001 * np.sin(2 * np.pi * 1.1 * time_s))
    turns = np.cumsum(speed_hz) / FS_HZ + 0.3
    shape = 1 + 0.4 * np.cos(2 * np.pi * turns) + 0.2 * np.cos(2 * np.pi * RATIO * turns + 1)
    mesh = sum(a * np.cos(2 * np.pi * h * TEETH * turns + h) for h, a in ((1, 0.5), (2, 1.0), (3, 0.4)))
    return shape * mesh + noise * rng.standard_normal(time_s.size), turns


@pytest.mark.parametrize("drift", [0.0, 0.04, -0.04])
def test_angle_is_found_within_a_hundredth_of_a_tooth_pitch_although_speed_drifts(drift: float) -> None:
    signal, turns = drifting(drift, 0.5)
    pulses = tacholess_pulses(signal, FS_HZ, TEETH, (25.0, 36.0))
    at = np.interp(pulses, np.arange(turns.size) / FS_HZ, turns)
    error = at - np.arange(at.size) - np.median(at - np.arange(at.size))
    # the phase filter sees the record on one side only within 1/(2 pi 0.1) = 1.6 turns of its ends
    inner = slice(4, -4)
    assert np.abs(error[inner]).max() < 0.01 / TEETH
    assert np.abs(error).max() < 0.1 / TEETH


def test_ridge_follows_the_speed_within_its_bin() -> None:
    signal, turns = drifting(0.04, 0.5)
    ridge = mesh_ridge(signal, FS_HZ, TEETH, (25.0, 36.0))
    speed_hz = np.interp(ridge.time_s, np.arange(turns.size) / FS_HZ, np.gradient(turns) * FS_HZ)
    # a frame of 0.16 s has bins of 6.25 Hz; the first harmonic alone, of 18 teeth, would tell the speed that well
    assert np.abs(ridge.speed_hz - speed_hz).max() < 6.25 / 18
    assert ridge.clarity > 0.3  # three of ten harmonics, each at least e above what noise reaches


def swinging(speed_hz: float, kind: str, drift: float, phase: float, noise: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a record whose speed changes by `drift` at most, with noise as a share of the signal, and its turns."""
    rng = np.random.default_rng(round(1e6 * phase))
    time_s = np.arange(round(2.0 * FS_HZ)) / FS_HZ
    change = time_s / 2.0 - 0.5 if kind == "linear" else 0.5 * np.sin(2 * np.pi * float(kind) * time_s + phase)
    turns = np.cumsum(speed_hz * (1 + drift * change)) / FS_HZ + phase
    shape = 1 + 0.4 * np.cos(2 * np.pi * turns) + 0.2 * np.cos(2 * np.pi * RATIO * turns + 1)
    signal = shape * sum(a * np.cos(2 * np.pi * h * TEETH * turns + h) for h, a in ((1, 0.5), (2, 1.0), (3, 0.4)))
    return signal + noise * signal.std() * rng.standard_normal(time_s.size), turns


@given(
    speed_hz=st.floats(22.0, 50.0),
    kind=st.sampled_from(["linear", "0.3", "1.0"]),
    drift=st.floats(-0.04, 0.04),
    phase=st.floats(0.0, 6.0),
    low=st.floats(0.71, 0.9),
)
@settings(max_examples=12, deadline=None)
def test_drift_of_four_percent_in_a_range_of_nearly_an_octave_at_noise_as_strong_as_the_signal(
    speed_hz: float, kind: str, drift: float, phase: float, low: float
) -> None:
    signal, turns = swinging(speed_hz, kind, drift, phase, noise=1.0)
    pulses = tacholess_pulses(signal, FS_HZ, TEETH, (low * speed_hz, 1.99 * low * speed_hz))
    at = np.interp(pulses, np.arange(turns.size) / FS_HZ, turns)
    error = at - np.arange(at.size) - np.median(at - np.arange(at.size))
    # white noise through the phase filter, 0.25 orders wide, leaves 0.1 rad at harmonic 2: 0.008 pitches; four of them
    assert np.abs(error[6:-6]).max() < 0.03 / TEETH


@pytest.mark.slow  # of pulses by every shaft: tests/diagnostics/recordings/test_shaft_pulses.py
@given(
    speed_hz=st.floats(22.0, 50.0),
    wrong=st.sampled_from([(1.1, 2.05), (1.4, 2.7), (0.45, 0.85), (0.26, 0.48)]),
    phase=st.floats(0.0, 6.0),
)
@settings(max_examples=3, deadline=None)
def test_range_that_holds_another_multiple_of_the_speed_only_is_refused(
    speed_hz: float, wrong: tuple[float, float], phase: float
) -> None:
    signal, _ = swinging(speed_hz, "1.0", 0.02, phase, noise=0.3)
    with pytest.raises(UsageError, match=r"the lines fit|are not told apart|no lines of these shafts"):
        mesh_pulses({"a": signal}, FS_HZ, (TEETH, 47), (wrong[0] * speed_hz, wrong[1] * speed_hz))


def test_sidebands_at_every_order_are_no_reason_to_refuse_the_right_range() -> None:
    # a spall: a short pulse once per revolution beside the mesh lines gives lines at all orders, half-way ones too
    signal, turns = swinging(30.0, "1.0", 0.02, 1.0, noise=0.1)
    pulse = np.exp(-(((turns + 0.5) % 1.0 - 0.5) ** 2) / (2 * 0.01**2)) * np.cos(2 * np.pi * 40 * turns)
    found = mesh_pulses({"a": signal + 3.0 * pulse}, FS_HZ, (TEETH, 47), (22.0, 40.0))
    assert np.median(1.0 / np.diff(found.times_s)) == pytest.approx(30.0, rel=0.01)


def test_stronger_lines_of_another_speed_for_a_moment_do_not_make_it_jump() -> None:
    signal, turns = drifting(0.0, 0.1)
    time_s = np.arange(signal.size) / FS_HZ
    burst = np.abs(time_s - 1.0) < 0.08  # a frame holds 0.16 s; the speed may change by a hundredth per hop of 0.02 s
    other = sum(np.cos(2 * np.pi * h * TEETH * 36.0 * time_s) for h in (1, 2, 3, 4))
    ridge = mesh_ridge(np.where(burst, 4.0 * other, signal), FS_HZ, TEETH, (25.0, 37.0))
    speed_hz = np.interp(ridge.time_s, time_s, np.gradient(turns) * FS_HZ)
    away = np.abs(ridge.time_s - 1.0) > 0.2
    assert np.abs(ridge.speed_hz / speed_hz - 1.0)[away].max() < 0.01
    assert np.abs(ridge.speed_hz / speed_hz - 1.0).max() < 0.12  # it was 0.2 away


def test_one_sided_sideband_of_the_other_shaft_does_not_wobble_the_angle() -> None:
    _, turns = drifting(0.0, 0.0)
    signal = np.cos(2 * np.pi * 2 * TEETH * turns) + 0.3 * np.cos(2 * np.pi * (2 * TEETH + RATIO) * turns)
    signal = signal + 0.3 * np.cos(2 * np.pi * TEETH * turns) + 0.3 * np.cos(2 * np.pi * 3 * TEETH * turns)
    pulses = tacholess_pulses(signal, FS_HZ, TEETH, (25.0, 36.0))
    at = np.interp(pulses, np.arange(turns.size) / FS_HZ, turns)
    error = at - np.arange(at.size) - np.median(at - np.arange(at.size))
    # the low-pass leaves 7e-4 of 0.3 rad; unfiltered it would be 0.3/(2 pi 2) = 0.024 pitches
    assert np.abs(error[4:-4]).max() < 0.003 / TEETH


def test_noise_without_a_mesh_line_is_refused() -> None:
    noise = np.random.default_rng(3).standard_normal(25_600)
    assert mesh_ridge(noise, FS_HZ, TEETH, (25.0, 36.0)).clarity < 0.03
    with pytest.raises(UsageError, match="no lines of these shafts stand above the noise"):
        mesh_pulses({"a": noise}, FS_HZ, (TEETH, 47), (25.0, 36.0))


def test_strong_high_harmonics_do_when_the_first_three_are_buried() -> None:
    rng = np.random.default_rng(2)
    signal, turns = drifting(0.04, 0.0)
    high = sum(a * np.cos(2 * np.pi * h * TEETH * turns) for h, a in ((4, 1.0), (7, 2.0), (9, 1.0)))
    pulses = tacholess_pulses(0.02 * signal + high + rng.standard_normal(signal.size), FS_HZ, TEETH, (19.0, 36.0))
    at = np.interp(pulses, np.arange(turns.size) / FS_HZ, turns)
    error = at - np.arange(at.size) - np.median(at - np.arange(at.size))
    assert np.abs(error[4:-4]).max() < 0.01 / TEETH


def test_record_too_slow_for_its_mesh_line_is_refused() -> None:
    with pytest.raises(UsageError, match="no mesh line to follow"):
        mesh_ridge(np.ones(10_000), 1000.0, TEETH, (25.0, 36.0))


def test_average_by_the_found_angle_holds_what_the_true_angle_gives() -> None:
    signal, turns = drifting(0.04, 0.0)
    whole = np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1)
    truth = np.interp(whole, turns, np.arange(turns.size) / FS_HZ)
    found = tacholess_pulses(signal, FS_HZ, TEETH, (25.0, 36.0))
    level = [
        synchronous_average(resample_to_angle(signal, FS_HZ, angle_grid(pulses, TEETH * 64)), TEETH, 64).signal.std()
        for pulses in (truth, found)
    ]
    assert level[1] == pytest.approx(level[0], rel=0.02)  # a hundredth of a pitch costs (2 pi 0.03)^2 / 2 = 2 % at h3


def test_average_by_the_nominal_speed_is_lost_which_is_why_the_angle_is_needed() -> None:
    signal, _ = drifting(0.04, 0.0)
    nominal = np.arange(0.0, 2.0, 1 / 30.0)
    average = synchronous_average(resample_to_angle(signal, FS_HZ, angle_grid(nominal, TEETH * 64)), TEETH, 64).signal
    assert average.std() < 0.5 * signal.std()


@pytest.mark.parametrize("speeds", [(30.0, 20.0), (0.0, 30.0), (20.0, 41.0)])
def test_range_that_names_no_single_harmonic_is_refused(speeds: tuple[float, float]) -> None:
    with pytest.raises(UsageError, match="speed range"):
        mesh_ridge(np.ones(100_000), FS_HZ, TEETH, speeds)


def test_record_shorter_than_four_turns_is_refused_with_the_length_it_needs() -> None:
    with pytest.raises(UsageError, match=r"needs 0\.16 s"):
        mesh_ridge(np.ones(1000), FS_HZ, TEETH, (25.0, 36.0))
