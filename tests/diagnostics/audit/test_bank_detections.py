"""The limit of the strongest attacker: how often chance exceeds it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from diagnostics.audit.bank_detections import exceeded_by_chance


@pytest.mark.parametrize("permutations", [19, 100, 199])
def test_chance_exceeds_the_limit_in_five_percent_of_the_cases_at_most(permutations: int) -> None:
    # for continuous numbers the share is 1 - ceil(0.95 (n + 1))/(n + 1), whatever their law
    drawn = np.random.default_rng(1).exponential(size=(4000, permutations + 1))
    above = np.mean([row[0] > exceeded_by_chance(row[1:]) for row in drawn])
    expected = 1.0 - math.ceil(0.95 * (permutations + 1)) / (permutations + 1)
    assert expected <= 0.05 + 1e-12
    assert above == pytest.approx(expected, abs=4.0 * math.sqrt(0.05 * 0.95 / 4000))


def test_few_permutations_give_their_largest_and_none_nothing() -> None:
    assert exceeded_by_chance(np.array([0.6, 0.7, 0.5])) == 0.7
    assert math.isnan(exceeded_by_chance(np.empty(0)))
