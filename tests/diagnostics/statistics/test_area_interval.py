"""Limits of an AUC hold also where all pairs are won, which resampled gearboxes alone cannot say."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.judging.evaluation import wins
from diagnostics.statistics.evaluation import (
    area_interval,
    bootstrap_weights,
    clopper_pearson,
    effective_size,
    interval,
)

RESAMPLES, TRIALS = 100, 150


def areas(gearboxes: int, area: float, shared: float, seed: int) -> np.ndarray:
    """AUC and resampled ones of a healthy and a damaged record per gearbox, whose scores share some noise."""
    from scipy.stats import norm

    rng = np.random.default_rng(seed)
    own = np.sqrt(abs(shared)) * rng.standard_normal(gearboxes)
    healthy, damaged = np.sqrt(1.0 - abs(shared)) * rng.standard_normal((2, gearboxes))
    damaged = damaged + norm.ppf(area) * np.sqrt(2.0) + np.sign(shared) * own
    specimen, positive = np.tile(np.arange(gearboxes), 2), np.arange(2 * gearboxes) >= gearboxes
    weights = bootstrap_weights(specimen, seed, RESAMPLES)
    won, every = wins(np.r_[healthy + own, damaged], positive, specimen, weights)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(every > 0.0, won / every, np.nan)


def test_all_won_gives_the_exact_binomial_bound() -> None:
    found = area_interval(np.ones(51), 24)
    assert (found.value, found.high) == (1.0, 1.0)
    assert found.low == pytest.approx(0.025 ** (1 / 24))  # 0.857: the rule of three, two-sided
    assert clopper_pearson(0.0, 24) == (0.0, pytest.approx(1.0 - 0.025 ** (1 / 24)))


def test_an_area_just_below_one_is_not_known_better_than_one() -> None:
    nearly = np.r_[0.998, np.random.default_rng(0).uniform(0.996, 1.0, 50)]
    assert area_interval(nearly, 24).low == area_interval(np.ones(51), 24).low


def test_limits_are_those_of_clopper_and_pearson_for_whole_numbers() -> None:
    # 0.9 of 10: standard tables give 0.5550 and 0.9975
    assert clopper_pearson(0.9, 10) == (pytest.approx(0.5550, abs=1e-4), pytest.approx(0.9975, abs=1e-4))


def test_no_fewer_gearboxes_count_than_there_are() -> None:
    assert effective_size(0.9, np.array([0.5, 1.0]), 12) == 12.0
    assert effective_size(0.9, 0.9 + 0.01 * np.array([-1.0, 1.0]), 12) == pytest.approx(900.0)


@pytest.mark.parametrize(("gearboxes", "area"), [(8, 0.9), (8, 0.99), (24, 0.97), (24, 0.99)])
@pytest.mark.parametrize("shared", [-0.5, 0.0, 0.6])
def test_the_lower_limit_lies_below_the_true_area_in_95_percent(gearboxes: int, area: float, shared: float) -> None:
    """0.92 of 150: three standard errors of a share of 0.975. The bootstrap alone has 0.3 to 0.85."""
    samples = [areas(gearboxes, area, shared, seed) for seed in range(TRIALS)]
    assert np.mean([area_interval(found, gearboxes).low <= area for found in samples]) >= 0.92
    assert np.mean([interval(found, gearboxes).low <= area for found in samples]) < 0.92


@pytest.mark.parametrize("gearboxes", [8, 24])
@pytest.mark.parametrize("shared", [-0.5, 0.0, 0.6])
def test_both_limits_of_a_mixed_area_hold_where_more_gearboxes_count_than_there_are(
    gearboxes: int, shared: float
) -> None:
    """0.90 of 150: three standard errors of a share of 0.95."""
    area = 0.8
    samples = [areas(gearboxes, area, shared, seed) for seed in range(TRIALS)]
    found = [area_interval(one, gearboxes) for one in samples]
    assert np.mean([one.low <= area <= one.high for one in found]) >= 0.90
    assert np.mean([effective_size(one[0], one[1:], gearboxes) > gearboxes for one in samples]) > 0.5
