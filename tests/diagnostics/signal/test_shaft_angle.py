"""Angle by mesh lines against the known one of made-up recordings: right to a tenth of a pitch, or not given."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.shaft_angle import shaft_angle
from diagnostics.signal.synchronous_average import synchronous_average
from siggen.errors import UsageError
from tests.diagnostics.signal.made_gears import MadeGears, made_gears

TEETH = (27, 71)


@pytest.mark.parametrize(("beside", "limits"), [(0.3, (22.0, 26.0)), (1.5, (15.0, 36.0))])
def test_angle_is_right_to_a_fiftieth_of_a_pitch_through_drift_load_steps_and_strong_sidebands(
    beside: float, limits: tuple[float, float]
) -> None:
    made = made_gears(TEETH, beside=beside)
    found = shaft_angle(made.channels, made.fs_hz, TEETH, limits)
    assert found.outcome == "angle"
    # noise of twice the strongest line through 2 x 8 Hz of 6400 Hz: 0.1 of a line in 8 lines of harmonics 1 to 4
    assert made.error_pitches(found) < 0.02
    assert found.halves.apart < 0.05
    assert all(found.others[kind].behind > 5.0 for kind in ("speed", "curve") if kind in found.others)


@pytest.mark.parametrize("teeth", [(24, 24), (17, 85)])
def test_shafts_of_one_speed_and_a_gear_five_times_as_slow(teeth: tuple[int, int]) -> None:
    made = made_gears(teeth, noise=1.0)
    found = shaft_angle(made.channels, made.fs_hz, teeth, (22.0, 26.0))
    assert found.given
    assert made.error_pitches(found) < 0.03


def hostile(made: MadeGears, kind: str) -> dict[str, np.ndarray]:
    rng, time_s = np.random.default_rng(1), made.time_s

    def changed(signal: np.ndarray) -> np.ndarray:
        level, tones = signal.std(), rng.uniform(100.0, 5000.0, 8)
        spikes = rng.standard_normal(signal.size) * (rng.random(signal.size) < 1e-3)
        return {
            "spikes": signal + 30.0 * level * spikes,
            "offset and drift": signal + 1e3 * level * (1.0 + time_s),
            "clipped": np.clip(signal, -0.5 * level, 0.5 * level),
            "foreign lines": signal + sum(3.0 * level * np.cos(2.0 * np.pi * hz * time_s) for hz in tones),
            "swelling": signal * (1.0 + 0.5 * np.sin(2.0 * np.pi * 0.4 * time_s)),
        }[kind]

    return {name: changed(signal) for name, signal in made.channels.items()}


@pytest.mark.parametrize("kind", ["spikes", "offset and drift", "clipped", "foreign lines", "swelling"])
def test_what_real_recorders_and_machines_add_does_not_turn_the_angle(kind: str) -> None:
    made = made_gears(TEETH, noise=1.0, seconds=4.0)
    found = shaft_angle(hostile(made, kind), made.fs_hz, TEETH, (22.0, 26.0))
    assert found.given
    assert made.error_pitches(found) < 0.03


@pytest.mark.parametrize("limits", [(25.5, 30.0), (17.0, 22.5)])
def test_a_range_that_misses_the_speed_is_refused_with_the_speed_that_was_seen(limits: tuple[float, float]) -> None:
    made = made_gears(TEETH, seconds=4.0)
    with pytest.raises(
        UsageError,
        match=r"(the lines fit 2[34]\.\d+ Hz|no lines of 27/71 teeth).*teeth and the sampling rate \(\d+ Hz",
    ):
        shaft_angle(made.channels, made.fs_hz, TEETH, limits)


@pytest.mark.parametrize(
    ("teeth", "given"),
    [
        *((TEETH, given) for given in ((28, 71), (27, 70))),
        # sidebands of twice the pinion's teeth fall upon those of the pinion, or a cell beside them
        *(((33, 66), given) for given in ((33, 67), (34, 66))),
    ],
)
def test_wrong_teeth_of_either_gear_are_refused(teeth: tuple[int, int], given: tuple[int, int]) -> None:
    made = made_gears(teeth)
    with pytest.raises(UsageError, match=r"teeth better than|the lines fit|are not told apart"):
        shaft_angle(made.channels, made.fs_hz, given, (22.0, 26.0))


def test_noise_alone_is_refused() -> None:
    noise = np.random.default_rng(3).standard_normal((2, 90_000))
    with pytest.raises(UsageError, match="no lines of 27/71 teeth stand above the noise"):
        shaft_angle({"a": noise[0], "b": noise[1]}, 12_800.0, TEETH, (22.0, 26.0))


def test_where_lines_vanish_for_a_second_the_speed_alone_is_given() -> None:
    made = made_gears(TEETH, noise=0.5)
    rng = np.random.default_rng(2)
    gone = np.abs(made.time_s - 3.5) < 0.6
    channels = {n: np.where(gone, 0.5 * rng.standard_normal(s.size), s) for n, s in made.channels.items()}
    found = shaft_angle(channels, made.fs_hz, TEETH, (22.0, 26.0))
    assert found.outcome == "speed only"
    assert found.speed_hz == pytest.approx((made.turns[-1] - made.turns[0]) / 7.0, rel=2e-3)
    assert "speed only" in found.words


def test_what_cannot_be_used_is_refused_with_what_came() -> None:
    made = made_gears(TEETH, seconds=2.0)
    flat = {**made.channels, "still": np.full(made.time_s.size, 2.0)}
    with pytest.raises(UsageError, match="channel still: no vibration"):
        shaft_angle(flat, made.fs_hz, TEETH, (22.0, 26.0))
    short = {name: signal[:6400] for name, signal in made.channels.items()}
    with pytest.raises(UsageError, match=r"0\.5 s hold 13 turns"):
        shaft_angle(short, made.fs_hz, TEETH, (22.0, 26.0))
    with pytest.raises(UsageError, match="speed range: received 26 to 22 Hz"):
        shaft_angle(made.channels, made.fs_hz, TEETH, (26.0, 22.0))
    with pytest.raises(UsageError, match="mesh frequency: received 5400 Hz at 200 Hz of 27 teeth"):
        shaft_angle(made.channels, made.fs_hz, TEETH, (200.0, 260.0))


def test_average_by_the_angle_holds_what_the_true_angle_gives_and_one_by_the_nominal_speed_does_not() -> None:
    made = made_gears(TEETH, noise=0.0, channels=1, beside=0.3)
    signal = made.channels["c0"]
    found = shaft_angle(
        {"a": signal + 1.0 * np.random.default_rng(0).standard_normal(signal.size)}, made.fs_hz, TEETH, (22, 26)
    )
    whole = np.arange(np.ceil(made.turns[0]), np.floor(made.turns[-1]) + 1.0)
    level = [
        synchronous_average(resample_to_angle(signal, made.fs_hz, angle_grid(pulses, TEETH[0] * 64)), TEETH[0], 64)
        for pulses in (np.interp(whole, made.turns, made.time_s), found.pulses_s, np.arange(0.1, 6.9, 1.0 / 24.0))
    ]
    spread = [one.signal.std() for one in level]
    assert spread[1] == pytest.approx(spread[0], rel=0.03)  # a fiftieth of a pitch costs (2 pi 4/50)^2 / 2 at h 4
    assert spread[2] < 0.5 * spread[0]
