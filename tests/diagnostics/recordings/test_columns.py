"""A column of times is no channel: it states the rate, which may not contradict what the user says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from diagnostics.cli.app import app
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.roles import ColumnUse
from diagnostics.recordings.taken import RecordingFacts, channel_names, take
from siggen.errors import UsageError

FS_HZ, SAMPLES = 25_600, 5_000
TIMES_S = 3.0 + np.arange(SAMPLES) / FS_HZ


def write(folder: Path, time: list[str], header: str = "time;lid", separator: str = ";") -> Path:
    values = np.random.default_rng(0).standard_normal(SAMPLES)
    rows = (separator.join((at, f"{value:.5f}")) for at, value in zip(time, values, strict=True))
    file = folder / "run.csv"
    file.write_text(f"{header}\n" + "\n".join(rows) + "\n", encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("header", "scale", "digits"),
    [
        ("time;lid", 1.0, 6),
        ("time;lid", 1.0, 9),
        ("t [ms];lid", 1e3, 3),
        ("zeit_us;lid", 1e6, 0),
        ("time;lid\nms;g", 1e3, 4),
        ("x;lid", 1.0, 5),
    ],
)
def test_the_rate_comes_from_the_times_however_they_are_rounded(
    tmp_path: Path, header: str, scale: float, digits: int
) -> None:
    file = write(tmp_path, [f"{scale * at:.{digits}f}" for at in TIMES_S], header)
    assert channel_names(take(file, RecordingFacts(), say=False)) == ("lid",)
    found = read_recording(file, ("lid",), RecordingFacts(unit="g"))
    # five digits behind the point leave the rate open by 1e-5 s in 0.2 s
    assert found.fs_hz == (FS_HZ if digits > 5 or scale > 1.0 else pytest.approx(FS_HZ, rel=1e-4))


@pytest.mark.parametrize(("column", "channel"), [("accel_m_s2", "accel"), ("accel_lid_m_s2", "lid")])
def test_acceleration_in_m_s2_needs_no_rig_file(tmp_path: Path, column: str, channel: str) -> None:
    file = write(tmp_path, [f"{at:.6f}" for at in TIMES_S], f"time_s;{column}")
    assert channel_names(take(file, RecordingFacts(), say=False)) == (channel,)
    found = read_recording(file, (channel,), RecordingFacts())
    written = np.random.default_rng(0).standard_normal(SAMPLES)
    np.testing.assert_allclose(found.channels[channel], written, atol=1e-5)


def test_a_counter_of_samples_is_no_channel_and_states_no_rate(tmp_path: Path) -> None:
    file = write(tmp_path, [str(k) for k in range(SAMPLES)], "sample;lid")
    assert channel_names(take(file, RecordingFacts(), say=False)) == ("lid",)
    assert take(file, RecordingFacts()).fs_hz is None
    with pytest.raises(UsageError, match="--fs 51200"):
        read_recording(file, ("lid",), RecordingFacts(unit="g"))


def test_a_rate_that_contradicts_the_times_is_refused_and_so_is_a_time_as_a_channel(tmp_path: Path) -> None:
    file = write(tmp_path, [f"{at:.6f}" for at in TIMES_S])
    with pytest.raises(UsageError, match=r"states 25600 Hz, received 51200 Hz by --fs"):
        read_recording(file, ("lid",), RecordingFacts(fs_hz=51_200.0))
    assert read_recording(file, ("lid",), RecordingFacts(fs_hz=25_600.0, unit="g")).fs_hz == FS_HZ
    with pytest.raises(UsageError, match=r"column time is a time \(name\), not channel lid"):
        read_recording(file, ("lid",), RecordingFacts(columns={"lid": "time"}, unit="g"))


def test_a_signal_that_rises_now_and_then_and_pulses_of_a_tacho_are_no_times(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    np.savez(tmp_path / "run.npz", ramp=TIMES_S + 3e-5 * rng.standard_normal(SAMPLES), tacho_s=np.arange(60) / 30.0)
    taken = take(tmp_path / "run.npz", RecordingFacts(fs_hz=FS_HZ))
    assert {one.name: one.role for one in taken.columns} == {"ramp": ColumnUse.VIBRATION, "tacho_s": ColumnUse.TACHO}


def test_an_angle_in_radians_states_no_rate_however_evenly_it_rises(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    angle = 0.7 * np.arange(SAMPLES)
    np.savez(tmp_path / "run.npz", time=TIMES_S, angle_rad=angle, lid=rng.standard_normal(SAMPLES))
    assert read_recording(tmp_path / "run.npz", ("lid",), RecordingFacts(unit="g")).fs_hz == FS_HZ
    assert channel_names(take(tmp_path / "run.npz", RecordingFacts(), say=False)) == ("lid",)


def test_an_angle_that_rises_evenly_beside_the_time_leaves_the_rate_to_the_time(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    np.savez(tmp_path / "run.npz", time=TIMES_S, alpha=0.7 * np.arange(SAMPLES), lid=rng.standard_normal(SAMPLES))
    found = take(tmp_path / "run.npz", RecordingFacts(unit="g"))
    assert found.fs_hz == FS_HZ
    assert found.column("alpha").role is ColumnUse.COUNTER


def test_a_wrong_name_is_refused_where_the_only_signal_has_another(tmp_path: Path) -> None:
    np.savez(tmp_path / "run.npz", time=TIMES_S, oil=np.random.default_rng(2).standard_normal(SAMPLES))
    with pytest.raises(UsageError, match="no column lid"):
        read_recording(tmp_path / "run.npz", ("lid",), RecordingFacts())


@pytest.mark.parametrize(
    ("header", "at", "jump_s", "said"),
    [
        (
            "time;lid",
            1200,
            0.25,
            r"time, has a gap: it jumps from 3\.04683\d* to 3\.29687\d* behind sample 1200, by 6401 steps",
        ),
        (
            "x;lid",
            1200,
            2.0 / FS_HZ,
            r"x, a time, has a gap: .* behind sample 1200, by 3 steps of 3\.91e-05",
        ),
        ("time;lid", 4000, -3.0, r"time, steps back: .* behind sample 4000, by -76799 steps"),
    ],
    ids=["a gap", "two samples lost", "a clock set back"],
)
def test_a_gap_in_the_times_is_refused_with_its_place_and_the_longest_whole_piece(
    tmp_path: Path, header: str, at: int, jump_s: float, said: str
) -> None:
    times = TIMES_S + np.where(np.arange(SAMPLES) >= at, jump_s, 0.0)
    whole = f"samples {at + 1} to {SAMPLES}" if at < SAMPLES / 2 else f"samples 1 to {at}"
    file = write(tmp_path, [f"{time:.6f}" for time in times], header)
    result = CliRunner().invoke(app, ["indicators", str(file), "--teeth", "20,31", "--speed", "20,30"])
    assert isinstance(result.exception, UsageError)
    assert re.search(said, str(result.exception))
    assert f"{whole} are the longest whole piece" in str(result.exception)
