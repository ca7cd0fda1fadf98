"""Indicators of one recording: the same as those of the record of a set, by the command and by the call."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from diagnostics.cli.app import app
from diagnostics.indicators.registry import column_title
from diagnostics.machine.recording_indicators import recording_indicators
from diagnostics.recordings.taken import RecordingFacts
from diagnostics.records.gear_train import PAIR
from siggen.errors import SiggenError
from tests.rig_file import rig_file

FS_HZ = 8000.0


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("recording") / "run.csv"
    time = np.arange(16_000) / FS_HZ
    rng = np.random.default_rng(0)
    turn = 25.0 * time
    lines = 3.0 * np.cos(2 * np.pi * 20 * turn) + np.cos(2 * np.pi * 40 * turn) + np.cos(2 * np.pi * 60 * turn)
    signal = lines * (1.0 + 0.2 * np.cos(2 * np.pi * turn)) + 0.1 * rng.normal(size=16_000)
    np.savetxt(file, np.stack([time, signal], axis=1), delimiter=",", header="t,lid", comments="")
    return file


def test_closed_forms_of_a_modulated_line(recording: Path) -> None:
    found = recording_indicators(recording, (20, 31), RecordingFacts(FS_HZ, unit="m/s2"), (20.0, 30.0))
    assert list(found.recording.channels) == ["lid"]
    assert found.pulses.speed_hz == pytest.approx(25.0, abs=0.01)  # the phase at the ends errs by 0.01 turns in 2 s
    values = found.channel("lid")
    # Half the squares of the amplitudes, sidebands and noise: (9 + 1 + 1)/2 (1 + 0.2²/2) + 0.01.
    assert values["rms"] == pytest.approx(np.sqrt(5.5 * 1.02 + 0.01), rel=2e-3)
    assert values["mesh_amplitude_h1"] == pytest.approx(3.0, rel=0.01)
    assert column_title("mesh_amplitude_h1", PAIR).endswith("mesh harmonic 1")


def test_the_command_writes_the_same_numbers_as_a_table(recording: Path, tmp_path: Path) -> None:
    facts = [
        "--fs",
        "8000",
        *rig_file(tmp_path, unit="m/s2"),
        "--teeth",
        "20,31",
        "--speed",
        "20,30",
        "--out",
        str(tmp_path / "found"),
    ]
    result = CliRunner().invoke(app, ["indicators", str(recording), *facts], catch_exceptions=False)
    assert result.exit_code == 0
    assert "mesh 500." in result.output
    with (tmp_path / "found" / "indicators.csv").open() as file:
        (row,) = csv.DictReader(file)
    called = recording_indicators(recording, (20, 31), RecordingFacts(FS_HZ, unit="m/s2"), (20.0, 30.0))
    assert float(row["rms"]) == pytest.approx(called.values["rms__lid"], rel=1e-12)
    assert "run.csv" in (tmp_path / "found" / "indicators.html").read_text()


def test_slips_are_named(recording: Path, tmp_path: Path) -> None:
    for arguments, told in (
        ([str(recording)], "teeth unknown"),
        ([str(recording), *rig_file(tmp_path, unit="m/s2"), "--teeth", "20,31"], "neither tacho nor speed"),
        ([str(recording), "--teeth", "20,31", "--indicator", "mine:own"], "--indicator: for sets only"),
        ([str(tmp_path / "none.csv"), "--teeth", "20,31"], "no such file"),
        ([str(tmp_path / "none.csv")], "none.csv: no such file or folder"),
        ([str(tmp_path), "--teeth", "20,31"], "is a folder; give the file of one recording"),
        ([str(tmp_path), "--out", "values.txt"], "a name that ends in .txt; allowed: a folder, or a table, .parquet"),
        ([str(tmp_path), str(tmp_path)], "a second argument"),
    ):
        with pytest.raises(SiggenError, match=told):
            CliRunner().invoke(app, ["indicators", *arguments], catch_exceptions=False)


def pulses(pulses_hz: float) -> np.ndarray:
    return np.where((pulses_hz * np.arange(16_000) / FS_HZ) % 1.0 < 0.1, 5.0, 0.0)


@pytest.mark.parametrize(
    ("columns", "told", "said"),
    [
        (
            {"tacho_1": pulses(25.0), "tacho_2": pulses(50.0)},
            {"tacho_pulses": 1},
            r"tell the speed of the first shaft disagree \(tacho_1 25 Hz, tacho_2 50 Hz\).*tacho: tacho_1",
        ),
        (
            {"key": pulses(25.0), "rpm [rpm]": np.full(16_000, 750.0)},
            {"tacho": "key", "tacho_pulses": 1, "speed": "10,15"},
            "the tacho gives 25 Hz of the first shaft, outside of 10 to 15 Hz",
        ),
        (
            {"tacho": pulses(25.0), "rpm [rpm]": np.full(16_000, 750.0)},
            {"tacho_pulses": 1},
            r"disagree \(tacho 25 Hz, speed 12.5 Hz\)",
        ),
        ({"side": np.full(16_000, 0.3)}, {"speed": "20,30"}, "channel side: constant over all 16000 samples"),
        (
            {"side": np.where(np.arange(16_000) % 3 == 0, 1e-12, 0.0) + 1.0},
            {"speed": "20,30"},
            "channel side: .*(stand at|no vibration)",
        ),
        ({"lid": None}, {"speed": "20,30"}, r"0.5 s hold 15 turns of the first shaft at 30 Hz; allowed are 20"),
    ],
    ids=["two tachos", "tacho and range", "tacho and speed", "constant", "rounding alone", "15 turns"],
)
def test_recordings_that_contradict_themselves_or_say_nothing_are_refused(
    columns: dict[str, np.ndarray | None], told: dict[str, object], said: str, recording: Path, tmp_path: Path
) -> None:
    held = dict(zip(("t", "lid"), np.loadtxt(recording, delimiter=",", skiprows=1).T, strict=True))
    held |= {name: values for name, values in columns.items() if values is not None}
    size = 4000 if any(values is None for values in columns.values()) else 16_000
    np.savez(tmp_path / "run.npz", **{name: values[:size] for name, values in held.items()})
    line = ["indicators", str(tmp_path / "run.npz"), *rig_file(tmp_path, unit="m/s2", teeth=[20, 31], **told)]
    with pytest.raises(SiggenError, match=said):
        CliRunner().invoke(app, line, catch_exceptions=False)
