"""Splits hold out what they say, leakage raises the score, and more specimens help."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.record_classes import set_classes
from diagnostics.records.recording import recordings
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.statistics.scores import scores
from diagnostics.training.baselines import rms_features, train_classifier
from diagnostics.training.split_study import (
    by_channel,
    crossed,
    fold_scores,
    held_out,
    speed_bands,
    split_study,
    window_matrix,
    windows_of,
)
from diagnostics.training.splits import specimen_split
from diagnostics.training.studies import learning_curve

CLASSES = ("healthy", "worn")


def fingerprints(specimens: int = 30, per_pair: int = 1) -> FeatureMatrix:
    """Windows that show their gearbox plainly and its state not at all: six windows, each state on half the boxes.

    With several gearboxes per gear pair they show the pair.
    """
    rng = np.random.default_rng(0)
    specimen = np.repeat(np.arange(specimens), 6)
    pair = specimen // per_pair
    marks = rng.standard_normal((specimens, 40))[pair]
    state = np.where(pair % 2 == 0, *CLASSES)
    values = marks + 0.05 * rng.standard_normal(marks.shape)
    names = ("rms__a", "rms__b", *(f"f{k}__{c}" for k in range(19) for c in "ab"))
    labels = {
        "specimen_id": specimen,
        "record_id": np.repeat(np.arange(2 * specimens), 3),
        "state": state,
        "class": state,
        "teeth_pinion": 18 + (pair if per_pair > 1 else 0 * pair),
        "teeth_gear": np.full(specimen.size, 47),
        "speed_hz": rng.uniform(20.0, 35.0, size=2 * specimens).repeat(3),
    }
    return FeatureMatrix(values, names, labels)


def test_random_windows_reward_memory_and_unseen_specimens_do_not() -> None:
    found = {row.title: row.indicators.macro_auroc.value for row in split_study(fingerprints(), CLASSES, seed=0)}
    assert len(found) == 8
    assert found["random windows (leaky)"] > 0.95
    assert found["records"] > 0.95  # the other record of the same gearbox is as good
    # 30 specimens scatter by 0.1 round chance, three of which are allowed
    for title in ("specimens", "one speed band of other specimens", "single channel: one sensor of other specimens"):
        assert found[title] == pytest.approx(0.5, abs=0.3)
        assert found[title] < found["random windows (leaky)"] - 0.15


def test_other_gearboxes_of_the_same_pairs_reward_memory_of_the_pair_and_other_pairs_do_not() -> None:
    rows = split_study(fingerprints(60, per_pair=3), CLASSES, seed=0)
    found = {row.title: row.indicators.macro_auroc.value for row in rows}
    assert found["specimens"] > 0.9
    assert found["gear pairs"] == pytest.approx(0.5, abs=0.35)  # 20 pairs scatter by 0.12 round chance
    assert not next(row for row in rows if row.title == "gear pairs").leaky


def test_frequencies_that_differ_between_folds_do_not_push_a_blind_classifier_below_chance() -> None:
    # it states the frequency of the other fold, the same for every row: no ranking within a fold, a wrong one across
    truth = np.array([0] * 8 + [1] * 2 + [0] * 2 + [1] * 8)
    fold = np.repeat([0, 1], 10)
    worn = np.where(fold == 0, 0.8, 0.2)
    found = Predictions(CLASSES, truth, np.stack([1 - worn, worn], axis=1), np.arange(20))
    assert macro_auroc(found, np.ones((1, 20)))[0] < 0.3
    assert fold_scores(found, fold, seed=0).macro_auroc.value == 0.5


def test_the_other_set_is_tested_as_a_whole_and_never_trained_on() -> None:
    matrix = fingerprints()
    row = split_study(matrix, CLASSES, seed=0, other=matrix)[-1]
    assert (row.title, row.folds, row.indicators.records) == ("other set", 1, 180)
    assert row.indicators.specimens == 30
    assert row.indicators.macro_auroc.value > 0.95  # the same windows under other numbers


def test_folds_are_disjoint_and_cover_everything_once() -> None:
    first, second = np.array([0, 0, 1, 1, 2, 2]), np.array([0, 1, 0, 1, 0, 1])
    for folds in (held_out(first), crossed(first, second)):
        assert not any((train & test).any() for train, test in folds)
        assert np.sum([test for _, test in folds], axis=0).tolist() == [1] * 6
    for train, test in crossed(first, second):
        assert not set(first[train]) & set(first[test])
        assert not set(second[train]) & set(second[test])
    assert held_out(np.zeros(4)) == []


def test_speed_bands_are_thirds() -> None:
    assert np.bincount(speed_bands(np.linspace(20.0, 35.0, 30))).tolist() == [10, 10, 10]
    assert set(speed_bands(np.full(5, 30.0))) == {0}


def test_windows_are_eight_revolutions_with_pulses_of_their_own(dataset: Any) -> None:
    record = next(recordings(dataset))
    found = list(windows_of(record))
    assert len(found) == 3
    for window in found:
        assert window.tacho_s.size == 9
        assert 0.0 <= window.tacho_s[0] < 1.0 / record.fs_hz
        for signal in window.channels.values():
            assert signal.size == pytest.approx(8 / 30.0 * record.fs_hz, rel=0.03)


def test_rows_by_channel_keep_values_and_labels(make_dataset: Any) -> None:
    few = make_dataset(("train",))
    matrix = window_matrix(few, set_classes(few))
    single = by_channel(matrix)
    assert single.values.shape == (2 * matrix.values.shape[0], len(matrix.names) // 2)
    second = single.rows(single.labels["channel"] == "bearing_horizontal")
    np.testing.assert_array_equal(
        second.values[:, second.names.index("rms")],
        matrix.values[:, matrix.names.index("rms__bearing_horizontal")],
    )


@pytest.mark.slow  # a whole curve
def test_more_training_specimens_raise_the_score(features: pa.Table) -> None:
    matrix = feature_matrix(features)
    curve = learning_curve(matrix, specimen_split(matrix.labels), seed=0)
    assert [point.specimens for point in curve] == [1, 2, 3, 5, 8, 12]
    assert curve[0].indicators.mean() < curve[-1].indicators.mean()
    assert curve[-1].indicators[0] > 0.9


@pytest.mark.slow
def test_the_end_of_the_curve_is_the_score_of_the_classifiers(features: pa.Table) -> None:
    matrix = feature_matrix(features)
    whole = specimen_split(matrix.labels)
    split = replace(whole, train=whole.train & (matrix.labels["specimen_id"] < 2))
    last = learning_curve(matrix, split, seed=0)[-1]
    alone = matrix.columns(rms_features(matrix.names))
    for part, found in ((matrix, last.indicators), (alone, last.rms)):
        test = train_classifier(part, split).predict(part.rows(split.test))
        assert found.tolist() == [scores(test, seed=0, resamples=10).macro_auroc.value]
