"""Healthy references: which records of a set serve, and what `predict --reference` makes of files."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from scipy.signal import resample_poly

from diagnostics.base.progress import silent_stage
from diagnostics.cli.app import main
from diagnostics.indicators.classifier_table import classifier_table, feature_matrix
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.judging import of_split
from diagnostics.judging.of_split import (
    NetworkOptions,
    Training,
    judge_network,
    network_votes,
    referenced_classifiers,
    train_models,
    training_metrics,
)
from diagnostics.prediction.saved_models import save_models
from diagnostics.report.classifier_tables import score_blocks
from diagnostics.training import cnn
from diagnostics.training.average_rows import averaged_records
from diagnostics.training.referenced import healthy_references
from tests.diagnostics.conftest import SPLITS_24
from tests.rig_file import rig_file

FS_HZ = 12_800


def labels(*rows: tuple[str, int, int]) -> dict[str, np.ndarray]:
    """Return the labels of one specimen from (state, operating point, repeat)."""
    states, points, repeats = zip(*rows, strict=True)
    return {
        "record_id": np.arange(len(rows)), "specimen_id": np.zeros(len(rows), dtype=int),
        "state": np.array(states), "state_id": np.array([("healthy", "again", "severe").index(s) for s in states]),
        "fault": np.array(["pitting" if s == "severe" else "healthy" for s in states]),
        "operating_point_id": np.array(points), "repeat": np.array(repeats), "speed_hz": 30.0 + np.array(points),
    }  # fmt: skip


@pytest.mark.parametrize(
    "rows",
    [
        (("healthy", 0, 0), ("again", 0, 0), ("severe", 0, 0)),  # another state
        (("healthy", 0, 0), ("healthy", 0, 1), ("severe", 0, 0), ("severe", 0, 1)),  # another repeat
        (("healthy", 0, 0), ("healthy", 1, 0), ("severe", 0, 0), ("severe", 1, 0)),  # another operating point
        (("healthy", 0, 0), ("again", 0, 0), ("healthy", 1, 0), ("again", 1, 0), ("severe", 0, 0), ("severe", 1, 0)),
    ],
)
def test_damaged_records_have_as_many_and_as_near_references_as_healthy_ones(rows: Any) -> None:
    found = healthy_references(labels(*rows))
    places = {"healthy": set(), "severe": set()}  # type: dict[str, set[tuple[tuple[bool, bool], ...]]]
    for own, others in zip(rows, found, strict=True):
        near = tuple(sorted((rows[k][1] == own[1], rows[k][2] == own[2]) for k in others))
        places["severe" if own[0] == "severe" else "healthy"].add(near)
        assert all(rows[k][0] != "severe" for k in others)
        assert rows.index(own) not in others
    assert places["severe"] == places["healthy"]
    assert all(found[k].size for k in range(len(rows)))


def test_a_damaged_record_without_a_healthy_twin_refers_to_nothing() -> None:
    found = healthy_references(labels(("healthy", 0, 0), ("again", 0, 0), ("severe", 1, 0)))
    assert [rows.tolist() for rows in found] == [[1], [0], []]


@pytest.fixture(scope="module")
def again(make_dataset: Callable[..., Any]) -> Any:
    """The gearboxes of the separable set, measured a second time."""
    found = make_dataset(SPLITS_24, seed=6)
    for name, value in {"repeat": np.ones(72, dtype=int), "record_id": np.arange(72) + 72}.items():
        found.table = found.table.set_column(found.table.schema.get_field_index(name), name, pa.array(value))
    return found


@pytest.fixture(scope="module")
def twice(dataset: Any, again: Any) -> Any:
    """24 specimens measured twice; the second repeat follows the first one."""
    return replace(dataset, table=pa.concat_tables([dataset.table, again.table]))


@pytest.fixture(scope="module")
def indicators_of_both(measured: RecordTable, again: Any) -> RecordTable:
    return replace(measured, source=pa.concat_tables([measured.source, record_table(again).source]))


@pytest.fixture(scope="module")
def features_of_both(indicators_of_both: RecordTable) -> pa.Table:
    return classifier_table(indicators_of_both)


@pytest.fixture(scope="module")
def training(twice: Any, features_of_both: pa.Table) -> Training:
    return train_models(twice, features_of_both, 0, network=NetworkOptions(cnn=False))


@pytest.fixture(scope="module")
def trained(
    twice: Any, features_of_both: pa.Table, training: Training, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, Path]:
    """Return the folder of the models and a Parquet file with records of another seed: rows 0 to 2 are one gearbox."""
    folder = tmp_path_factory.mktemp("referenced")
    save_models(training, features_of_both, twice, folder)
    return folder, folder / "other.parquet"


@pytest.fixture(scope="module")
def other(trained: tuple[Path, Path], make_dataset: Callable[..., Any]) -> Any:
    """Return two gearboxes that nobody trained on, three states each, written as one record per row."""
    found = make_dataset(("test",) * 2, seed=11)
    parquet.write_table(found.table.replace_schema_metadata({"siggen.identity": "0"}), trained[1])
    return found


def predict(
    monkeypatch: pytest.MonkeyPatch, folder: Path, file: Path | str, out: Path, *more: str
) -> tuple[int, dict[str, Any]]:
    arguments = (
        "--fs",
        str(FS_HZ),
        "--teeth",
        "18,47",
        *rig_file(out if out.is_dir() else out.parent, unit="m/s2", tacho="tacho_s"),
        "--out",
        str(out),
        *more,
    )
    monkeypatch.setattr(sys, "argv", ["siggen-diagnostics", "predict", str(folder), str(file), *arguments])
    with pytest.raises(SystemExit) as stop:
        main()
    page = out / "prediction.json"
    return int(stop.value.code or 0), json.loads(page.read_text()) if page.is_file() else {}


def pulses(dataset: Any, record: int) -> np.ndarray:
    return np.asarray(dataset.record(record)["tacho_s"])


def channels(dataset: Any, row: int, ratio: tuple[int, int] = (1, 1)) -> dict[str, np.ndarray]:
    names = ("bearing_vertical", "bearing_horizontal")
    return {name: resample_poly(dataset.record(row)[f"accel_{name}_m_s2"], *ratio) for name in names}


def test_a_model_of_a_set_with_repeats_answers_by_differences_to_a_reference(
    trained: tuple[Path, Path], other: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    assert other.table.num_rows == 6
    folder, file = trained
    code, found = predict(monkeypatch, folder, f"{file}:2", tmp_path, "--reference", f"{file}:0,3")
    assert code == 0
    assert found["state"] == "severe"
    assert list(found["probabilities"]) == ["healthy_referenced"]
    assert found["distance"] != found["distance_without_reference"]
    assert "by healthy_referenced: healthy " in capsys.readouterr().out  # a long label stands apart from its text


@pytest.mark.usefixtures("other")
def test_several_recordings_are_answered_each_in_its_first_line_and_folder(
    trained: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder, file), out = trained, tmp_path / "out"
    (broken := tmp_path / "broken.npz").write_bytes(b"no archive")
    code, _ = predict(monkeypatch, folder, f"{file}:2,3", out, str(broken), "--reference", f"{file}:0")
    assert code == 2  # of one that cannot be read
    said = [line for line in capsys.readouterr().out.splitlines() if line.startswith((file.name, broken.name))]
    assert all(word in line for word, line in zip(("severe", "healthy", "cannot tell"), said, strict=True))
    assert {path.name for path in out.iterdir()} == {f"{file.name}_2", f"{file.name}_3"}


def test_a_reference_is_judged_against_none_on_the_records_that_have_one(training: Training) -> None:
    assert training.referenced is not None
    found = training_metrics(training)["beside_a_healthy_record"]
    assert list(found["classifiers"]) == ["indicators", "healthy_referenced"]
    # 8 test gearboxes, 3 states, 2 repeats: a damaged record without its twin still has the other repeat's
    assert {own["test_records"] for own in found["classifiers"].values()} == {48}
    (pair,) = found["comparisons"]
    assert (pair["first"], pair["second"]) == ("healthy_referenced", "indicators")
    areas = [own["macro_auroc"]["value"] for own in found["classifiers"].values()]
    assert pair["macro_auroc"]["value"] == pytest.approx(areas[1] - areas[0])
    tables = score_blocks(training)
    assert any("logistic regression beside a healthy record − logistic regression" in str(one) for one in tables)


@pytest.mark.slow  # trains four networks
def test_the_network_is_judged_alone_and_beside_a_healthy_record(
    indicators_of_both: RecordTable, features_of_both: pa.Table, training: Training,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    few = partial(cnn.NetworkSettings, most_epochs=12)
    monkeypatch.setattr(cnn, "NetworkSettings", few)
    monkeypatch.setattr(of_split, "PERMUTED_EPOCHS", 2)
    averages, options = averaged_records(indicators_of_both), NetworkOptions()
    matrix, split = feature_matrix(features_of_both), training.split
    trained, alone = judge_network("network", averages, matrix, split, 0, options, silent_stage)
    found = referenced_classifiers(matrix, split, [*training.judged, alone], averages, 0, options, silent_stage)
    assert found is not None
    by_name = {judged.name: judged for judged in found.judged}
    assert list(by_name) == ["indicators", "network", "healthy_referenced", "network_referenced"]
    # a dip of 15 and 50 % once per revolution; beside a record without it nothing else is left
    assert by_name["network"].scores.macro_auroc.value > 0.7
    assert by_name["network_referenced"].scores.macro_auroc.value > 0.8
    assert [(pair.first, pair.second) for pair in found.comparisons] == [
        ("healthy_referenced", "indicators"),
        ("network_referenced", "network"),
        ("network_referenced", "healthy_referenced"),
    ]
    assert alone.permuted_auroc.shape == (1,)
    every = network_votes(trained, averages, matrix, np.ones(len(matrix.values), dtype=bool))
    np.testing.assert_array_equal(every.truth[split.test], alone.predictions.truth)


def test_references_at_another_rate_are_brought_to_that_of_the_model(
    trained: tuple[Path, Path], other: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, file = trained
    np.savez(tmp_path / "fast.npz", **channels(other, 0, (2, 1)), tacho_s=pulses(other, 0), fs=2 * FS_HZ)
    reference = ("--reference", str(tmp_path / "fast.npz"))
    code, found = predict(monkeypatch, folder, f"{file}:2", tmp_path, *reference)
    assert code == 0
    assert found["state"] == "severe"
    slow_range = ("--reference", f"{file}:0")
    same = predict(monkeypatch, folder, f"{file}:2", tmp_path, *slow_range)[1]
    # the way up and down again costs what the two filters leave out near half the rate
    near = found["probabilities"]["healthy_referenced"]["severe"]
    assert near == pytest.approx(same["probabilities"]["healthy_referenced"]["severe"], abs=0.05)


def test_a_reference_sampled_too_slowly_or_at_another_speed_forbids_an_answer(
    trained: tuple[Path, Path], other: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, file = trained
    np.savez(tmp_path / "slow.npz", **channels(other, 0, (3, 4)), tacho_s=pulses(other, 0), fs=FS_HZ * 3 // 4)
    reference = ("--reference", str(tmp_path / "slow.npz"))
    found = predict(monkeypatch, folder, f"{file}:2", tmp_path, *reference)[1]
    assert found["state"] == "abstains"
    assert any(
        text.startswith("reference slow.npz: the sampling rate is 9600 Hz") for text in found["reasons_to_abstain"]
    )
    # read at the old rate: 6/5 of the speed
    np.savez(tmp_path / "hurried.npz", **channels(other, 0, (5, 6)), tacho_s=5.0 / 6.0 * pulses(other, 0))
    found = predict(monkeypatch, folder, f"{file}:2", tmp_path, "--reference", str(tmp_path / "hurried.npz"))[1]
    assert found["state"] == "abstains"
    assert any("reference hurried.npz: the pinion speed is 36" in text for text in found["reasons_to_abstain"])


def test_the_recording_is_no_reference_to_itself(
    trained: tuple[Path, Path], other: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    folder, file = trained
    np.savez(
        tmp_path / "copy.npz", **channels(other, 2), tacho_s=pulses(other, 2)
    )  # the same samples under another name and format
    for said in (f"{file}:0,2", str(tmp_path / "copy.npz")):
        assert predict(monkeypatch, folder, f"{file}:2", tmp_path / "out", "--reference", said)[0] == 2
        message = " ".join(capsys.readouterr().err.split())
        assert "has the same samples as the recording" in message
        assert "Give another recording of the same machine in healthy state" in message
        assert not (tmp_path / "out").exists()


def test_a_reference_that_cannot_be_read_is_named_with_the_way_out(
    trained: tuple[Path, Path], other: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    assert other.table.num_rows == 6
    folder, file = trained
    for said, message in ((file, "other.parquet:ROW"), (f"{file}:6", "from 0 to 5"), ("gone.csv", "gone.csv")):
        assert predict(monkeypatch, folder, f"{file}:2", tmp_path, "--reference", str(said))[0] == 2
        assert message in "".join(capsys.readouterr().err.split("\n")).replace("  ", " ")


def test_the_change_comes_first_and_no_state_is_named_against_it(
    trained: tuple[Path, Path], make_dataset: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One gearbox measured healthy nine times, in files that siggen did not write: eight serve as references."""
    folder, _ = trained
    again = [make_dataset(("test",) * 2, seed=40 + k) for k in range(9)]
    for k, found in enumerate(again):
        np.savez(tmp_path / f"healthy_{k}.npz", **channels(found, 0), tacho_s=pulses(found, 0))
    np.savez(tmp_path / "severe.npz", **channels(again[0], 2), tacho_s=pulses(again[0], 2))
    references = [text for k in range(1, 9) for text in ("--reference", str(tmp_path / f"healthy_{k}.npz"))]
    severe = predict(monkeypatch, folder, tmp_path / "severe.npz", tmp_path / "a", *references)[1]
    healthy = predict(monkeypatch, folder, tmp_path / "healthy_0.npz", tmp_path / "b", *references)[1]
    assert severe["against_own_healthy_state"]["verdict"] == "changed"
    assert healthy["against_own_healthy_state"]["verdict"] == "unchanged"
    assert severe["state"] in {"severe", "slight", "abstains"}
    assert healthy["state"] in {"healthy", "abstains"}
