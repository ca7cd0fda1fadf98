"""A rig file: what it may say, what it is refused for, and how one comes by it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from diagnostics.cli.app import app
from diagnostics.recordings.rig_file import KEYS, read_rig_file
from diagnostics.recordings.taken import RecordingFacts
from siggen.errors import ConfigError, UsageError

FS_HZ = 8000.0


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Two seconds of a shaft at 25 Hz with 20 teeth, in g, with a pulse per turn; the file states neither."""
    turn = 25.0 * np.arange(16_000) / FS_HZ
    lid = sum(np.cos(2 * np.pi * 20 * k * turn) / k for k in (1, 2, 3)) * (1.0 + 0.2 * np.cos(2 * np.pi * turn))
    noise = 0.1 * np.random.default_rng(1).normal(size=turn.size)
    np.savez(tmp_path / "run.npz", ch1=lid + noise, tacho=np.where(turn % 1.0 < 0.1, 5.0, 0.0))
    return tmp_path / "run.npz"


def run(*arguments: object) -> str:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_a_call_that_lacks_something_leads_to_a_rig_file_that_is_written_and_filled_in(recording: Path) -> None:
    rig = recording.with_name("rig.yaml")
    with pytest.raises(UsageError, match=r"no unit of ch1 is stated.*`unit: g` in the rig file \(--rig rig.yaml"):
        run("indicators", recording, "--fs", FS_HZ, "--teeth", "20,31")
    with pytest.raises(UsageError, match=r"rig.yaml: was not there; written with the columns of .*run.npz"):
        run("indicators", recording, "--rig", rig)
    written = rig.read_text(encoding="utf-8")
    assert 'channels: {"ch1": "ch1"}' in written
    for key in KEYS:
        written = written.replace(f"# {key}: {KEYS[key].example}", f"{key}: {KEYS[key].example}")
    rig.write_text(written, encoding="utf-8")
    assert all(read_rig_file(rig).said.values())  # every example is allowed
    lines = ("channels: {lid: ch1}", "unit: g", "tacho_pulses: 1", "teeth: [20, 31]", "fs_hz: 8000")
    rig.write_text("\n".join(lines), encoding="utf-8")
    said = run("indicators", recording, "--rig", rig)
    # half the squares of the amplitudes and sidebands, and of the noise
    rms = 9.80665 * np.sqrt(0.5 * (1.0 + 1.0 / 4.0 + 1.0 / 9.0) * 1.02 + 0.01)
    assert f"pinion 25.0000 Hz, mesh 500.00 Hz (tacho); rms lid {rms:.2f}" in said


def test_a_rig_file_that_is_written_holds_what_was_given(recording: Path) -> None:
    rig = recording.with_name("new.yaml")
    with pytest.raises(UsageError, match="was not there"):
        run("indicators", recording, "--rig", rig, "--fs", FS_HZ, "--teeth", "20/31", "--speed", "20, 30")
    found = read_rig_file(rig)
    assert (found.teeth, found.speed, found.said["fs_hz"]) == ("20/31", "20, 30", FS_HZ)


def test_options_replace_what_the_rig_file_says(recording: Path) -> None:
    rig = recording.with_name("rig.yaml")
    rig.write_text("{unit: g, tacho_pulses: 1, teeth: '10,31', fs_hz: 4000}", encoding="utf-8")
    assert "mesh 500.00 Hz" in run("indicators", recording, "--rig", rig, "--fs", FS_HZ, "--teeth", "20,31")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("sampling: 8000", "sampling: .*an unknown key.*allowed: teeth, fs_hz"),
        ("fs_hz: -1", r"fs_hz: .*-1.*a rate \[Hz\], such as 25600"),
        ("fs_hz: .nan", "fs_hz: .*nan"),
        ("tacho_pulses: 1.5", "tacho_pulses: .*1.5.*a whole number"),
        ("tacho_pulses: true", "tacho_pulses: .*True"),
        ("channels: [lid]", "channels: .*columns by names"),
        ("torque_nm: [60, 15]", "torque_nm: .*the lower one first"),
        ("teeth: [20]", "teeth: .*two whole numbers"),
        ("unit: g\nunit: mg", "a second time"),
        ("", "an empty file"),
    ],
)
def test_what_a_rig_file_cannot_say_is_refused_by_name(text: str, told: str, tmp_path: Path) -> None:
    (tmp_path / "rig.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=told):
        read_rig_file(tmp_path / "rig.yaml")


def test_what_it_does_not_say_stays_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "rig.yaml").write_text("{channels: {lid: cover}, teeth: gearbox.yaml, speed: 29.7}", encoding="utf-8")
    found = read_rig_file(tmp_path / "rig.yaml")
    before = RecordingFacts(FS_HZ, {"lid": "lid", "side": "side"}, unit="g", tacho_pulses=2)
    after = found.over(before)
    assert (after.fs_hz, after.unit, after.tacho_pulses) == (FS_HZ, "g", 2)
    assert after.columns == {"lid": "cover", "side": "side"}
    assert (found.teeth, found.speed) == (str(tmp_path / "gearbox.yaml"), "29.7")
