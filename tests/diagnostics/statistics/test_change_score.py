"""The rate of false alarms is the one that ranks promise, whatever the features; changes of many of them are seen."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.statistics.change_score import Condition, attainable_rate, change_score
from siggen.errors import UsageError

FEATURES = 80


def healthy_recordings(rng: np.random.Generator, count: int) -> np.ndarray:
    """Logarithms that depend on each other, with heavy tails and spreads of their own: nothing that a rank needs."""
    common = rng.normal(size=(count, 3)) @ rng.normal(size=(3, FEATURES)) * 0.1
    return common + rng.standard_t(4, size=(count, FEATURES)) * rng.lognormal(-2.0, 0.7, FEATURES)


@pytest.mark.parametrize(("references", "promised"), [(4, 0.2), (20, 0.05)])
def test_false_alarms_are_no_more_than_promised(references: int, promised: float) -> None:
    """300 draws: four standard deviations of their share are 0.092 at 0.2 and 0.05 at 0.05."""
    rng = np.random.default_rng(5)
    drawn = (healthy_recordings(rng, references + 1) for _ in range(300))
    alarms = np.mean([change_score(bag[:-1], bag[-1]).changed for bag in drawn])
    assert attainable_rate(references, 0.05) == pytest.approx(promised)
    assert alarms <= promised + 4.0 * np.sqrt(promised * (1.0 - promised) / 300)


def test_ranks_do_not_depend_on_the_order_of_references_or_the_scale_of_a_feature() -> None:
    bag = healthy_recordings(np.random.default_rng(1), 8)
    plain = change_score(bag[:-1], bag[-1])
    turned = change_score(bag[:-1][::-1], bag[-1])
    assert (plain.score, plain.limit, plain.changed) == pytest.approx((turned.score, turned.limit, turned.changed))
    shifted = change_score(bag[:-1] + 3.0, bag[-1] + 3.0)  # a gain, in logarithms
    assert shifted.score == pytest.approx(plain.score)


def test_a_change_of_a_tenth_of_the_indicators_is_seen_and_named() -> None:
    bag = healthy_recordings(np.random.default_rng(2), 13)
    changed = bag[-1].copy()
    changed[:8] += 3.0
    found = change_score(bag[:-1], changed)
    assert found.changed
    assert found.score > found.limit
    assert set(np.argsort(-np.abs(found.deviation))[:5]) <= set(range(8))


def test_an_indicator_that_one_recording_lacks_does_not_count() -> None:
    bag = healthy_recordings(np.random.default_rng(3), 6)
    without = change_score(bag[:-1, 1:], bag[-1, 1:])
    bag[2, 0] = np.nan
    assert change_score(bag[:-1], bag[-1]).score == pytest.approx(without.score)


def test_two_references_are_too_few() -> None:
    with pytest.raises(UsageError, match="4 are needed"):
        change_score(np.zeros((2, 4)), np.zeros(4))


def recordings_under_load(rng: np.random.Generator, loads: np.ndarray) -> np.ndarray:
    """Logarithms that follow the load, each by its own exponent from -1 to 2 and with a bend, and noise of 3 %."""
    away = np.log(loads / loads.max())[:, None]
    exponents, bends = np.random.default_rng(9).uniform([-1.0, -0.2], [2.0, 0.2], (FEATURES, 2)).T
    return away * exponents + away**2 * bends + 0.03 * rng.normal(size=(loads.size, FEATURES))


@pytest.mark.parametrize("count", [4, 6])
def test_a_load_between_those_of_the_references_is_no_change_and_a_tenth_at_threefold_is(count: int) -> None:
    """50 draws each, against the rates that are asked of a machine: 1 of 10 and 9 of 10."""
    rng = np.random.default_rng(1)
    alarms, hits = [], []
    for _ in range(50):
        loads = np.append(np.append(rng.uniform(12.0, 95.0, count - 2), [10.0, 100.0]), rng.uniform(20.0, 80.0))
        bag = recordings_under_load(rng, loads)
        load = Condition(np.log(loads), 1.0, 0.2, 0.5)
        alarms.append(change_score(bag[:-1], bag[-1], 0.05, [load]).changed)
        bag[-1, :8] += np.log(3.0)
        hits.append(change_score(bag[:-1], bag[-1], 0.05, [load]).changed)
    assert np.mean(alarms) <= 0.1
    assert np.mean(hits) >= 0.9


def test_where_conditions_are_equal_others_say_their_mean_and_far_from_them_little() -> None:
    bag = healthy_recordings(np.random.default_rng(4), 7)
    alike = Condition(np.zeros(7), 1.0, 0.2, 0.5)
    assert change_score(bag[:-1], bag[-1], 0.05, [alike]).mean == pytest.approx(bag[:-1].mean(axis=0))
    away = np.zeros(7)
    away[-1] = 5.0
    far = change_score(bag[:-1], bag[-1], 0.05, [Condition(away, 1.0, 0.2, 0.5)])
    near = change_score(bag[:-1], bag[-1], 0.05, [alike])
    assert far.score < 0.2 * near.score
