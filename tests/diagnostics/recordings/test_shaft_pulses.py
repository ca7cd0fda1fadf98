"""Speed from the mesh lines in ranges so wide that half and twice the speed lie in them."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import shaft_pulses
from diagnostics.signal.line_evidence import line_evidence
from diagnostics.signal.speed_search import range_parts
from siggen.errors import UsageError
from tests.diagnostics.calibration.hidden_machine import hidden_record

FS_HZ, TEETH = 12_800.0, (18, 47)


def recording(speed_hz: float, tacho_s: np.ndarray | None = None) -> MeasuredRecording:
    rng = np.random.default_rng(2)
    time_s = np.arange(round(2.0 * FS_HZ)) / FS_HZ
    turns = speed_hz * time_s + 0.002 * np.sin(2 * np.pi * 0.7 * time_s)
    mesh = sum(np.cos(2 * np.pi * h * TEETH[0] * turns + h) * a for h, a in enumerate((1.0, 1.5, 0.4, 0.6), start=1))
    signal = (1.0 + 0.2 * np.cos(2 * np.pi * turns)) * mesh + 0.3 * rng.standard_normal(time_s.size)
    return MeasuredRecording(Path("run.npz"), {"vertical": signal}, FS_HZ, tacho_s)


@pytest.mark.parametrize("speed_hz", [24.0, 45.0])
def test_a_dozen_lines_are_enough_in_a_range_without_half_and_twice_the_speed(speed_hz: float) -> None:
    found = shaft_pulses(recording(speed_hz), TEETH, (0.8 * speed_hz, 1.25 * speed_hz))
    assert found.speed_hz == pytest.approx(speed_hz, rel=1e-3)  # the drift itself is 0.03 %
    assert found.source == "vertical"
    assert found.certainty > 0.95
    # the angle is that of the mesh line's phase, never stretched to a cell of the spectrum, which is half a pitch wide
    turns = speed_hz * found.times_s + 0.002 * np.sin(2 * np.pi * 0.7 * found.times_s)
    error = turns - np.arange(turns.size)
    assert np.abs(error - np.median(error))[4:-4].max() < 0.02 / TEETH[0]


@pytest.mark.parametrize("speed_hz", [24.0, 33.0, 45.0])
@pytest.mark.parametrize("limits", [(20.0, 50.0), pytest.param((14.0, 70.0), marks=pytest.mark.slow)])
def test_where_a_dozen_lines_fit_half_the_speed_as_well_it_is_refused_and_never_guessed(
    speed_hz: float, limits: tuple[float, float]
) -> None:
    with contextlib.suppress(UsageError):
        assert shaft_pulses(recording(speed_hz), TEETH, limits).speed_hz == pytest.approx(speed_hz, rel=1e-3)


def rough(speed_hz: float, teeth: tuple[int, int], spall: float, seed: int = 0) -> MeasuredRecording:
    """Return mesh lines of which the second rules, lines at all orders of both shafts, and a blow per revolution."""
    rng = np.random.default_rng(seed)
    time_s = np.arange(round(1.5 * FS_HZ)) / FS_HZ
    turns = speed_hz * time_s + 0.002 * np.sin(2 * np.pi * 0.7 * time_s)
    mesh = sum(a * np.cos(2 * np.pi * h * teeth[0] * turns + h) for h, a in enumerate((0.1, 1.5, 0.1, 0.2), start=1))
    own = (0.05 * np.cos(2 * np.pi * (k * turns + rng.uniform())) for k in range(1, 9 * teeth[0]))
    others = (
        0.02 * np.cos(2 * np.pi * (k * teeth[0] / teeth[1] * turns + rng.uniform())) for k in range(1, 9 * teeth[1])
    )
    blow = spall * np.exp(-0.5 * (((turns % 1.0) - 0.5) / 0.004) ** 2)
    signal = mesh + sum(own) + sum(others) + blow + 0.1 * rng.standard_normal(time_s.size)
    return MeasuredRecording(Path("run.npz"), {"vertical": signal}, FS_HZ, None)


NARROW, WIDE = (0.8, 1.25), (0.55, 1.4)


@pytest.mark.parametrize(  # every two of the three together
    ("speed_hz", "spall", "limits"), [(30.0, 0.0, NARROW), (30.0, 10.0, WIDE), (36.0, 0.0, WIDE), (36.0, 10.0, NARROW)]
)
def test_the_shaft_itself_decides_where_even_mesh_lines_or_sidebands_rule(
    speed_hz: float, spall: float, limits: tuple[float, float]
) -> None:
    low, high = (factor * speed_hz for factor in limits)
    found = shaft_pulses(rough(speed_hz, TEETH, spall), TEETH, (low, high))
    assert found.speed_hz == pytest.approx(speed_hz, rel=2e-3)


def drifting(speed_hz: float, drift: float, load_steps: bool) -> tuple[MeasuredRecording, float]:
    """Return lines of 24 and 60 teeth in noise, whose speed rises evenly and whose load may jump; and its mean."""
    rng = np.random.default_rng(4)
    time_s = np.arange(round(3.0 * FS_HZ)) / FS_HZ
    turns = speed_hz * time_s * (1.0 + drift * (time_s / 3.0 - 1.0) / 2.0)
    load = np.repeat([1.0, 1.6, 0.7], time_s.size // 3) if load_steps else 1.0
    mesh = sum(np.cos(2 * np.pi * h * 24 * turns + h) / h for h in (1, 2, 3, 4))
    both = (0.05 * np.cos(2 * np.pi * (k * turns * r + rng.uniform())) for r in (1.0, 0.4) for k in range(1, 120))
    signal = load * (mesh + sum(both)) + 0.1 * rng.standard_normal(time_s.size)
    return MeasuredRecording(Path("run.npz"), {"vertical": signal}, FS_HZ, None), (turns[-1] - turns[0]) / time_s[-1]


@pytest.mark.parametrize(  # every load with every range, and every drift
    ("drift", "load_steps", "limits"),
    [
        (0.0, False, (20.0, 50.0)),
        (0.0, True, (28.5, 31.0)),
        (0.005, True, (20.0, 50.0)),
        (-0.005, False, (28.5, 31.0)),
    ],
)
def test_a_pair_of_2_5_to_1_that_drifts_while_its_load_jumps(
    drift: float, load_steps: bool, limits: tuple[float, float]
) -> None:
    made, mean_hz = drifting(29.7, drift, load_steps)
    assert shaft_pulses(made, (24, 60), limits).speed_hz == pytest.approx(mean_hz, abs=0.02)


@pytest.mark.parametrize("limits", [(20.0, 28.0), (40.0, 60.0)])
def test_a_range_that_misses_the_speed_gives_no_other_one(limits: tuple[float, float]) -> None:
    with pytest.raises(UsageError, match=r"run.npz: (the lines fit|speeds of|no lines)"):
        shaft_pulses(rough(36.0, TEETH, 0.0), TEETH, limits)


def test_lines_of_a_gear_with_twice_the_teeth_do_not_pass_for_another_speed() -> None:
    found = shaft_pulses(rough(33.0, (23, 46), 0.0), (23, 46), (25.0, 45.0))
    assert found.speed_hz == pytest.approx(33.0, rel=2e-3)


def test_half_and_twice_the_speed_have_less_for_them_than_the_speed_and_noise_has_nothing() -> None:
    one = rough(36.0, TEETH, 0.0)
    signal, pulses = one.channels["vertical"], np.arange(1, 54) / 36.0
    found = line_evidence([signal], pulses, FS_HZ, TEETH, 5000.0).at(np.array([36.0, 18.0, 72.0]))
    assert found[0] > 1.1 * found[1:].max()
    noise = np.random.default_rng(1).standard_normal(signal.size)
    # the largest of six groups of exponential variables; each alone exceeds 5 once in a thousand
    assert line_evidence([noise], pulses, FS_HZ, TEETH, 5000.0).at(np.array([36.0]))[0] < 15.0


def test_parts_cover_the_range_and_hold_one_harmonic_each() -> None:
    parts = range_parts((10.0, 90.0))
    assert parts[0][0] == 10.0
    assert parts[-1][1] == 90.0
    for (low, high), (following, _) in zip(parts, [*parts[1:], (90.0, 0.0)], strict=True):
        assert high < 2.0 * low
        assert high >= following


def test_without_tacho_and_range_and_with_too_few_turns_the_file_is_named() -> None:
    with pytest.raises(UsageError, match=r"run.npz: neither tacho nor speed"):
        shaft_pulses(recording(30.0), TEETH, None)
    with pytest.raises(UsageError, match=r"run.npz: 4 whole turns of the first shaft; averages of both shafts need 6"):
        shaft_pulses(recording(30.0, np.arange(5) / 30.0), TEETH, None)
    with pytest.raises(UsageError, match="speed range"):
        shaft_pulses(recording(30.0), TEETH, (40.0, 30.0))


@pytest.mark.slow  # simulates a recording, and searches it twice
def test_a_second_stage_louder_than_the_mesh_lines_does_not_pass_for_them() -> None:
    """Its lines lead in every part of the range that is wide enough to hold both; the shaft's own lines decide."""
    channels, pulses = hidden_record()
    recording = MeasuredRecording(Path("run.csv"), channels, 25_600.0, None, False)
    true_hz = (pulses.size - 1) / (pulses[-1] - pulses[0])
    assert shaft_pulses(recording, (18, 47), (30.0, 40.0)).speed_hz == pytest.approx(true_hz, rel=1e-4)
    with pytest.raises(UsageError):
        shaft_pulses(recording, (18, 47), (36.0, 41.0))
