"""The limit of the strongest detector: how often chance exceeds it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnostics.audit.bank import exceeded_by_chance

DRAWS = 40_000


@pytest.mark.parametrize("permutations", [19, 100, 199])
def test_chance_exceeds_the_limit_in_five_percent_of_the_cases_at_most(permutations: int) -> None:
    # for continuous numbers the share is 1 - ceil(0.95 (n + 1))/(n + 1), whatever their law
    drawn = np.random.default_rng(1).exponential(size=(DRAWS, permutations + 1))
    expected = 1.0 - math.ceil(0.95 * (permutations + 1) - 1e-9) / (permutations + 1)
    assert expected <= 0.05 + 1e-12
    limits = [exceeded_by_chance(row) for row in drawn[:, 1:]]
    # four standard errors are 0.0044: less than half of the 0.0094 by which the quantile of 100 is exceeded more often
    tolerance = 4.0 * math.sqrt(expected * (1.0 - expected) / DRAWS)
    assert np.mean(drawn[:, 0] > limits) == pytest.approx(expected, abs=tolerance)
    if permutations <= 100:  # so the test can tell them apart
        quantiles = np.quantile(drawn[:, 1:], 0.95, axis=1)
        assert np.mean(drawn[:, 0] > quantiles) > expected + tolerance


def test_where_chance_reaches_the_largest_too_often_nothing_can_be_told() -> None:
    assert exceeded_by_chance(np.array([0.6, 0.7, 0.5])) == 1.0  # 1 of 4 is more than 5 %
    ways = np.tile(np.linspace(0.3, 0.75, 16), 31)  # of four gearboxes with two records each, all ways of stating them
    assert exceeded_by_chance(ways) == 1.0
    assert exceeded_by_chance(np.linspace(0.3, 0.75, 64)) < 0.75
    assert math.isnan(exceeded_by_chance(np.empty(0)))
