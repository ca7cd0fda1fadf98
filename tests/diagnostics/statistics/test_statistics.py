"""Statistics of the evaluation against closed forms and other libraries."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from scipy.stats import mannwhitneyu, wilcoxon
from sklearn.isotonic import IsotonicRegression

from diagnostics.statistics.detectable_size import detection_curve, isotonic, size_at, weighted_quantile
from diagnostics.statistics.indicator_statistics import (
    cohens_d,
    explained_share,
    false_discovery,
    holm,
    ladder_steps,
    monotonicity,
    paired_d,
    paired_p,
    paired_records,
    shares_above,
    smallest_paired_p,
    two_sample_p,
)


def ones(count: int) -> np.ndarray:
    return np.ones((1, count))


def test_effect_of_a_shift_by_two_deviations_is_two() -> None:
    rng = np.random.default_rng(1)
    values = np.concatenate([rng.standard_normal(20_000), 2.0 + rng.standard_normal(20_000)])
    positive = np.arange(40_000) >= 20_000
    # standard error of d: sqrt(2/n + d^2/(4 n)) = 0.012
    assert cohens_d(values, positive, ones(40_000))[0] == pytest.approx(2.0, abs=4 * 0.0123)
    a, b = values[~positive], values[positive]
    expected = (b.mean() - a.mean()) / math.sqrt((a.var(ddof=1) + b.var(ddof=1)) / 2)
    assert cohens_d(values, positive, ones(40_000))[0] == pytest.approx(expected)
    assert paired_d(b - a, ones(20_000))[0] == pytest.approx((b - a).mean() / (b - a).std(ddof=1))


def test_integer_weights_count_like_repeated_records() -> None:
    rng = np.random.default_rng(2)
    values, weights = rng.standard_normal(12), rng.integers(0, 4, 12).astype(float)
    positive = np.arange(12) % 2 == 0
    rows = np.repeat(np.arange(12), weights.astype(int))
    repeated = cohens_d(values[rows], positive[rows], ones(rows.size))[0]
    assert cohens_d(values, positive, weights[None, :])[0] == pytest.approx(repeated)
    assert paired_d(values, weights[None, :])[0] == pytest.approx(paired_d(values[rows], ones(rows.size))[0])
    assert shares_above(values, weights[None, :])[0] == pytest.approx((values[rows] > 0).mean())


def test_effect_without_spread_is_undefined() -> None:
    assert math.isnan(cohens_d(np.array([1.0, 1.0, 2.0, 2.0]), np.array([False, False, True, True]), ones(4))[0])
    assert math.isnan(paired_d(np.ones(3), ones(3))[0])


def test_pairs_are_of_one_specimen_and_operating_point() -> None:
    labels = {
        "specimen_id": np.array([0, 0, 0, 0, 1, 1, 2]),
        "operating_point_id": np.array([0, 0, 1, 0, 0, 0, 0]),
        "repeat": np.array([0, 1, 0, 1, 0, 0, 0]),
        "fault": np.array(["healthy", "healthy", "pitting", "pitting", "pitting", "healthy", "pitting"]),
    }
    found = paired_records(labels)
    # record 2 has no healthy record at its operating point, record 6 none of its specimen
    assert list(zip(found.rows, found.partners, strict=True)) == [(3, 1), (4, 5)]
    assert list(zip(found.null_rows, found.null_partners, strict=True)) == [(1, 0)]


def test_monotonicity_is_the_mean_sign_of_the_steps() -> None:
    values = np.array([1.0, 2.0, 3.0, 2.5, 9.0, 8.0])
    before, after = ladder_steps([np.array([0, 1, 2, 3]), np.array([4, 5])])
    assert monotonicity(values[after] - values[before], ones(4))[0] == pytest.approx(0.0)
    assert monotonicity(np.array([1.0, 2.0, -1.0]), np.array([[1.0, 1.0, 0.0]]))[0] == 1.0


@given(p_values=st.lists(st.floats(0.0, 1.0), min_size=1, max_size=20))
def test_adjusted_p_values_by_their_definitions(p_values: list[float]) -> None:
    p = np.array(p_values)
    np.testing.assert_allclose(false_discovery(p), stats.false_discovery_control(p))
    ordered = sorted(range(p.size), key=lambda i: (p[i], i))
    for rank, i in enumerate(ordered):
        expected = min(1.0, max((p.size - k) * p[ordered[k]] for k in range(rank + 1)))
        assert holm(p)[i] == pytest.approx(expected)


def test_undefined_p_values_do_not_count() -> None:
    np.testing.assert_allclose(holm(np.array([0.01, np.nan, 0.5])), [0.02, np.nan, 0.5])


def test_tests_over_specimens() -> None:
    rng = np.random.default_rng(3)
    shift = 0.5 + 0.1 * np.abs(rng.standard_normal(8))
    least = smallest_paired_p(8)
    np.testing.assert_allclose(paired_p([shift, np.zeros(8), shift[:2]]), [least, 1.0, np.nan])
    assert least == pytest.approx(2 / 2**8)
    apart = (np.arange(5.0), np.arange(5.0) + 10)
    np.testing.assert_allclose(two_sample_p([(shift[:2], shift), apart]), [np.nan, 2 / math.comb(10, 5)])


def test_p_values_taken_together_are_those_of_each_test() -> None:
    rng = np.random.default_rng(4)  # rounded ones have ties and zeros, for which scipy takes other methods
    healthy, damaged = rng.standard_normal((2, 9, 7))
    healthy[::2], damaged[::2] = np.round(healthy[::2]), np.round(damaged[::2])
    both = [mannwhitneyu(b, a).pvalue for a, b in zip(healthy, damaged, strict=True)]
    np.testing.assert_allclose(two_sample_p(list(zip(healthy, damaged, strict=True))), both, rtol=1e-12)
    np.testing.assert_allclose(paired_p(list(damaged)), [wilcoxon(own).pvalue for own in damaged], rtol=1e-12)


def test_explained_share_is_one_for_a_cause_and_zero_for_chance() -> None:
    rng = np.random.default_rng(4)
    speed = rng.uniform(20, 35, 400)
    assert explained_share(3 * speed, speed, groups=False) > 0.99  # ranks of uniform speeds are nearly linear in them
    # adjusted shares scatter by about sqrt(2 p)/n = 0.005 round zero
    assert explained_share(rng.standard_normal(400), speed, groups=False) < 4 * 0.005
    group = np.repeat(np.arange(40), 10)
    assert explained_share(rng.standard_normal(400), group, groups=True) < 4 * math.sqrt(2 * 39) / 400
    half = explained_share(rng.standard_normal(40)[group] + rng.standard_normal(400), group, groups=True)
    assert half == pytest.approx(0.5, abs=4 * 0.5 / math.sqrt(40 / 2))


def test_explained_share_that_cannot_be_judged_is_undefined() -> None:
    values = np.arange(5.0)
    assert math.isnan(explained_share(values, np.ones(5), groups=True))
    assert math.isnan(explained_share(values, np.arange(5), groups=True))
    assert math.isnan(explained_share(np.ones(5), values, groups=False))


@given(seed=st.integers(0, 500), groups=st.integers(2, 12))
def test_isotonic_fit_is_that_of_scikit_learn(seed: int, groups: int) -> None:
    rng = np.random.default_rng(seed)
    counts = rng.integers(1, 6, groups).astype(float)
    sums = counts * rng.uniform(size=groups)
    expected = IsotonicRegression().fit(np.arange(groups), sums / counts, counts).predict(np.arange(groups))
    np.testing.assert_allclose(isotonic(sums[None, :], counts[None, :])[0], expected, atol=1e-12)


def test_group_without_weight_takes_the_value_below() -> None:
    np.testing.assert_allclose(isotonic(np.array([[0.0, 0.0, 2.0]]), np.array([[2.0, 0.0, 2.0]])), [[0.0, 0.0, 1.0]])


def test_threshold_leaves_the_stated_share_of_false_alarms() -> None:
    values = np.arange(100.0)
    threshold = weighted_quantile(values, np.ones((1, 100)), 0.95)[0]
    assert np.mean(values > threshold) == pytest.approx(0.05)
    doubled = np.where(values < 50, 2.0, 0.0)[None, :]
    assert weighted_quantile(values, doubled, 0.9)[0] == 44.0


def test_size_is_found_where_the_indicator_crosses_its_healthy_spread() -> None:
    rng = np.random.default_rng(5)
    healthy = np.arange(6000) < 3000
    size = np.where(healthy, 0.0, np.exp(rng.uniform(np.log(0.1), np.log(10.0), 6000)))
    values = rng.standard_normal(6000) + np.where(healthy, 0.0, 4.0 * np.log10(np.maximum(size, 1e-9)) + 1.645)
    curve = detection_curve(values, healthy, size, np.ones((1, 6000)), 0.05)
    assert curve is not None
    # threshold 1.645: half the records of size 1 lie above; 90 % at 4 lg s = 1.2816. Groups are 10^(1/6) = 1.47 wide
    assert size_at(curve, 0.5)[0] == pytest.approx(1.0, rel=0.15)
    assert size_at(curve, 0.9)[0] == pytest.approx(10 ** (1.2816 / 4), rel=0.15)
    assert np.isinf(size_at(detection_curve(-values, healthy, size, np.ones((1, 6000)), 0.05), 0.9)[0])  # type: ignore[arg-type]


def test_a_ladder_of_few_sizes_has_one_group_per_size() -> None:
    healthy = np.arange(200) < 100
    size = np.where(healthy, 0.0, np.repeat([0.0, 1.0, 2.0, 4.0], [100, 20, 30, 50]))
    values = np.concatenate([np.arange(100.0), np.full(20, 0.0), np.tile([0.0, 99.5], 15), np.full(50, 99.5)])
    curve = detection_curve(values, healthy, size, np.ones((1, 200)), 0.05)
    assert curve is not None
    np.testing.assert_array_equal(curve.size, [1.0, 2.0, 4.0])
    np.testing.assert_array_equal(curve.share, [[0.0, 0.5, 1.0]])
    # between 2 and 4 on a logarithmic axis: 2^(1 + 0.4/0.5)
    assert size_at(curve, 0.9)[0] == pytest.approx(2.0**1.8)


def test_records_of_one_size_stay_in_one_group() -> None:
    # two sizes of 45 and one of 3, too few for a group: 80 % of alarms at either large size, in any order of records
    rng = np.random.default_rng(3)
    alarms = np.concatenate([np.full(3, -2.0), np.tile([1.0, 1.0, 1.0, 1.0, -2.0], 18)])
    size = np.concatenate([np.full(3, 0.5), np.full(45, 1.0), np.full(45, 3.0)])
    for _ in range(20):
        order = np.concatenate([np.arange(3), 3 + rng.permutation(45), 48 + rng.permutation(45)])
        values = np.concatenate([np.linspace(-1.0, 0.0, 100), alarms[order]])
        sizes = np.concatenate([np.zeros(100), size])
        curve = detection_curve(values, np.arange(193) < 100, sizes, np.ones((1, 193)), 0.01)
        assert curve is not None
        assert np.isinf(size_at(curve, 0.9)[0])


def test_too_few_damaged_records_give_no_curve() -> None:
    healthy = np.arange(20) < 12
    assert detection_curve(np.arange(20.0), healthy, np.where(healthy, 0, 1.0), np.ones((1, 20)), 0.05) is None
