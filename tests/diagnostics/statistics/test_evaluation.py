"""Scores and their intervals against independent formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diagnostics.statistics.evaluation import (
    Predictions,
    bootstrap_weights,
    centred_ranks,
    interval,
    macro_auroc,
    scores,
    weighted_auc,
    weighted_midranks,
)
from diagnostics.statistics.indicator_statistics import rank_correlation

ONE = np.ones((1, 40))


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return rng.integers(0, 8, 40).astype(float), np.arange(40) % 3 == 0  # few values: many ties


@given(seed=st.integers(0, 10_000))
@settings(deadline=None)
def test_auc_counts_pairs_with_half_credit_for_ties(seed: int) -> None:
    values, positive = drawn(seed)
    pairs = values[positive][:, None] - values[~positive][None, :]
    assert weighted_auc(values, positive, ONE, np.arange(40))[0] == pytest.approx(
        np.mean((pairs > 0) + 0.5 * (pairs == 0))
    )


@given(seed=st.integers(0, 10_000))
@settings(deadline=None)
def test_weights_act_as_repeated_records(seed: int) -> None:
    values, positive = drawn(seed)
    weights = np.random.default_rng(seed + 1).integers(0, 4, (1, 40)).astype(float)
    repeat = weights[0].astype(int)
    owner = np.arange(40)
    repeated = weighted_auc(
        np.repeat(values, repeat), np.repeat(positive, repeat), np.ones((1, repeat.sum())), np.repeat(owner, repeat)
    )
    np.testing.assert_allclose(weighted_auc(values, positive, weights, owner), repeated)


@given(seed=st.integers(0, 10_000))
@settings(deadline=None)
def test_auc_leaves_pairs_of_one_specimen_out_in_every_resample(seed: int) -> None:
    values, positive = drawn(seed)
    specimen = np.arange(40) % 7
    weights = bootstrap_weights(specimen, seed, 3)
    won = (values[:, None] > values) + 0.5 * (values[:, None] == values)
    counted = positive[:, None] & ~positive & (specimen[:, None] != specimen)
    expected = [np.sum(won * counted * np.outer(w, w)) / np.sum(counted * np.outer(w, w)) for w in weights]
    np.testing.assert_allclose(weighted_auc(values, positive, weights, specimen), expected)


def test_a_side_of_one_specimen_has_no_auc() -> None:
    values, positive = np.array([1.0, 2.0, 3.0, 4.0]), np.array([False, False, True, True])
    for specimen, expected in (([0, 0, 0, 0], np.nan), ([0, 1, 2, 2], np.nan), ([0, 1, 0, 1], 1.0)):
        np.testing.assert_equal(weighted_auc(values, positive, np.ones((1, 4)), np.array(specimen))[0], expected)


def test_limits_of_the_auc_cover_where_gearboxes_differ_more_than_damage_does() -> None:
    # healthy and damaged record of each of 24 gearboxes, N(0, 1) between them, 0.2 of damage: the AUC over other
    # gearboxes is Phi(0.2/sqrt 2) = 0.556, though every damaged record lies above its own healthy one
    rng, covered, runs = np.random.default_rng(8), 0, 100
    specimen = np.repeat(np.arange(24), 2)
    positive = np.tile([False, True], 24)
    for run in range(runs):
        values = np.repeat(rng.standard_normal(24), 2) + 0.2 * positive + 0.02 * rng.standard_normal(48)
        found = interval(weighted_auc(values, positive, bootstrap_weights(specimen, run, 400), specimen), 24)
        covered += found.low <= 0.556 <= found.high
    # 95 of 100 if exact; binomial scatter of 2.2, and percentile limits of 24 are known to be narrow by a few per cent
    assert covered >= 85


def test_spearman_agrees_with_scipy() -> None:
    from scipy.stats import spearmanr

    first, _ = drawn(1)
    second, _ = drawn(2)
    ranks, others, none = (centred_ranks(values, ONE) for values in (first, second, np.zeros(40)))
    assert rank_correlation(ranks, others)[0] == pytest.approx(spearmanr(first, second).statistic)
    assert math.isnan(rank_correlation(ranks, none)[0])


def test_macro_auroc_agrees_with_scikit_learn() -> None:
    from sklearn.metrics import roc_auc_score

    rng = np.random.default_rng(4)
    probability = rng.dirichlet(np.ones(3), 40)
    truth = np.arange(40) % 3
    found = macro_auroc(Predictions(("a", "b", "c"), truth, probability, np.arange(40)), ONE)[0]
    assert found == pytest.approx(roc_auc_score(truth, probability, multi_class="ovr"))


def test_midranks_of_untied_values_are_ranks_less_a_half() -> None:
    np.testing.assert_allclose(weighted_midranks(np.array([3.0, 1.0, 2.0]), np.ones((1, 3))), [[2.5, 0.5, 1.5]])


def test_bootstrap_draws_specimens_whole() -> None:
    specimen = np.repeat([4, 7, 9], 5)
    weights = bootstrap_weights(specimen, seed=1, resamples=50)
    assert (weights[0] == 1).all()
    for number in (4, 7, 9):
        block = weights[:, specimen == number]
        assert (block == block[:, :1]).all()
    assert (weights.sum(axis=1) == 15).all()


def test_interval_over_specimens_is_wider_than_its_records_suggest() -> None:
    # 10 specimens with 20 records each that are all right or all wrong: the spread is that of 10 coins, not of 200
    specimen = np.repeat(np.arange(10), 20)
    right = np.repeat(np.arange(10) < 5, 20)
    probability = np.where(right[:, None], [0.9, 0.1], [0.1, 0.9])
    found = scores(Predictions(("a", "b"), np.zeros(200, dtype=int), probability, specimen), seed=3).accuracy
    assert found.value == 0.5
    # normal approximation +-1.96 sqrt(0.25/10) = 0.31; the bootstrap steps by 0.1
    assert found.low == pytest.approx(0.19, abs=0.1)
    assert found.high == pytest.approx(0.81, abs=0.1)


def test_confusion_has_the_true_state_in_rows() -> None:
    probability = np.array([[0.8, 0.2], [0.3, 0.7], [0.4, 0.6]])
    found = scores(Predictions(("a", "b"), np.array([0, 0, 1]), probability, np.arange(3)), seed=0)
    assert found.confusion.tolist() == [[1, 1], [0, 1]]


def test_one_specimen_has_no_interval() -> None:
    found = interval(np.array([0.7, 0.7, 0.7]), specimens=1)
    assert found.value == 0.7
    assert math.isnan(found.low)
    assert found.numbers() == {"value": 0.7, "low": None, "high": None}


def test_no_record_named_wrongly_leaves_the_exact_limit_of_so_many_specimens() -> None:
    specimen = np.repeat(np.arange(6), 2)
    truth = np.tile([0, 1], 6)
    found = scores(Predictions(("a", "b"), truth, np.eye(2)[truth], specimen), seed=0)
    for score in (found.accuracy, found.balanced_accuracy, found.macro_auroc):
        assert (score.value, score.high) == (1.0, 1.0)
        assert score.low == pytest.approx(0.025 ** (1 / 6))  # Clopper and Pearson: 6 of 6


@pytest.mark.parametrize("alike", [0.0, 0.3])
def test_limits_of_a_share_from_five_specimens_hold_as_often_as_they_say(alike: float) -> None:
    # four records a specimen; their chances of being right differ between specimens (beta-binomial)
    rng, specimen, truth = np.random.default_rng(1), np.repeat(np.arange(5), 4), np.zeros(20, dtype=int)
    inside = []
    for seed in range(200):
        mine = rng.beta(0.65 * (1 / alike - 1), 0.35 * (1 / alike - 1), 5) if alike else np.full(5, 0.65)
        right = rng.random(20) < mine[specimen]
        probability = np.where(right[:, None], [0.9, 0.1], [0.1, 0.9])
        found = scores(Predictions(("a", "b"), truth, probability, specimen), seed, 100).accuracy
        inside.append(found.low <= 0.65 <= found.high)
    # 0.95 within three standard deviations of 200; resampling alone gives 0.87 and 0.91
    assert np.mean(inside) >= 0.95 - 3.0 * (0.95 * 0.05 / 200) ** 0.5


def test_same_seed_same_interval() -> None:
    specimen = np.repeat(np.arange(6), 4)
    np.testing.assert_array_equal(bootstrap_weights(specimen, 5), bootstrap_weights(specimen, 5))
    assert (bootstrap_weights(specimen, 5) != bootstrap_weights(specimen, 6)).any()
