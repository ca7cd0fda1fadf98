"""Recordings of a machine on the page: over the healthy one nearest in speed, with their verdicts, any name as text."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from diagnostics.cli.app import app
from diagnostics.explore.measured_page import ShownRecording, recordings_source
from diagnostics.machine.check import PastCheck
from diagnostics.machine.recording_indicators import recording_indicators
from diagnostics.recordings.taken import RecordingFacts
from siggen.errors import UsageError
from tests.diagnostics.explore.test_explorer import Read
from tests.diagnostics.explore.unpacked import held, listed, rows
from tests.diagnostics.machine.test_check import FS_HZ, write_recording
from tests.rig_file import rig_file

FACTS = ("--fs", str(FS_HZ), "--teeth", "20,31", "--speed", "20,30")


def run(*arguments: object) -> str:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def test_recordings_are_laid_over_the_healthy_one_nearest_in_speed(tmp_path: Path) -> None:
    slow = write_recording(tmp_path / "slow.npz", seed=1, speed_hz=22.0)
    fast = write_recording(tmp_path / "fast.npz", seed=2, speed_hz=28.0)
    new = write_recording(tmp_path / "<img src=x onerror=alert(1)>.npz", seed=3, speed_hz=27.0, knock=0.8)
    page = tmp_path / "page.html"
    others = [write_recording(tmp_path / f"other_{k}.npz", seed=10 + k, speed_hz=25.0) for k in range(2)]
    run("baseline", slow, fast, *others, *FACTS, *rig_file(tmp_path, unit="m/s2"), "--out", tmp_path / "rig")
    said = run("explore", tmp_path / "rig", slow, fast, new, "--out", page)
    assert said.count("mesh lines, halves within") == 3
    elements = held(page)
    data, found = elements["look-data"], Read(page.read_text(encoding="utf-8"))
    records = listed(data)
    assert [record["name"] for record in records] == ["slow.npz", "fast.npz", new.name]
    assert rows(data["overlay"]) == [1, 0, 1]
    assert [record["fault"] for record in records] == ["healthy", "healthy", "unknown"]
    assert [round(record["speed_hz"]) for record in records] == [22, 28, 27]
    assert data["measured"]
    assert "img" not in found.tags
    signals = [elements[f"look-record-{row}"]["channels"]["lid"] for row in range(3)]
    assert all({"wave", "spectrum", "envelope", "averages"} <= set(one) for one in signals)


def test_a_machine_gives_its_references_and_verdicts_but_no_samples(tmp_path: Path) -> None:
    files = [write_recording(tmp_path / f"healthy_{k}.npz", seed=k) for k in range(4)]
    new = write_recording(tmp_path / "august.npz", seed=9, knock=0.8)
    run("baseline", *files, *FACTS, *rig_file(tmp_path, unit="m/s2"), "--load", "40", "--out", tmp_path / "rig")
    past = PastCheck("2026-01-01", "august.npz", "changed", 25.0, 9.0, 3.0)
    line = json.dumps({name: getattr(past, name) for name in PastCheck.__slots__})
    (tmp_path / "rig" / "checks.jsonl").write_text(f"{line}\n")
    run("explore", tmp_path / "rig", *files, new, "--out", tmp_path / "page.html")
    records = listed(held(tmp_path / "page.html")["look-data"])
    assert [record["state"] for record in records] == [*["healthy reference"] * 4, "changed"]
    assert [record["torque_nm"] for record in records] == [*[40.0] * 4, None]
    with pytest.raises(UsageError, match="holds no samples of its recordings"):
        run("explore", tmp_path / "rig")


def test_recordings_of_another_rate_or_other_channels_are_refused_by_name(tmp_path: Path) -> None:
    one = write_recording(tmp_path / "one.npz", seed=1)
    found = recording_indicators(one, (20, 31), RecordingFacts(fs_hz=FS_HZ, unit="m/s2"), (20.0, 30.0))
    slow = replace(found, name="slow.npz", recording=replace(found.recording, fs_hz=4000.0))
    with pytest.raises(UsageError, match=r"slow.npz: recorded at 4000 Hz, one.npz at 8000 Hz"):
        recordings_source([ShownRecording(found, "unchanged", 0.0), ShownRecording(slow, "unchanged", 0.0)])
    lid = replace(found, name="lid.npz", recording=replace(found.recording, channels={"lid": np.zeros(9)}))
    with pytest.raises(UsageError, match=r"lid.npz: has the channels lid, one.npz lid, side"):
        recordings_source([ShownRecording(found, "unchanged", 0.0), ShownRecording(lid, "unchanged", 0.0)])
