"""Primary faults as classes, from training to a saved model: what reads the model follows it without being told."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest
from pyarrow import parquet

import diagnostics
from diagnostics.base.progress import silent_stage
from diagnostics.explore.set_page import predicted_labels
from diagnostics.indicators.classifier_table import classifier_table
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.judging.of_split import NetworkOptions, train_models, training_metrics
from diagnostics.judging.sets import OtherSet, check_other_set, set_table
from diagnostics.loader.window_index import StreamSettings, window_index
from diagnostics.prediction.released_model import load_model
from diagnostics.prediction.saved_models import save_models
from diagnostics.records.record_classes import FAULT
from siggen.errors import UsageError
from tests.command import command
from tests.rig_file import rig_file

SPLITS = ("train",) * 5 + ("validation",) * 2 + ("test",) * 3
OPTIONS = NetworkOptions(cnn=False, classes=FAULT)


def combined(dataset: Any) -> Any:
    """The set with a slight pitting, and severe damage of two kinds at once, the first of which is pitting."""
    state = dataset.table.column("state")
    words = {"healthy": "healthy", "slight": "pitting", "severe": "combined"}
    fault = pa.array([words[name] for name in state.to_pylist()])
    table = dataset.table.set_column(dataset.table.schema.get_field_index("fault"), "fault", fault)
    primary = pc.if_else(pc.equal(fault, "combined"), "pitting", fault)
    return replace(dataset, table=table.append_column("primary_fault", primary))


@pytest.fixture(scope="module")
def kinds(make_dataset: Callable[..., Any]) -> Any:
    return combined(make_dataset(SPLITS))


@pytest.fixture(scope="module")
def measured_kinds(kinds: Any) -> RecordTable:
    return record_table(kinds)


@pytest.fixture(scope="module")
def model(
    kinds: Any,
    measured_kinds: RecordTable,
    make_dataset: Callable[..., Any],
    tmp_path_factory: pytest.TempPathFactory,
) -> Path:
    """Trained on faults, judged too on a set whose states are called otherwise."""
    other = combined(make_dataset(("test",) * 3, seed=9))
    names = pc.replace_substring(other.table.column("state"), "s", "z")
    table = other.table.set_column(other.table.schema.get_field_index("state"), "state", names)
    other = replace(other, table=table, path=Path("other"), manifest={"identity": "2" * 64, "name": "other"})
    with pytest.raises(UsageError, match=r"has the states zevere, zlight, .* Name its states like those"):
        check_other_set(kinds, other)
    check_other_set(kinds, other, FAULT)
    second, features = OtherSet(other, set_table(other, silent_stage)), classifier_table(measured_kinds)
    training = train_models(kinds, features, 0, network=OPTIONS, other=second)
    folder = tmp_path_factory.mktemp("faults")
    save_models(training, features, kinds, folder)
    metrics = training_metrics(training)
    assert metrics["classes_are"] == "fault"
    assert metrics["classes"] == {"healthy": ["healthy"], "pitting": ["slight", "severe"]}
    assert [found.scores.confusion.sum(axis=1).tolist() for found in training.other] == [[3, 6]] * len(training.other)
    return folder


def test_another_fault_of_another_set_is_refused_by_that_word(kinds: Any) -> None:
    fault = pc.replace_substring(kinds.table.column("primary_fault"), "pitting", "crack")
    place = kinds.table.schema.get_field_index("primary_fault")
    other = replace(kinds, table=kinds.table.set_column(place, "primary_fault", fault), manifest={"identity": "3" * 64})
    with pytest.raises(
        UsageError, match=r"has the faults crack, .* allowed are healthy, pitting and others .*\. Name its faults"
    ):
        check_other_set(kinds, other, FAULT)


def test_predict_names_a_fault_and_says_so(
    kinds: Any, model: Path, make_dataset: Callable[..., Any], tmp_path: Path
) -> None:
    table = combined(make_dataset(("test",) * 2, seed=8)).table.slice(2, 1)
    assert table.column("state").to_pylist() == ["severe"]
    parquet.write_table(table.replace_schema_metadata({"siggen.identity": "0"}), tmp_path / "run.parquet")
    given = (
        "--fs",
        "12800",
        "--teeth",
        "18,47",
        "--speed",
        "20,50",
        *rig_file(tmp_path, unit="m/s2"),
        "--out",
        str(tmp_path / "out"),
    )
    done = command("diagnostics", "predict", str(model), str(tmp_path / "run.parquet"), *given)
    assert done.returncode == 0, done.stderr
    assert "answer (fault):       pitting" in done.stdout
    found = json.loads((tmp_path / "out/prediction.json").read_text(encoding="utf-8"))
    assert found["fault"] == "pitting"
    assert "state" not in found
    assert found["model"]["classes_are"] == "fault"
    assert {"healthy", "pitting"} < set(found["probabilities"]["indicators"])
    assert "Most like the fault pitting" in (tmp_path / "out/prediction.html").read_text(encoding="utf-8")


def test_the_explorer_takes_faults_from_the_model(kinds: Any, measured_kinds: RecordTable, model: Path) -> None:
    labels = predicted_labels(measured_kinds, kinds, load_model(model))
    states = measured_kinds.labels()["state"]
    assert dict(zip(states.tolist(), labels["class"].tolist(), strict=True)) == {
        "healthy": "healthy",
        "slight": "pitting",
        "severe": "pitting",
    }
    assert set(labels["predicted"].tolist()) <= {"healthy", "pitting"}
    assert (labels["named"] == "rightly").mean() > 0.8  # half of the records are severe or healthy, plain to see


def test_scores_and_tables_and_loaders_agree_on_the_classes(kinds: Any, model: Path) -> None:
    file = model / "predictions.parquet"
    with pytest.raises(UsageError, match=r"its classes are faults; asked for were states\. Judge them by those"):
        diagnostics.score(kinds, file, classes="state")
    scored = diagnostics.score(kinds, file)
    assert "classes are faults" in str(scored)
    assert {row.records for row in scored.rows} == {"every damage", "all", "damaged"}
    matrix = diagnostics.table(kinds, classes="fault")
    assert matrix.classes == load_model(model).facts.classes == ("healthy", "pitting")
    index = window_index(kinds, "train", StreamSettings(classes="fault"))
    np.testing.assert_array_equal(index.labels["class_id"], (index.labels["state_id"] > 0).astype(np.int64))


def test_a_class_of_another_kind_is_refused_before_anything_is_read() -> None:
    done = command("diagnostics", "report", "nowhere", "--classes", "severity")
    assert done.returncode != 0
    assert "--classes: received 'severity'; allowed are state, fault" in done.stderr
    assert "Traceback" not in done.stderr
