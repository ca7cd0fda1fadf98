"""`report` with another set and unusable input: exit codes and what is written."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from diagnostics.cli.app import main
from siggen.dataset import reading

SPLITS = ("train",) * 4 + ("validation",) * 2 + ("test",) * 3


def run(monkeypatch: pytest.MonkeyPatch, sets: dict[str, Any], *arguments: str) -> int:
    monkeypatch.setattr(reading, "open", lambda path: sets[Path(path).name])
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "report", *arguments])
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


@pytest.fixture(scope="module")
def sets(make_dataset: Callable[..., Any]) -> dict[str, Any]:
    """Two sets of different gearboxes."""
    other = make_dataset(("test",) * 3, seed=8)
    return {"first": make_dataset(SPLITS), "second": replace(other, manifest={"identity": "1" * 64, "name": "second"})}


def test_states_that_training_does_not_know_are_found_damaged_and_not_named(
    sets: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def other(states: dict[str, str]) -> Any:
        table = sets["second"].table
        named = pa.array([states.get(name, name) for name in table.column("state").to_pylist()])
        return replace(sets["second"], table=table.set_column(table.column_names.index("state"), "state", named))

    offered = {"first": sets["first"], "second": other({"severe": "chipped"})}
    command = ("first", "--out", str(tmp_path / "out"), "--test", "second", "--no-cnn")
    assert run(monkeypatch, offered, *command) == 0
    metrics = json.loads((tmp_path / "out" / "metrics.json").read_text())
    card = (tmp_path / "out" / "models" / "model_card.md").read_text()
    told = " ".join(metrics["notes"])
    assert "of chipped, which training does not know, are judged by whether damage is found" in told
    # severities alone would not tell a reader what the models find
    assert "states: healthy, slight, severe; faults: pitting in slight, severe" in card
    found = metrics["training"]["classifiers_on_other_set"]["indicators"]
    whole = sets["second"].table.num_rows
    assert found["test_records"] == whole * 2 // 3
    assert found["detection"]["auroc_by_state"].keys() == {"slight"}
    assert found["detection"]["auroc"]["value"] > 0.5
    offered = {"first": sets["first"], "second": other({"severe": "chipped", "slight": "worn"})}
    assert run(monkeypatch, offered, *command) == 2
    assert "chipped, worn, which training does not know" in capsys.readouterr().err


@pytest.mark.slow
def test_another_set_is_in_the_metrics(sets: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    arguments = ("first", "--out", str(tmp_path), "--test", "second", "--no-cnn")
    assert run(monkeypatch, sets, *arguments) == 0
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    assert set(metrics["training"]["classifiers_on_other_set"]) == {"indicators", "boosting", "rms"}
    assert "calibration error" in (tmp_path / "models" / "model_card.md").read_text()


def one_training_specimen(dataset: Any) -> Any:
    column = dataset.table.column("specimen_id")
    keep = pc.or_(pc.equal(column, 0), pc.greater_equal(column, 4))
    return replace(dataset, table=dataset.table.filter(keep))


def silent_channel(dataset: Any) -> Any:
    name = "accel_bearing_vertical_m_s2"
    position = dataset.table.schema.get_field_index(name)
    kind = dataset.table.schema.field(name).type
    values = pa.array(np.zeros(dataset.table.num_rows * kind.list_size, dtype=np.float32))
    return replace(
        dataset,
        table=dataset.table.set_column(position, name, pa.FixedSizeListArray.from_arrays(values, kind.list_size)),
    )


def test_one_gearbox_to_learn_from_is_a_page_without_a_classifier(
    sets: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    offered = {"first": one_training_specimen(sets["first"])}
    assert run(monkeypatch, offered, "first", "--out", str(tmp_path), "--no-cnn") == 0
    notes = " ".join(json.loads((tmp_path / "metrics.json").read_text())["notes"])
    for part in ("one specimen of healthy, slight, severe", "specimens=N"):
        assert part in notes


@pytest.mark.parametrize(
    ("change", "options", "parts"),
    [
        (silent_channel, (), ("channel bearing_vertical is constant", "--channel bearing_horizontal")),
        (lambda found: found, ("--channel", "top"), ("received top", "bearing_vertical, bearing_horizontal")),
        (lambda found: found, ("--test", "slower"), ("6400 Hz", "fs_hz: 12800")),
        (lambda found: found, ("--device", "tpu"), ("received 'tpu'", "cpu, cuda")),
        (lambda found: found, ("--device", "cuda"), ("--device cuda: ", "leave --device out to train on the CPU")),
    ],
    ids=["silent", "channel", "rate", "device", "absent"],
)
def test_unusable_input_ends_with_2_and_a_way_out(
    sets: dict[str, Any],
    change: Callable[[Any], Any],
    options: tuple[str, ...],
    parts: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    network = () if "--device" in options else ("--no-cnn",)
    monkeypatch.setattr("torch.cuda.is_available", lambda: False)
    offered = {"first": change(sets["first"]), "slower": replace(sets["second"], fs_hz=6400.0)}
    assert run(monkeypatch, offered, "first", "--out", str(tmp_path / "out"), *network, *options) == 2
    error = capsys.readouterr().err
    for part in ("siggen-diagnostics: ", *parts):
        assert part in error
    assert not (tmp_path / "out").exists()
