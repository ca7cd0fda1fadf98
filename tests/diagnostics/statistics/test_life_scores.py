"""Scores of remaining life on tables whose scores are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.statistics.life_scores import life_bins, life_scores, nasa, pinball, unit_folds
from diagnostics.training.lives import remaining_of_age, weibull_lives

LIFE_H = 60.0


def uniform(count: int = 600) -> tuple[np.ndarray, np.ndarray]:
    """Return remaining lives spread evenly over 0 to 60 h, and their gearboxes."""
    return (np.arange(count) + 0.5) * LIFE_H / count, np.arange(count) % 20


def test_a_constant_has_the_errors_of_the_spread_of_lives() -> None:
    truth_h, units = uniform()
    scores = life_scores(truth_h, np.tile([6.0, 30.0, 54.0], (truth_h.size, 1)), units, LIFE_H, 1)
    # 600 steps in place of an even spread: relative error 1/600^2
    assert scores.rmse_h[0].value == pytest.approx(LIFE_H / np.sqrt(12.0), rel=1e-5)
    assert scores.mae_h[0].value == pytest.approx(LIFE_H / 4.0, rel=1e-12)
    # thirds of the life: even over 20 h, its middle 20, 0 and 20 h from the constant
    assert [one.value for one in scores.mae_h[1:]] == pytest.approx([20.0, 5.0, 20.0], rel=1e-12)
    assert scores.rmse_h[1].value == pytest.approx(np.sqrt(20.0**2 + 20.0**2 / 12.0), rel=1e-5)
    assert scores.coverage.value == pytest.approx(0.8, abs=1e-12)
    # the true quantile q of an even spread over L: q (1 - q) L / 2
    assert scores.pinball_h == pytest.approx([0.09 * 30.0, 0.25 * 30.0, 0.09 * 30.0], rel=1e-4)
    assert scores.rmse_h[0].low < scores.rmse_h[0].value < scores.rmse_h[0].high


def test_gearboxes_that_were_taken_out_count_in_no_score() -> None:
    truth_h, units = uniform(60)
    predicted = np.tile([6.0, 30.0, 54.0], (60, 1))
    more = np.concatenate([truth_h, np.full(9, np.nan)]), np.concatenate([predicted, np.full((9, 3), 1e6)])
    with_taken_out = life_scores(*more, np.concatenate([units, np.full(9, 99)]), LIFE_H, 1)
    assert with_taken_out == life_scores(truth_h, predicted, units, LIFE_H, 1)


def test_pinball_loss_weighs_both_sides_by_the_quantile() -> None:
    loss = pinball(np.array([10.0, 10.0]), np.array([4.0, 14.0]), 0.9)
    assert loss == pytest.approx([0.9 * 6.0, 0.1 * 4.0])


def test_nasa_score_counts_in_median_lives_of_200_and_at_most_60_of_them() -> None:
    late, early, capped = nasa(np.array([3.0, -3.9, 1e4]), LIFE_H)  # 10 and -13 units
    assert (late, early) == pytest.approx((np.e - 1.0, np.e - 1.0))
    assert capped == pytest.approx(np.exp(6.0) - 1.0)


def test_bins_hold_each_inspection_once_and_the_last_has_no_end() -> None:
    masks = life_bins(np.array([0.0, 19.9, 20.0, 40.0, 500.0]), LIFE_H)
    assert [mask.tolist() for mask in masks] == [
        [True, True, False, False, False],
        [False, False, True, False, False],
        [False, False, False, True, True],
    ]


def test_no_gearbox_is_predicted_by_itself() -> None:
    units = np.repeat(np.arange(13), 4)
    folds = unit_folds(units, np.random.default_rng(1), 5)
    assert sum(fold.astype(int) for fold in folds).tolist() == [1] * units.size
    assert not any(set(units[fold]) & set(units[~fold]) for fold in folds)


def test_remaining_life_without_ageing_does_not_depend_on_age() -> None:
    quantiles_h = remaining_of_age(np.array([0.0, 70.0]), 1.0, 50.0)
    expected = -50.0 * np.log([0.9, 0.5, 0.1])
    assert quantiles_h == pytest.approx(np.stack([expected, expected]), rel=1e-12)


def test_lives_that_were_cut_leave_the_law_of_age_where_it_was() -> None:
    lives_h = 50.0 * np.random.default_rng(3).weibull(4.0, 4000)
    cut_h = np.random.default_rng(4).uniform(0.0, 120.0, 4000)  # blind to the life, as gearboxes are taken out
    failed = lives_h <= cut_h
    slope, scale_h = weibull_lives(lives_h[failed], cut_h[~failed])
    # standard errors of some 2,400 failures: 1.3 % of the slope, 0.5 % of the scale; four of them
    assert slope == pytest.approx(4.0, rel=0.055)
    assert scale_h == pytest.approx(50.0, rel=0.02)
