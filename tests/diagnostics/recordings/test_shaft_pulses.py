"""Pulses of the pinion of a recording: from its tacho, from its mesh lines, or refused with the file's name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diagnostics.cli.recording_options import known_speed_range_hz
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import shaft_pulses
from diagnostics.records.gear_train import pair_train
from siggen.errors import UsageError
from tests.diagnostics.calibration.hidden_machine import hidden_record
from tests.diagnostics.signal.made_gears import made_gears

TEETH = (18, 47)
TRAIN = pair_train(TEETH)


def recording(seconds: float = 4.0, tacho_s: np.ndarray | None = None, **made: float) -> MeasuredRecording:
    gears = made_gears(TEETH, seconds=seconds, speed_hz=30.0, noise=1.0, **made)  # type: ignore[arg-type]
    return MeasuredRecording(Path("run.npz"), gears.channels, gears.fs_hz, tacho_s)


def test_pulses_come_from_the_mesh_lines_and_say_how_far_their_halves_agree() -> None:
    found = shaft_pulses(recording(), TRAIN, (25.0, 36.0))
    assert found.outcome == "angle"
    assert found.times_s.size - 1 == pytest.approx(4.0 * 30.0, abs=2)
    assert found.agreement_pitches is not None
    assert found.agreement_pitches < 0.1
    assert "mesh lines, halves within" in found.origin
    assert found.facts["angle"] == "angle"


def test_a_tacho_is_taken_where_there_is_one() -> None:
    found = shaft_pulses(recording(tacho_s=np.arange(80) / 30.0), TRAIN, (25.0, 36.0))
    assert found.origin == "tacho"
    assert found.agreement_pitches is None


def test_a_speed_without_an_angle_is_an_answer_only_where_it_is_wanted() -> None:
    made = recording()
    gone = np.abs(np.arange(51_200) / 12_800.0 - 2.0) < 0.5
    noise = 0.3 * np.random.default_rng(2).standard_normal(gone.size)
    broken = MeasuredRecording(
        made.path, {name: np.where(gone, noise, signal) for name, signal in made.channels.items()}, made.fs_hz, None
    )
    found = shaft_pulses(broken, TRAIN, (25.0, 36.0), speed_alone=True)
    assert found.outcome == "speed only"
    assert found.times_s.size == 0
    assert found.speed_hz == pytest.approx(30.0, rel=0.01)
    with pytest.raises(UsageError, match=r"run.npz: .* speed only: .*Averages need the angle"):
        shaft_pulses(broken, TRAIN, (25.0, 36.0))


def test_without_tacho_and_range_and_with_too_few_turns_the_file_is_named() -> None:
    with pytest.raises(UsageError, match=r"run.npz: neither tacho nor speed"):
        shaft_pulses(recording(), TRAIN, None)
    with pytest.raises(UsageError, match=r"run.npz: 4 whole turns of the first shaft; averages of both shafts need 6"):
        shaft_pulses(recording(tacho_s=np.arange(5) / 30.0), TRAIN, None)
    with pytest.raises(UsageError, match=r"run.npz: speed range"):
        shaft_pulses(recording(), TRAIN, (40.0, 30.0))


@pytest.mark.parametrize("said", ["30", "30 Hz", "1800rpm", "1800 1/min"])
def test_a_known_speed_is_a_range_of_3_percent(said: str) -> None:
    assert known_speed_range_hz(said) == pytest.approx((29.1, 30.9))


@pytest.mark.parametrize("said", ["", "fast", "-3", "0", "30 m/s", "1e9999"])
def test_what_is_no_speed_is_refused(said: str) -> None:
    with pytest.raises(UsageError, match="allowed is a speed in Hz or rpm"):
        known_speed_range_hz(said)


@pytest.mark.slow  # simulates a recording, and searches it twice
def test_a_second_stage_louder_than_the_mesh_lines_does_not_pass_for_them() -> None:
    """Its lines lead in every part of the range that is wide enough to hold both; the shaft's own lines decide."""
    channels, pulses = hidden_record()
    made = MeasuredRecording(Path("run.csv"), channels, 25_600.0, None, False)
    true_hz = (pulses.size - 1) / (pulses[-1] - pulses[0])
    assert shaft_pulses(made, TRAIN, (30.0, 40.0)).speed_hz == pytest.approx(true_hz, rel=1e-4)
    with pytest.raises(UsageError):
        shaft_pulses(made, TRAIN, (36.0, 41.0))
