"""A set with two healthy states: one class, judged as one, everywhere from training to the model's files."""

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

from diagnostics.base.progress import silent_stage
from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.judging.of_split import NetworkOptions, Training, train_models, training_metrics
from diagnostics.judging.sets import OtherSet, check_other_set, set_table
from diagnostics.loader.window_index import StreamSettings, window_index
from diagnostics.page.blocks import Page
from diagnostics.page.template import page_html
from diagnostics.prediction.model_facts import read_content
from diagnostics.prediction.saved_models import save_models
from diagnostics.report.classifier_tables import detection_blocks
from diagnostics.report.sentences import scores_sentence
from diagnostics.training.feature_classifier import state_index

SPLITS = ("train",) * 5 + ("validation",) * 2 + ("test",) * 3
WITHOUT = NetworkOptions(cnn=False)


def renamed(table: pa.Table, state: str, state_id: int) -> pa.Table:
    """The table with every record in one state."""
    count = table.num_rows
    for name, column in (("state", pa.array([state] * count)), ("state_id", pa.array([state_id] * count))):
        table = table.set_column(table.schema.get_field_index(name), name, column)
    return table


def healthy_twice(make_dataset: Callable[..., Any], splits: tuple[str, ...] = SPLITS, seed: int = 5) -> Any:
    """The small set with a second healthy record of every gearbox, under the state `healthy_again`."""
    first, second = make_dataset(splits, seed=seed), make_dataset(splits, seed=seed + 100)
    healthy = second.table.filter(pc.equal(second.table.column("state"), "healthy"))
    again = renamed(healthy, "healthy_again", 3)
    record_id = pa.array([1000 + number for number in again.column("record_id").to_pylist()])
    again = again.set_column(again.schema.get_field_index("record_id"), "record_id", record_id)
    return replace(first, table=pa.concat_tables([first.table, again.cast(first.table.schema)]))


@pytest.fixture(scope="module")
def twice(make_dataset: Callable[..., Any]) -> Any:
    return healthy_twice(make_dataset)


@pytest.fixture(scope="module")
def table_of_twice(twice: Any) -> pa.Table:
    return set_table(twice, silent_stage)


@pytest.fixture(scope="module")
def training(twice: Any, table_of_twice: pa.Table, make_dataset: Callable[..., Any]) -> Training:
    """Trained on the set, judged too on another one whose healthy state has another name."""
    other = make_dataset(("test",) * 4, seed=9)
    states = pc.replace_substring(other.table.column("state"), "healthy", "as_delivered")
    table = other.table.set_column(other.table.schema.get_field_index("state"), "state", states)
    other = replace(other, table=table, path=Path("other"), manifest={"identity": "2" * 64, "name": "other"})
    check_other_set(twice, other)
    second = OtherSet(other, set_table(other, silent_stage))
    return train_models(twice, table_of_twice, 0, network=WITHOUT, other=second)


def test_every_classifier_has_one_healthy_class(training: Training) -> None:
    for found in (*training.judged, *training.other):
        assert found.scores.classes == ("healthy", "slight", "severe")
        assert found.scores.confusion.shape == (3, 3)
    assert training.judged[0].scores.confusion.sum(axis=1).tolist() == [6, 3, 3]
    assert training.other[0].scores.confusion.sum(axis=1).tolist() == [4, 4, 4]


def test_guessing_and_balanced_accuracy_know_that_healthy_is_twice_as_frequent(training: Training) -> None:
    for found in training.judged:
        scores = found.scores
        assert not scores.balanced
        assert scores.guess == 0.5
        recall = np.diag(scores.confusion) / scores.confusion.sum(axis=1)
        assert scores.balanced_accuracy.value == pytest.approx(recall.mean())
        assert scores.balanced_accuracy.low <= scores.balanced_accuracy.value <= scores.balanced_accuracy.high
    assert training.other[0].scores.balanced
    assert training.other[0].scores.balanced_accuracy == training.other[0].scores.accuracy


def test_metrics_name_states_and_classes(training: Training) -> None:
    metrics = training_metrics(training)
    assert metrics["states"] == ["healthy", "healthy_again", "slight", "severe"]
    assert metrics["classes"] == {"healthy": ["healthy", "healthy_again"], "slight": ["slight"], "severe": ["severe"]}
    assert metrics["classifiers"]["indicators"]["chance_accuracy"] == 0.5
    assert metrics["classifiers"]["indicators"]["chance_balanced_accuracy"] == pytest.approx(1 / 3)
    detection = metrics["classifiers"]["indicators"]["detection"]
    assert set(detection["auroc_by_state"]) == {"slight", "severe"}
    assert detection["auroc_by_state"]["severe"]["value"] > 0.95  # the modulation of the severe state is plain
    assert metrics["rms_severe_auc"] is not None


def test_a_set_with_one_healthy_state_keeps_its_states_as_classes(features: pa.Table) -> None:
    matrix = feature_matrix(features)
    np.testing.assert_array_equal(matrix.labels["class"], matrix.labels["state"])
    names = ("healthy", "slight", "severe")
    np.testing.assert_array_equal(state_index(matrix, names), matrix.labels["state_id"])


def test_the_loader_gives_states_and_classes(twice: Any) -> None:
    labels = window_index(twice, "train", StreamSettings()).labels
    assert set(zip(labels["state_id"].tolist(), labels["class_id"].tolist(), strict=True)) == {
        *((0, 0), (3, 0)),
        *((1, 1), (2, 2)),
    }


def test_page_card_and_model_say_what_the_healthy_class_holds(
    twice: Any, table_of_twice: pa.Table, training: Training, tmp_path: Path
) -> None:
    page = scores_sentence(training) + page_html(Page("x", detection_blocks(training)))
    page = page.replace("\N{NO-BREAK SPACE}", " ").replace("<wbr>", "")
    for text in (
        "The class healthy holds the records of healthy, healthy_again",
        "There are 3 classes.",
        "Always naming the most frequent class gives an accuracy of 50 %",
        "Always naming the most frequent one gives 50",
        "has the largest gain in detection over RMS alone: ",
        "Damaged or not on the other set other",
    ):
        assert text in page
    save_models(training, table_of_twice, twice, tmp_path)
    card = (tmp_path / "model_card.md").read_text(encoding="utf-8")
    assert "classes: healthy, slight, severe (healthy: records of healthy, healthy_again)" in card
    assert "accuracy of 0.50 and a balanced accuracy of 0.33" in card
    assert read_content(tmp_path).facts.classes == ("healthy", "slight", "severe")
    named = json.loads((tmp_path / "feature_names.json").read_text(encoding="utf-8"))
    assert named["classes"] == ["healthy", "slight", "severe"]
