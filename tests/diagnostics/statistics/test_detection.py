"""Damaged or not, by 1 - p(healthy): against scikit-learn, with intervals that follow specimens."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diagnostics.statistics.detection import detection, detection_metrics
from diagnostics.statistics.evaluation import Predictions, balanced_accuracy

CLASSES = ("slight", "healthy", "severe")


def predictions(records_per_state: int = 1, specimens: int = 40, seed: int = 3) -> Predictions:
    """Specimens with as many records of every state; severe damage shows, slight damage does not."""
    rng = np.random.default_rng(seed)
    truth = np.tile(np.repeat([0, 1, 2], records_per_state), specimens)
    specimen = np.repeat(np.arange(specimens), 3 * records_per_state)
    # of one specimen every record of a state is alike, so that more records of it say nothing new
    draw = np.repeat(rng.standard_normal((specimens, 3)).ravel(), records_per_state)
    healthy = 1.0 / (1.0 + np.exp(draw + np.where(truth == 2, 2.0, 0.0)))
    rest = rng.uniform(size=truth.size) * (1.0 - healthy)
    return Predictions(CLASSES, truth, np.stack([rest, healthy, 1.0 - healthy - rest], axis=1), specimen)


def test_areas_are_those_of_scikit_learn() -> None:
    from sklearn.metrics import roc_auc_score

    one_each = replace(predictions(), specimen=np.arange(120))  # no two records of a specimen: all pairs count
    assert predictions().truth.size == 120
    found, judged = one_each, detection(one_each, "healthy", seed=0, resamples=50)
    assert judged is not None
    score = 1.0 - found.probability[:, 1]
    assert judged.every.value == pytest.approx(roc_auc_score(found.truth != 1, score))
    assert list(judged.by_class) == ["slight", "severe"]
    for name, state in (("slight", 0), ("severe", 2)):
        rows = np.isin(found.truth, (1, state))
        assert judged.by_class[name].value == pytest.approx(roc_auc_score(found.truth[rows] == state, score[rows]))
    # normal scores two deviations apart: Phi(2 / sqrt 2) = 0.92; of 40 specimens the standard error is 0.03
    assert judged.by_class["severe"].value == pytest.approx(0.92, abs=0.09)
    assert judged.by_class["slight"].low < 0.5 < judged.by_class["slight"].high


def test_more_records_of_the_same_specimens_make_no_interval_narrower() -> None:
    one, five = (detection(predictions(count), "healthy", seed=0) for count in (1, 5))
    assert one is not None
    assert five is not None
    # the five records of a specimen and state are copies, and the resamples are the same ones
    assert (five.every.low, five.every.high) == pytest.approx((one.every.low, one.every.high))


def test_states_without_records_are_left_out_and_one_side_alone_is_not_judged() -> None:
    found = predictions()
    rows = found.truth != 2
    part = Predictions(CLASSES, found.truth[rows], found.probability[rows], found.specimen[rows])
    judged = detection(part, "healthy", seed=0, resamples=20)
    assert judged is not None
    assert list(judged.by_class) == ["slight"]
    rows = found.truth == 1
    part = Predictions(CLASSES, found.truth[rows], found.probability[rows], found.specimen[rows])
    assert detection(part, "healthy", seed=0, resamples=20) is None
    assert detection_metrics(None) is None


def test_balanced_accuracy_is_the_mean_recall_of_scikit_learn() -> None:
    from sklearn.metrics import balanced_accuracy_score

    rng = np.random.default_rng(1)
    truth = rng.choice(3, size=90, p=[0.6, 0.3, 0.1])
    found = Predictions(CLASSES, truth, rng.dirichlet(np.ones(3), 90), np.arange(90))
    weights = np.stack([np.ones(90), rng.integers(0, 4, 90).astype(float), (truth != 2).astype(float)])
    got = balanced_accuracy(found, weights)
    for row, value in zip(weights[:2], got[:2], strict=True):
        assert value == pytest.approx(balanced_accuracy_score(truth, found.predicted, sample_weight=row))
    kept = truth != 2  # a class that a resample lacks does not count
    recall = [(found.predicted[truth == k] == k).mean() for k in (0, 1)]
    assert kept.any()
    assert got[2] == pytest.approx(np.mean(recall))


def test_naming_the_most_frequent_class_alone_is_worth_no_more_than_chance_when_balanced() -> None:
    truth = np.array([1] * 8 + [0] * 2 + [2] * 2)
    probability = np.tile([0.1, 0.8, 0.1], (12, 1))
    found = Predictions(CLASSES, truth, probability, np.arange(12))
    assert balanced_accuracy(found, np.ones((1, 12)))[0] == pytest.approx(1 / 3)
