"""What a model covers: the operating points that it saw, not those of the records that it is judged on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.prediction.model_facts import model_facts
from diagnostics.prediction.saved_models import model_card, release
from diagnostics.training.splits import specimen_split


def with_column(table: pa.Table, name: str, values: np.ndarray) -> pa.Table:
    return table.set_column(table.schema.get_field_index(name), name, pa.array(values))


@pytest.mark.parametrize(
    ("name", "ends", "covered"),
    [
        ("speed_hz", (20.0, 30.0, 50.0), lambda facts: facts.speed_range_hz),
        ("torque_nm", (20.0, 30.0, 90.0), lambda facts: facts.torque_range_nm),
    ],
)
def test_test_records_widen_no_range_and_validation_records_do(
    name: str, ends: tuple[float, float, float], covered: Any, dataset: Any, features: pa.Table
) -> None:
    split = np.asarray(features.column("split").to_pylist())
    values = np.select([split == "train", split == "validation"], ends[:2], ends[2])
    facts = model_facts(dataset, with_column(features, name, values), specimen_split(feature_matrix(features).labels))
    assert covered(facts) == ends[:2]


def test_test_records_bring_no_teeth_and_no_shorter_averages(dataset: Any, features: pa.Table) -> None:
    judged = np.asarray(features.column("split").to_pylist()) == "test"
    table = with_column(features, "teeth_gear", np.where(judged, 50, 47))
    table = with_column(table, "revolutions_pinion", np.where(judged, 5, 28))
    facts = model_facts(dataset, table, specimen_split(feature_matrix(features).labels))
    assert facts.teeth == ((18, 47),)
    assert facts.fewest_revolutions == 28


def test_the_card_says_whose_ranges_they_are(dataset: Any, features: pa.Table, training: Any) -> None:
    found = release(training, features, dataset)
    found = replace(found, facts=replace(found.facts, speed_range_hz=(20.0, 30.0)))
    card = model_card(training, found, dataset)
    assert "20 to 30 Hz speed of the first shaft, 60 to 60 N m in training and validation. Outside these" in card
