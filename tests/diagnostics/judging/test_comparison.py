"""Paired differences see what two overlapping intervals hide, and nothing where nothing differs."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.judging.judgement import comparison, state_auc
from diagnostics.statistics.evaluation import Predictions, scores

CLASSES = ("healthy", "severe")


def predictions(specimens: int, flips: np.ndarray) -> Predictions:
    """Two records per specimen, one per state; a flipped specimen is called wrong in both."""
    truth = np.tile([0, 1], specimens)
    right = np.where(np.repeat(flips, 2), 0.2, 0.8)
    probability = np.stack([np.where(truth == 0, right, 1 - right), np.where(truth == 0, 1 - right, right)], axis=1)
    return Predictions(CLASSES, truth, probability, np.repeat(np.arange(specimens), 2))


def test_a_classifier_does_not_differ_from_itself() -> None:
    found = predictions(20, np.arange(20) < 6)
    same = comparison(("a", "a"), found, found, seed=0)
    assert (same.macro_auroc.value, same.macro_auroc.low, same.macro_auroc.high) == (0.0, 0.0, 0.0)


def test_pairing_shows_a_difference_that_separate_intervals_hide() -> None:
    worse, better = predictions(40, np.arange(40) < 20), predictions(40, np.arange(40) < 12)
    apart = [scores(found, seed=0).accuracy for found in (better, worse)]
    assert apart[0].low < apart[1].high  # the intervals overlap
    paired = comparison(("better", "worse"), better, worse, seed=0).accuracy
    assert paired.value == pytest.approx(0.2)
    assert paired.low > 0.05
    swapped = comparison(("worse", "better"), worse, better, seed=0).accuracy
    assert (swapped.value, swapped.low, swapped.high) == pytest.approx((-paired.value, -paired.high, -paired.low))


def test_other_records_are_refused() -> None:
    with pytest.raises(ValueError, match="not of the same records"):
        comparison(("a", "b"), predictions(4, np.zeros(4, bool)), predictions(5, np.zeros(5, bool)), seed=0)


def test_the_auc_of_one_state_ignores_the_others() -> None:
    probability = np.array([[0.6, 0.3, 0.1], [0.6, 0.3, 0.1], [0.1, 0.8, 0.1], [0.3, 0.3, 0.4], [0.2, 0.1, 0.7]])
    found = Predictions(("healthy", "slight", "severe"), np.array([0, 0, 1, 2, 2]), probability, np.arange(5))
    assert state_auc(found, 0, 2, seed=0).value == 1.0


def test_pairs_are_drawn_by_specimen_so_that_copied_records_narrow_nothing() -> None:
    worse, better = predictions(40, np.arange(40) < 20), predictions(40, np.arange(40) < 12)
    copies = [
        Predictions(CLASSES, np.tile(p.truth, 5), np.tile(p.probability, (5, 1)), np.tile(p.specimen, 5))
        for p in (better, worse)
    ]
    once = comparison(("better", "worse"), better, worse, seed=0, healthy="healthy")
    five = comparison(("better", "worse"), *copies, seed=0, healthy="healthy")
    for name in ("accuracy", "macro_auroc", "detection"):
        first, second = getattr(once, name), getattr(five, name)
        assert (first.value, first.low, first.high) == pytest.approx((second.value, second.low, second.high)), name
        assert first.low > 0.0


def test_detection_is_compared_by_the_probability_of_healthy_alone() -> None:
    from sklearn.metrics import roc_auc_score

    rng = np.random.default_rng(2)
    truth, specimen = rng.integers(0, 3, 60), np.arange(60)  # no two records of a specimen: all pairs count
    first, second = (
        Predictions(("healthy", "a", "b"), truth, rng.dirichlet(np.ones(3), 60), specimen) for _ in range(2)
    )
    areas = [roc_auc_score(truth > 0, 1.0 - found.probability[:, 0]) for found in (first, second)]
    found = comparison(("x", "y"), first, second, seed=0, healthy="healthy").detection
    assert found is not None
    assert found.value == pytest.approx(areas[0] - areas[1])
