"""Predictions are judged as an independent count says, whatever their order and form, and refused in one list."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
import pytest

import diagnostics
from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.records.recording import LABEL_NAMES
from diagnostics.scoring.prediction_file import PredictedRecords, write_predictions
from diagnostics.scoring.score import Scored, ScoreRow
from diagnostics.scoring.tasks import truth_of
from diagnostics.statistics.evaluation import Predictions
from siggen.errors import UsageError

CLASSES = ("healthy", "slight", "severe")
SEVERITY = {"healthy": 0.0, "slight": 1.0, "severe": 2.0}


def labels_of(dataset: Any, split: str) -> dict[str, np.ndarray]:
    table = dataset.labels(split, ["record_id", "specimen_id", "state"])
    return {name: np.asarray(table.column(name).to_pylist()) for name in table.column_names}


@pytest.fixture
def damage(dataset: Any) -> dict[str, np.ndarray]:
    """A number that rises with damage, with errors, of every record of the set."""
    found = dataset.labels(columns=["record_id", "state"])
    severity = np.array([SEVERITY[state] for state in found.column("state").to_pylist()])
    noise = np.random.default_rng(0).normal(size=severity.size)
    return {"record_id": found.column("record_id").to_numpy(), "damage": severity + noise}


def row(found: Scored, measure: str, records: str, name: str = "yours") -> ScoreRow:
    (one,) = [row for row in found.rows if (row.measure, row.records, row.name) == (measure, records, name)]
    return one


def test_detection_is_the_share_of_pairs_of_different_gearboxes(dataset: Any, damage: dict[str, np.ndarray]) -> None:
    found, labels = diagnostics.score(dataset, damage), labels_of(dataset, "test")
    value = dict(zip(damage["record_id"].tolist(), damage["damage"].tolist(), strict=True))
    of_record = list(zip(*(labels[name].tolist() for name in ("record_id", "specimen_id", "state")), strict=True))
    won = [
        value[damaged] > value[healthy]
        for damaged, own, state in of_record
        for healthy, other, at_rest in of_record
        if state == "slight" and at_rest == "healthy" and own != other
    ]
    assert row(found, "AUC", "slight").score.value == pytest.approx(np.mean(won), abs=1e-12)
    assert row(found, "AUC", "slight").score.low < np.mean(won) < row(found, "AUC", "slight").score.high
    assert {entry.task for entry in found.rows} == {"detect"}
    assert (found.records, found.gearboxes) == (24, 8)


def test_neither_order_nor_form_nor_records_of_other_splits_change_a_score(
    dataset: Any, damage: dict[str, np.ndarray], tmp_path: Path
) -> None:
    expected = diagnostics.score(dataset, damage).rows
    order = np.random.default_rng(1).permutation(damage["record_id"].size)
    shuffled = pa.table({name: column[order] for name, column in damage.items()})
    pa.csv.write_csv(shuffled, tmp_path / "own.csv")
    pq.write_table(shuffled, tmp_path / "own.parquet")
    test = np.isin(damage["record_id"], labels_of(dataset, "test")["record_id"])
    forms = (shuffled, tmp_path / "own.csv", str(tmp_path / "own.parquet"), {k: v[test] for k, v in damage.items()})
    for form in forms:
        assert diagnostics.score(dataset, form).rows == expected


def test_names_of_classes_and_of_states_are_graded(dataset: Any) -> None:
    labels = labels_of(dataset, "test")
    wrong = np.where(labels["state"] == "slight", "healthy", labels["state"])
    found = diagnostics.score(dataset, {"record_id": labels["record_id"], "class": wrong})
    assert [(entry.task, entry.measure) for entry in found.rows] == [("grade", "balanced accuracy")]
    assert found.rows[0].score.value == pytest.approx(2 / 3)
    assert found.rows[0].chance == pytest.approx(1 / 3)


def test_every_problem_comes_in_one_list(dataset: Any, damage: dict[str, np.ndarray]) -> None:
    first = labels_of(dataset, "test")["record_id"][:6]
    record_id, number = damage["record_id"], damage["damage"].copy()
    number[record_id == first[0]] = np.nan
    kept = record_id != first[1]
    wrong = {"record_id": np.append(record_id[kept], [first[2], 9999]), "damage": np.append(number[kept], [0.0, 0.0])}
    size = wrong["record_id"].size
    wrong |= {"p_healthy": np.full(size, 0.9), "p_slight": np.full(size, 0.3), "p_severe": np.full(size, -1.0)}
    wrong["p_broken"], wrong["class"] = np.zeros(size), np.array(["torn"] * size)
    with pytest.raises(UsageError) as caught:
        diagnostics.score(dataset, wrong)
    said = str(caught.value)
    for part in (
        "8 problems",
        "1 record not in the set: record_id 9999",
        f"1 record missing: record_id {first[1]}",
        f"1 record there more than once: record_id {first[2]}",
        f"damage is nan in 1 record (record_id {first[0]}); allowed: finite numbers",
        "p_severe is -1 in 23 records",
        "column p_broken is of no class",
        "class is 'torn' in 23 records",
        "the sum of the probabilities is 0.2 in 23 records",
        "24 records of the split test",
        "Classes: healthy, slight, severe.",
    ):
        assert part in said, said


@pytest.mark.parametrize(
    ("columns", "part"),
    [
        ({"id": [1]}, "no column record_id; received id"),
        ({"record_id": [1.5]}, "record_id holds double"),
        ({"record_id": [1]}, "no columns of a task"),
        ({"record_id": [1], "p_slight": [1.0]}, "no column p_healthy, p_severe"),
        ({"record_id": [1], "damage": ["high"]}, "damage holds string; allowed: numbers"),
        ({"record_id": [1, 2], "damage": [0.0]}, "no readable table"),
    ],
)
def test_columns_that_cannot_be_used_are_named(dataset: Any, columns: dict[str, list[Any]], part: str) -> None:
    test = labels_of(dataset, "test")["record_id"]
    if columns.get("record_id") == [1]:
        columns = {name: test if name == "record_id" else values * test.size for name, values in columns.items()}
    with pytest.raises(UsageError, match=part):
        diagnostics.score(dataset, columns)


def written(dataset: Any, folder: Path, identity: str = "0" * 64) -> np.ndarray:
    """Write a training's predictions of two classifiers; return the probabilities of the first."""
    truth = truth_of(dataset, "test")
    own = np.random.default_rng(2).dirichlet(np.ones(3), size=truth.label.size) + 0.6 * np.eye(3)[truth.label]
    own /= own.sum(axis=1, keepdims=True)
    guess = np.full_like(own, 1.0 / 3.0)
    entries = [
        PredictedRecords(name, "test", truth.record_id, Predictions(CLASSES, truth.label, found, truth.specimen))
        for name, found in (("boosting", own), ("rms", guess))
    ]
    write_predictions(entries, identity, folder)
    return own


def test_differences_are_paired_with_the_classifiers_of_a_training(dataset: Any, tmp_path: Path) -> None:
    models = tmp_path / "report" / "models"
    models.mkdir(parents=True)
    probability = written(dataset, models)
    mine = {f"p_{name}": probability[:, k] for k, name in enumerate(CLASSES)}
    mine["record_id"] = labels_of(dataset, "test")["record_id"]
    for folder in (models, tmp_path / "report"):
        found = diagnostics.score(dataset, mine, baselines=folder)
        own, same, guess = (row(found, "AUC", "every damage", name) for name in ("yours", "boosting", "rms"))
        assert own.difference is None
        assert (same.score, same.difference.value, same.difference.high) == (own.score, 0.0, 0.0)
        assert guess.score.value == 0.5
        assert guess.difference.value == pytest.approx(own.score.value - 0.5)
        assert guess.difference.low < guess.difference.value < guess.difference.high
    alone = diagnostics.score(dataset, models / "predictions.parquet")
    assert row(alone, "macro AUROC", "all", "boosting").score == row(found, "macro AUROC", "all").score
    assert "gradient boosting on indicators" in str(found)
    assert found.to_table().num_rows == len(found.rows)


def test_predictions_of_another_set_are_refused(dataset: Any, damage: dict[str, np.ndarray], tmp_path: Path) -> None:
    written(dataset, tmp_path, "1" * 64)
    with pytest.raises(UsageError, match="predictions of the set 111111111111; this one is 000000000000"):
        diagnostics.score(dataset, damage, baselines=tmp_path)
    with pytest.raises(UsageError, match=r"has no predictions\.parquet"):
        diagnostics.score(dataset, damage, baselines=tmp_path / "nothing")
    with pytest.raises(UsageError, match="received the split 'holdout'; those with records are train"):
        diagnostics.score(dataset, damage, split="holdout")


def test_a_table_has_a_role_for_every_column(features: pa.Table) -> None:
    table = feature_matrix(features)
    assert set(LABEL_NAMES) <= set(table.labels)
    assert set(table.roles) == {*table.names, *table.labels}
    assert table.roles["rms__bearing_vertical"] == "measured"
    assert table.classes == CLASSES
    parts = [table.split(name) for name in ("train", "validation", "test")]
    assert sum(len(part.values) for part in parts) == len(table.values)
    assert not set(parts[0].groups) & set(parts[2].groups)


def test_importing_diagnostics_costs_nothing() -> None:
    heavy = ("numpy", "pyarrow", "scipy")
    code = f"import sys, diagnostics; print([m for m in {heavy} if m in sys.modules], diagnostics.score)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.startswith("[] <function score")
