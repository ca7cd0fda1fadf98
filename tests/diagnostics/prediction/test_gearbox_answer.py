"""The network that comes along: what it says of recordings without training, and when it cannot tell."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import diagnostics
import siggen
from diagnostics.cli.app import main
from diagnostics.prediction.gearbox_answer import WITHOUT_TACHO, GearboxAnswer
from diagnostics.records.state_classes import HEALTHY
from diagnostics.training.shipped_network import DAMAGE, SHIPPED
from tests.rig_file import rig_file

FS_HZ = 25_600.0


@pytest.fixture(scope="module")
def gearboxes(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Return four gearboxes, healthy twice and with a spall over 80 % of the face, of teeth that training has not."""
    folder = tmp_path_factory.mktemp("answers") / "set"
    family = folder.with_suffix(".yaml")
    family.write_text(
        "extends: quickstart\nspecimens: 4\nsplits: {train: 12, validation: 4, test: 4}\nstates:\n  others: null\n"
        "  healthy: {}\n  healthy_again: {}\n  spalled:\n    severity: severe\n    damage:\n      kind: irregular\n"
        "      gear: pinion\n      teeth: 1\n      centre_height_mm: below_pitch\n      profile_length_mm: 1.0\n"
        "      face_share: 0.8\n      skew_mm_per_10mm: [-0.18, 0.18]\n      waviness: [0.05, 0.1]\n"
        "      edge_radius_mm: [0.02, 0.2]\n"
    )
    siggen.generate(siggen.load_config(str(family)), folder, executor="serial")
    return siggen.open(folder)


def saved(path: Path, record: Any, **change: Any) -> str:
    np.savez(path, **({name: record[name] for name in COLUMNS} | change))
    return str(path)


COLUMNS = ("accel_lid_vertical_m_s2", "accel_side_horizontal_m_s2", "tacho_s")


def run(monkeypatch: pytest.MonkeyPatch, folder: Path, *arguments: str) -> int:
    rig = rig_file(folder, unit="m/s2")
    teeth = () if "--teeth" in arguments else ("--teeth", "18,47")
    rate = () if "--fs" in arguments else ("--fs", "25600")
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "predict", *arguments, *teeth, *rate, *rig])
    with pytest.raises(SystemExit) as stop:
        main()
    return int(stop.value.code or 0)


def told(capsys: pytest.CaptureFixture[str]) -> list[dict[str, Any]]:
    return list(json.loads(capsys.readouterr().out)["predictions"])


def records_of(dataset: Any, state: str) -> Iterator[Any]:
    labels = dataset.labels(columns=["record_id", "state"]).to_pylist()
    yield from (dataset.record(row["record_id"]) for row in labels if row["state"] == state)


def test_a_large_spall_is_told_beside_a_healthy_recording_and_nothing_of_a_healthy_one(
    gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    states = ("healthy", "healthy_again", "spalled")
    for number, records in enumerate(zip(*(records_of(gearboxes, state) for state in states), strict=True)):
        healthy, again, spalled = (
            saved(tmp_path / f"{state}{number}.npz", record) for state, record in zip(states, records, strict=True)
        )
        assert run(monkeypatch, tmp_path, again, spalled, "--reference", healthy, "--json") == 0
        quiet, loud = told(capsys)
        assert quiet["answer"] == "no damage seen"
        assert loud["answer"] == "damage"
        assert max(loud["kinds"], key=loud["kinds"].__getitem__) == "spalling"
        assert loud["gears"]["pinion"] > 0.9


def test_the_network_answers_where_pytorch_is_not_installed(gearboxes: Any, tmp_path: Path) -> None:
    file = saved(tmp_path / "run.npz", next(records_of(gearboxes, "spalled")))
    command = ["siggen-diagnostics", "predict", file, "--teeth", "18,47", "--fs", "25600", *rig_file(tmp_path)]
    code = (
        f"import sys; sys.modules['torch'] = None; sys.argv = {command!r}; from diagnostics.cli.app import main; main()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "answer:" in done.stdout


def test_the_page_says_what_the_terminal_says(
    gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = saved(tmp_path / "run.npz", next(records_of(gearboxes, "spalled")))
    assert run(monkeypatch, tmp_path, file, "--out", str(tmp_path / "out")) == 0
    headline = capsys.readouterr().out.splitlines()[0].removeprefix("run.npz: ")
    page = (tmp_path / "out" / "prediction.html").read_text(encoding="utf-8")
    assert headline.partition(";")[0] in page.replace("Damage,", "damage,").replace("No damage", "no damage")
    assert json.loads((tmp_path / "out" / "prediction.json").read_text())["answer"] in headline
    assert len(list((tmp_path / "out").glob("sidebands_*.png"))) == 2


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--teeth", "18,200"), "the gear has 200 teeth, training covers"),
        (("--fs", "20000"), "the sampling rate is 20000 Hz, training has 25600 Hz"),
        (("--fs", "51200"), "training covers 24 to 38 Hz"),
    ],
)
def test_what_was_never_learnt_from_cannot_be_told(
    options: Sequence[str], reason: str, gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    record, scale = next(records_of(gearboxes, "spalled")), 1.0
    if "--fs" in options:
        scale = FS_HZ / float(options[1])
    file = saved(tmp_path / "run.npz", record, tacho_s=np.asarray(record["tacho_s"]) * scale)
    assert run(monkeypatch, tmp_path, file, *options, "--json") == 0
    (answer,) = told(capsys)
    assert answer["answer"] == "cannot tell"
    assert any(reason in one for one in answer["reasons"])


@pytest.mark.parametrize("what", ["noise", "tones", "clicks"])
def test_signals_of_no_gearbox_are_unlike_the_training(
    what: str, gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    record, rng = next(records_of(gearboxes, "healthy")), np.random.default_rng(0)
    size = len(record[COLUMNS[0]])
    time_s = np.arange(size) / FS_HZ
    signal = {
        "noise": rng.standard_normal(size),
        "tones": sum(np.sin(2.0 * np.pi * f * time_s) for f in (100.0, 1000.0, 3000.0))
        + 0.01 * rng.standard_normal(size),
        "clicks": 0.01 * rng.standard_normal(size) + 5.0 * (np.arange(size) % round(FS_HZ / 100.0) == 0),
    }[what]
    file = saved(tmp_path / "run.npz", record, **dict.fromkeys(COLUMNS[:2], signal))
    assert run(monkeypatch, tmp_path, file, "--json") == 0
    (answer,) = told(capsys)
    assert answer["answer"] == "cannot tell"
    assert any("unlike the training" in reason or "mesh lines" in reason for reason in answer["reasons"])


@pytest.mark.parametrize("what", ["tacho late by two samples", "sign", "gain", "another gearbox"])
def test_a_reference_that_does_not_lie_over_the_recording_is_no_reference(
    what: str, gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    healthy, again = (list(records_of(gearboxes, state)) for state in ("healthy", "healthy_again"))
    changed: dict[str, Any] = {
        "tacho late by two samples": {"tacho_s": np.asarray(again[0]["tacho_s"]) + 2.0 / FS_HZ},
        "sign": {COLUMNS[0]: -again[0][COLUMNS[0]]},
        "gain": {COLUMNS[0]: 1.5 * again[0][COLUMNS[0]]},
        "another gearbox": {name: again[1][name] for name in COLUMNS[:2]},
    }
    file, reference = saved(tmp_path / "run.npz", again[0], **changed[what]), saved(tmp_path / "old.npz", healthy[0])
    assert run(monkeypatch, tmp_path, file, "--reference", reference, "--json") == 0
    (answer,) = told(capsys)
    assert answer["answer"] == "cannot tell"
    assert any("old.npz" in reason for reason in answer["reasons"])


def test_a_missing_pulse_is_said(
    gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    record = next(records_of(gearboxes, "healthy"))
    file = saved(tmp_path / "run.npz", record, tacho_s=np.delete(np.asarray(record["tacho_s"]), 20))
    assert run(monkeypatch, tmp_path, file, "--json") == 0
    assert any("a pulse is missing at" in reason for reason in told(capsys)[0]["reasons"])


def test_a_recording_is_no_reference_of_itself_and_teeth_have_to_be_said(
    gearboxes: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = saved(tmp_path / "run.npz", next(records_of(gearboxes, "healthy")))
    assert run(monkeypatch, tmp_path, file, "--reference", file) == 2
    assert "has the same samples as the recording" in " ".join(capsys.readouterr().err.split())
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "predict", file])
    with pytest.raises(SystemExit) as stop:
        main()
    assert stop.value.code == 2
    assert "teeth unknown" in capsys.readouterr().err


def test_features_of_the_network_are_a_table_that_classifiers_learn_from(gearboxes: Any) -> None:
    alone, beside = (diagnostics.pretrained_features(gearboxes, beside=side) for side in (False, True))
    assert alone.names[0] == DAMAGE
    assert alone.values.shape == beside.values.shape == (12, len(alone.names))
    assert np.isfinite(alone.values).all()
    ill = beside.labels["fault"] != HEALTHY
    assert beside.values[ill, 0].min() > beside.values[~ill, 0].max()
    table = diagnostics.table(gearboxes)
    assert (alone.labels["record_id"] == table.labels["record_id"]).all()
    assert alone.labels.keys() == table.labels.keys()  # what `evaluate` judges by, shams too


def test_the_weights_are_small_and_their_card_says_what_they_are_of() -> None:
    card = json.loads(SHIPPED.with_suffix(".json").read_text(encoding="utf-8"))
    assert SHIPPED.stat().st_size <= 5e6
    assert card["parameters"] <= 500_000
    assert card["gearboxes"] >= 2000
    assert {"seed", "families", "streams", "weights_sha256", "no_use", "scores_of_unseen_pairs"} <= card.keys()


def test_the_first_line_says_that_healthy_recordings_were_left_out() -> None:
    """And what shares of records mean, counted of a hundred."""
    nothing: dict[str, Any] = {one.name: None for one in fields(GearboxAnswer)}
    answer = GearboxAnswer(**nothing | {"reasons": (), "said": False, "unseen": 0.24, "notes": (WITHOUT_TACHO,)})
    seen = "no damage seen; of 100 damaged records of training 24 look as healthy as this one"
    assert replace(answer, notes=()).headline == seen
    assert answer.headline == f"healthy recordings were left out, since they need a tacho; {seen}"
