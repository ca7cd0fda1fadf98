"""From a trained folder to an answer, or to none: distances, reasons, references, and files that are refused."""

from __future__ import annotations

import json
import pickle
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pyarrow import parquet

from diagnostics.cli.app import main
from diagnostics.prediction.prediction import predict_recording
from diagnostics.prediction.released_model import load_model
from diagnostics.prediction.training_distance import fit_part
from diagnostics.recordings.measured_recording import read_recording
from diagnostics.recordings.taken import RecordingFacts
from diagnostics.statistics.calibration import tempered
from siggen.errors import UsageError
from tests.rig_file import rig_file

FS_HZ = 12_800.0


def save(path: Path, dataset: Any, record: int, gain: float = 1.0) -> Path:
    row = dataset.record(record)
    signals = {name: gain * row[f"accel_{name}_m_s2"] for name in ("bearing_vertical", "bearing_horizontal")}
    np.savez(path, **signals, tacho_s=row["tacho_s"])
    return path


def save_as_siggen_does(path: Path, dataset: Any, record: int) -> Path:
    table = dataset.table.slice(record, 1).replace_schema_metadata({"siggen.identity": "0"})
    parquet.write_table(table, path)
    return path


def run(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "predict", *arguments])
    with pytest.raises(SystemExit) as stop:
        main()
    return int(stop.value.code or 0)


def options(folder: Path, *more: str) -> tuple[str, ...]:
    return ("--fs", "12800", "--teeth", "18,47", "--speed", "20,50", *rig_file(folder, unit="m/s2"), *more)


def test_a_record_of_the_family_gets_an_answer_with_plot_and_page(
    models_folder: Path, make_dataset: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    file = save_as_siggen_does(tmp_path / "run.parquet", make_dataset(("test",) * 2, seed=8), 2)  # severe
    assert run(monkeypatch, str(models_folder), str(file), *options(tmp_path, "--out", str(tmp_path / "out"))) == 0
    assert "answer:               severe" in capsys.readouterr().out
    found = json.loads((tmp_path / "out" / "prediction.json").read_text())
    assert found["state"] == "severe"
    assert found["mesh_frequency_hz"] == pytest.approx(540.0, rel=1e-3)
    assert sum(found["probabilities"]["indicators"][state] for state in ("healthy", "slight", "severe")) == (
        pytest.approx(1.0)
    )
    assert (tmp_path / "out" / "sidebands_bearing_vertical.png").read_bytes().startswith(b"\x89PNG")
    assert "severe" in (tmp_path / "out" / "prediction.html").read_text()


def test_no_state_of_a_measured_recording_is_named_without_a_healthy_one(
    models_folder: Path, make_dataset: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """The same samples as above, from a file that siggen did not write."""
    file = save(tmp_path / "run.npz", make_dataset(("test",) * 2, seed=8), 2)
    assert run(monkeypatch, str(models_folder), str(file), *options(tmp_path, "--out", str(tmp_path / "out"))) == 0
    said = capsys.readouterr().out
    assert "answer:               abstains" in said
    assert "named only beside healthy recordings" in said
    found = json.loads((tmp_path / "out" / "prediction.json").read_text())
    assert (found["state"], found["probabilities"]) == ("abstains", {})
    assert found["distance"]["value"] > 0.0
    assert found["indicators"]


def test_a_foreign_level_and_foreign_teeth_get_no_answer(
    models_folder: Path,
    dataset: Any,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    file = save(tmp_path / "run.npz", dataset, 0, gain=300.0)
    given = ("--fs", "12800", *rig_file(tmp_path, unit="m/s2", tacho="tacho_s"))
    assert run(monkeypatch, str(models_folder), str(file), *given, "--teeth", "18,47") == 0
    found = capsys.readouterr().out
    assert "answer:               abstains" in found
    assert "unlike the training records" in found
    file = save(tmp_path / "run.npz", dataset, 0)
    assert run(monkeypatch, str(models_folder), str(file), *given, "--teeth", "18,31") == 0
    assert "18/31 teeth, training covers 18/47 only" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("told", "arguments", "message"),
    [
        ({"fs_hz": 12_800}, (), "teeth unknown"),
        ({"teeth": "18,47"}, (), "sampling rate"),
        ({"fs_hz": 12_800, "teeth": [18, 47], "channels": {"casing": "x"}}, (), "no channel casing is wanted"),
        ({"fs_hz": 12_800, "teeth": [18, 47]}, ("--reference", "run.npz"), "without the healthy-referenced variant"),
    ],
)
def test_what_is_missing_is_a_usage_error_with_a_way_out(
    told: dict[str, object], arguments: tuple[str, ...], message: str, models_folder: Path, dataset: Any,
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    save(tmp_path / "run.npz", dataset, 0)
    monkeypatch.chdir(tmp_path)
    reading = rig_file(tmp_path, speed="20,50", unit="m/s2", **told)
    assert run(monkeypatch, str(models_folder), "run.npz", *reading, *arguments) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("nan.npz", {"bearing_vertical": np.r_[np.nan, np.ones(12_799)]}, "nan.npz: cannot be used channel"),
        ("still.npz", {"bearing_vertical": np.ones(12_800)}, "constant over all 12800 samples; check sensor"),
        (
            "clipped.npz",
            {"bearing_vertical": np.clip(np.sin(np.arange(12_800)), -0.5, 0.5)},
            "record again with a wider",
        ),
        ("short.npz", {}, "short.npz: 0.0781 s hold 3.91 turns"),
        ("other.npz", {"strange": np.ones(9)}, "other.npz: no column bearing_vertical"),
        ("run.docx", {}, "run.docx: holds no samples"),
        ("torn.mat", {}, "torn.mat: cannot be read as a MAT file"),
        (".", {}, "is a folder; give the file of one recording"),
        ("gone.npz", {}, "gone.npz: no such file"),
    ],
)
def test_a_recording_that_cannot_be_used_is_named_with_the_way_out(
    name: str, change: dict[str, np.ndarray], message: str, models_folder: Path, dataset: Any, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    with np.load(save(tmp_path / "run.npz", dataset, 0)) as whole:
        signals = {key: value.astype(float) for key, value in whole.items()}
    if name == "other.npz":
        np.savez(name, **change)
    elif name == "short.npz":
        np.savez(name, **{key: value[:1000] for key, value in signals.items()})
    elif name.endswith(".npz") and name != "gone.npz":
        np.savez(name, **(signals | change))
    elif name != ".":
        Path(name).write_bytes(b"no recording") if name != "gone.npz" else None
    assert run(monkeypatch, str(models_folder), name, *options(tmp_path)) == 2
    assert message in " ".join(capsys.readouterr().err.split())


def test_a_model_that_is_not_there_is_called_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "gone", "run.npz", *options(tmp_path)) == 2
    assert "gone: no such folder; MODEL is the folder that" in " ".join(capsys.readouterr().err.split())


class Trap:
    def __reduce__(self) -> tuple[Any, ...]:
        return (pytest.fail, ("a pickle was executed",))


@pytest.mark.parametrize("name", ["classifier.skops", "cnn.safetensors", "model.json"])
def test_loading_never_unpickles(name: str, models_folder: Path, tmp_path: Path) -> None:
    for file in models_folder.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / name).write_bytes(pickle.dumps(Trap()))
    with pytest.raises(UsageError, match=Path(name).stem):
        load_model(tmp_path)
    with pytest.raises(UsageError, match="not read"):
        load_model(tmp_path / name)


def test_distance_is_one_for_typical_records_whatever_the_speed_and_grows_off_them() -> None:
    rng = np.random.default_rng(4)
    speed = rng.uniform(10.0, 40.0, 2000)
    mixing = rng.standard_normal((5, 5))
    logs = rng.standard_normal((2000, 5)) @ mixing + 2.0 * np.log(speed)[:, None]
    found = fit_part(logs, speed, ("a", "b", "c", "d", "e"))
    # mean square of five unit Gaussians over five is one; clipping and the MAD leave a few per cent
    assert np.mean(found.distance(logs, speed) ** 2) == pytest.approx(1.0, rel=0.1)
    shifted = logs + 3.0 * mixing[0]
    assert np.median(found.distance(shifted, speed)) > 1.5
    level = fit_part(np.c_[logs[:, :1], np.full(2000, np.nan)], speed, ("a", "undefined"))
    assert np.isfinite(level.distance(np.c_[logs[:, :1], np.full(2000, np.nan)], speed)).all()


def test_probabilities_are_calibrated_as_the_models_own_are(
    models_folder: Path, make_dataset: Callable[..., Any], tmp_path: Path
) -> None:
    model = load_model(models_folder)
    file = save(tmp_path / "run.npz", make_dataset(("test",) * 2, seed=8), 2)
    recording = replace(read_recording(file, model.facts.channels, RecordingFacts(FS_HZ, unit="m/s2")), simulated=True)
    found = {}
    for temperature in (1.0, 3.0):
        tempered_model = replace(model, classifier=replace(model.classifier, temperature=temperature))
        found[temperature] = predict_recording(tempered_model, recording, (18, 47), (20.0, 50.0)).votes[0].probability
    assert found[3.0] == pytest.approx(tempered(found[1.0][np.newaxis], 3.0)[0], rel=1e-12)
    assert found[3.0].max() < found[1.0].max()
