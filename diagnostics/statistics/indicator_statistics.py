"""How every indicator separates damage: AUC, effect, trend, what else moves it, in both designs, with tests.

Report, ranking and audit read an indicator's AUC from here, so that it has one. Intervals: 95 %, bootstrap over
specimens. Nothing is trained, so all specimens count; but the direction of each indicator is read from the same
specimens, and so is the place in the ranking: the best of many is optimistic, which the adjusted p-values account for.

* Effect: Cohen's d between two groups and of paired differences. Cliff's delta is 2 AUC - 1 and therefore not given
  again. Source: Cohen 1988.
* Trend: mean sign of the steps over a ladder, which is one specimen at one operating point and repeat, its records in
  order of damaged area. 1: every step up; -1: every step down. Source: Coble & Hines 2009 (there its magnitude).
* What moves it in healthy records: share of rank variance that speed, load, sensor, noise, specimen explain, each cause
  alone, adjusted for its degrees of freedom. Causes may share variance, so shares need not add up to one. Source:
  adjusted R^2 of a linear model.
* Tests on the means of specimens, adjusted for all indicators, channels and states. Source: Mann-Whitney, Wilcoxon,
  Holm, Benjamini and Hochberg, standard literature.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.indicators.history import histories
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.ranking_table import IndicatorTable
from diagnostics.records.gear_train import PAIR, GearNames
from diagnostics.records.state_classes import HEALTHY, ordered_states
from diagnostics.statistics.detectable_size import detection_curves, size_at
from diagnostics.statistics.evaluation import (
    LEVEL,
    RESAMPLES,
    UNDEFINED,
    CentredRanks,
    Interval,
    bootstrap_weights,
    centred_ranks,
    interval,
    weighted_auc,
)


@dataclass(slots=True)
class StateResult:
    """One state against healthy, in one design.

    Attributes
    ----------
    separation : Interval
        Other specimens: AUC. Same specimen: share of pairs in which the indicator is higher after.
    effect : Interval
        Cohen's d; of the differences in the same-specimen design.
    p_value, holm, false_discovery : float
        Two-sided p-value over specimens, adjusted by Holm and by Benjamini and Hochberg over all indicators, channels
        and states of the design.
    """

    separation: Interval
    effect: Interval
    p_value: float = math.nan
    holm: float = math.nan
    false_discovery: float = math.nan


@dataclass(slots=True)
class IndicatorResult:
    """One indicator in one channel.

    Attributes
    ----------
    column, indicator, channel : str
        `fm4_pinion__x`, `fm4_pinion`, `x`.
    direction : int
        1 where it rises with damage, -1 where it falls (sign of the mean change of the same specimen).
    others, same : dict of str to StateResult
        By state: other specimens, and the same specimen before and after.
    score_others, score_same : Interval
        Mean over the states of the separation, turned so that 1 is perfect and 0.5 is chance.
    spearman_area, spearman_stiffness, monotonicity : Interval
        Rank correlation with damaged area and with loss of mesh stiffness; mean sign of steps up the severity ladder.
    sensitivity : dict of str to float
        Share of rank variance in healthy records that a cause explains alone.
    detectable : dict of str to Interval
        Smallest size found, e.g. `others_area_mm2_a90`; infinite where not reached.
    smallest_size : dict of str to float
        Median size of the group of smallest damage, e.g. `others_area_mm2`; what is found there is an upper bound.
    defined_share : float
        Share of records where the indicator has a value.
    gears : GearNames
        What columns are called after.
    """

    column: str
    indicator: str
    channel: str
    direction: int
    others: dict[str, StateResult]
    same: dict[str, StateResult]
    score_others: Interval
    score_same: Interval
    spearman_area: Interval
    spearman_stiffness: Interval
    monotonicity: Interval
    defined_share: float
    gears: GearNames
    sensitivity: dict[str, float] = field(default_factory=dict)
    detectable: dict[str, Interval] = field(default_factory=dict)
    smallest_size: dict[str, float] = field(default_factory=dict)

    @property
    def separability(self) -> Separability:
        """How it tells each state between specimens."""
        areas = {state: found.separation for state, found in self.others.items()}
        return Separability(
            self.column, areas, self.spearman_area, self.defined_share, self.direction, gears=self.gears
        )

    def row(self) -> dict[str, Any]:
        """Return everything as one flat row of a table."""
        row: dict[str, Any] = {"indicator": self.indicator, "channel": self.channel, "direction": self.direction}
        row["defined_share"] = self.defined_share
        intervals = {
            "score_other_specimens": self.score_others,
            "score_same_specimen": self.score_same,
            "spearman_area": self.spearman_area,
            "spearman_stiffness": self.spearman_stiffness,
            "monotonicity": self.monotonicity,
            **self.detectable,
        }
        for design, states in (("others", self.others), ("same", self.same)):
            for state, found in states.items():
                intervals[f"{design}_separation_{state}"] = found.separation
                intervals[f"{design}_cohens_d_{state}"] = found.effect
                row[f"{design}_p_{state}"] = found.p_value
                row[f"{design}_holm_{state}"] = found.holm
                row[f"{design}_false_discovery_{state}"] = found.false_discovery
        for name, limits in intervals.items():
            row |= {name: limits.value, f"{name}_low": limits.low, f"{name}_high": limits.high}
        return row | {f"explained_by_{cause}": share for cause, share in self.sensitivity.items()}


FEWEST_SPECIMENS = 3


@dataclass(frozen=True, slots=True)
class PairedRecords:
    """Rows of records and of their healthy partners.

    Attributes
    ----------
    rows, partners : (k,) int
        A record with damage and the healthy record of the same specimen, operating point and repeat; where the healthy
        state has no such repeat, its first.
    null_rows, null_partners : (m,) int
        Two healthy records of one specimen and operating point, different repeats; empty where nothing is repeated.
    """

    rows: np.ndarray
    partners: np.ndarray
    null_rows: np.ndarray
    null_partners: np.ndarray


def paired_records(labels: Mapping[str, np.ndarray]) -> PairedRecords:
    """Return which records are compared with which.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `specimen_id`, `operating_point_id`, `repeat`, `fault`.
    """
    healthy: dict[tuple[int, int], dict[int, int]] = {}
    keys = list(zip(labels["specimen_id"].tolist(), labels["operating_point_id"].tolist(), strict=True))
    repeats = labels["repeat"].tolist()
    is_healthy = labels["fault"] == HEALTHY
    for row in np.flatnonzero(is_healthy).tolist():
        healthy.setdefault(keys[row], {}).setdefault(repeats[row], row)
    pairs, null = [], []
    for row, key in enumerate(keys):
        found = healthy.get(key)
        if not found:
            continue
        first = found[min(found)]
        if not is_healthy[row]:
            pairs.append((row, found.get(repeats[row], first)))
        elif row != first:
            null.append((row, first))
    return PairedRecords(*_columns(pairs), *_columns(null))


def _columns(pairs: list[tuple[int, int]]) -> tuple[np.ndarray, np.ndarray]:
    found = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def shares_above(difference: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weighted share of positive differences, zeros counting half, for every row of weights.

    Parameters
    ----------
    difference : (k,) float64
        After minus before, without NaN.
    weights : (b, k) float64
        Weights of the pairs.

    Returns
    -------
    (b,) float64
        0.5: no change; 1: always higher after. NaN without weight.
    """
    above = 0.5 + 0.5 * np.sign(difference)
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(weights @ above / total)


def specimen_means(values: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the mean of the values of each specimen, (specimens,)."""
    _, index = np.unique(specimen, return_inverse=True)
    return np.asarray(np.bincount(index, values) / np.bincount(index))


def two_sample_p(samples: Sequence[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Return the two-sided p-values of Mann-Whitney's test on specimen means; NaN below three specimens a side.

    Parameters
    ----------
    samples : sequence of ((h,), (d,) float64)
        Healthy and damaged specimens of each test.

    Returns
    -------
    (tests,) float64
    """
    from scipy.stats import mannwhitneyu

    found = np.full(len(samples), np.nan)
    judged = {k: pair for k, pair in enumerate(samples) if min(map(len, pair)) >= FEWEST_SPECIMENS}
    for alike in _alike(
        {k: np.concatenate(pair) for k, pair in judged.items()}, {k: len(p[0]) for k, p in judged.items()}
    ):
        healthy, damaged = (np.stack([judged[k][side] for k in alike]) for side in (0, 1))
        found[alike] = mannwhitneyu(damaged, healthy, alternative="two-sided", axis=1).pvalue
    return found


def paired_p(differences: Sequence[np.ndarray]) -> np.ndarray:
    """Return the two-sided p-values of Wilcoxon's signed-rank test on specimen means; NaN below three specimens.

    Parameters
    ----------
    differences : sequence of (k,) float64
        Of the specimens of each test.

    Returns
    -------
    (tests,) float64
    """
    from scipy.stats import wilcoxon

    found = np.array([np.nan if own.size < FEWEST_SPECIMENS or own.any() else 1.0 for own in differences])
    judged = {k: own for k, own in enumerate(differences) if own.size >= FEWEST_SPECIMENS and own.any()}
    # a zero beside the amounts: one that is zero itself counts as a tie
    amounts = {k: np.append(np.abs(own), 0.0) for k, own in judged.items()}
    for alike in _alike(amounts, dict.fromkeys(judged, 0)):
        found[alike] = wilcoxon(np.stack([judged[k] for k in alike]), alternative="two-sided", axis=1).pvalue
    return found


def _alike(values: Mapping[int, np.ndarray], sides: Mapping[int, int]) -> list[list[int]]:
    """Return tests that can be done together: of one size, without ties, for which scipy takes another method."""
    groups: dict[tuple[int, int, int], list[int]] = {}
    for k, own in values.items():
        is_tied = np.unique(own).size < own.size
        groups.setdefault((own.size, sides[k], k if is_tied else -1), []).append(k)
    return list(groups.values())


def holm(p_values: np.ndarray) -> np.ndarray:
    """Return p-values adjusted by Holm: below a, no false discovery at all with probability 1 - a.

    Parameters
    ----------
    p_values : (n,) float64
        NaN stays NaN and does not count.
    """
    order = _ascending(p_values)
    factor = order.size - np.arange(order.size)
    return _scattered(p_values.size, order, np.maximum.accumulate(p_values[order] * factor))


def false_discovery(p_values: np.ndarray) -> np.ndarray:
    """Return p-values adjusted by Benjamini and Hochberg: below q, a share q of the discoveries is false on average.

    Parameters
    ----------
    p_values : (n,) float64
        NaN stays NaN and does not count.
    """
    from scipy.stats import false_discovery_control

    defined = np.isfinite(p_values)
    found = np.full(p_values.size, np.nan)
    if defined.any():
        found[defined] = false_discovery_control(p_values[defined], method="bh")
    return found


def _ascending(p_values: np.ndarray) -> np.ndarray:
    """Return the positions of the defined values in ascending order."""
    defined = np.flatnonzero(np.isfinite(p_values))
    return defined[np.argsort(p_values[defined], kind="stable")]


def _scattered(size: int, order: np.ndarray, adjusted: np.ndarray) -> np.ndarray:
    found = np.full(size, np.nan)
    found[order] = np.minimum(adjusted, 1.0)
    return found


def smallest_paired_p(specimens: int) -> float:
    """Return the smallest p-value that the signed-rank test can give with so many specimens."""
    return float(2.0 ** (1 - specimens))


FEWER_RESAMPLES = 400
LARGEST_BLOCK = 4_000_000
"""Largest resamples times records; more records get fewer resamples, since their intervals are narrow anyway."""

MOST_KNOWN = 2
"""Ranks of labels that are kept: area and loss of stiffness where most indicators are defined; more fill memory."""


def ladder_steps(ladders: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows before and after each step of all ladders, (k,) int each.

    Parameters
    ----------
    ladders : sequence of (m,) int
        Rows of each ladder in order of severity.
    """
    pairs = [(int(a), int(b)) for rows in ladders for a, b in pairwise(rows)]
    found = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def monotonicity(steps: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weighted mean sign of the steps, (b,); NaN without weight.

    Parameters
    ----------
    steps : (k,) float64
        Value after minus value before each step, without NaN.
    weights : (b, k) float64
        Weights of the steps, those of their specimens.
    """
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(weights @ np.sign(steps) / total)


@dataclass(frozen=True, slots=True)
class JudgedRecords:
    """What all indicators share.

    Attributes
    ----------
    labels : dict of str to (records,)
    states : tuple of str
        Those with damaged records, in the order of the configuration.
    weights : (resamples + 1, records) float64
        Row 0 is the sample itself.
    pairs : PairedRecords
        Same specimen before and after.
    steps : ((k,) int, (k,) int)
        Rows before and after each step up a ladder of damage.
    known : dict
        Ranks of labels that were asked for.
    """

    labels: dict[str, np.ndarray]
    states: tuple[str, ...]
    weights: np.ndarray
    pairs: PairedRecords
    steps: tuple[np.ndarray, np.ndarray]
    known: dict[tuple[str, bytes], CentredRanks] = field(default_factory=dict, repr=False, compare=False)

    def centred(self, label: str, rows: np.ndarray) -> CentredRanks:
        """Return the centred ranks of a label over these rows; most indicators are defined on the same."""
        key = (label, rows.tobytes())
        if key not in self.known:
            if len(self.known) >= MOST_KNOWN:
                self.known.clear()
            self.known[key] = centred_ranks(self.labels[label][rows], self.weights[:, rows])
        return self.known[key]

    def centred_values(self, values: np.ndarray) -> CentredRanks:
        """Return the centred ranks of an indicator, (records,), over the rows where it is defined."""
        rows = np.flatnonzero(np.isfinite(values))
        return centred_ranks(values[rows], self.weights[:, rows])

    def interval(self, samples: np.ndarray, rows: np.ndarray) -> Interval:
        """Return the interval of a statistic over these rows."""
        return interval(samples, int(np.unique(self.labels["specimen_id"][rows]).size))


def judged_records(labels: dict[str, np.ndarray], seed: int, resamples: int = FEWER_RESAMPLES) -> JudgedRecords:
    """Return what all indicators of records with these labels share."""
    count = labels["specimen_id"].size
    weights = bootstrap_weights(labels["specimen_id"], seed, min(resamples, max(50, LARGEST_BLOCK // count)))
    damaged = set(labels["state"][labels["fault"] != HEALTHY].tolist())
    states = tuple(state for state in ordered_states(labels) if state in damaged)
    return JudgedRecords(labels, states, weights, paired_records(labels), ladder_steps(histories(labels)))


@dataclass(frozen=True, slots=True)
class Separability:
    """One indicator in one channel.

    Attributes
    ----------
    feature : str
        Its column.
    auc : dict of str to Interval
        AUC of every state against healthy, between other specimens; below 0.5 where it falls.
    spearman : Interval
        Rank correlation with the damaged area.
    defined_share : float
        Share of records where it is defined.
    direction : int
        1 where it rises with damage, -1 where it falls: mean change of the same specimens, else of the AUC; 0 unknown.
    samples, same : dict of str to (resamples + 1,)
        Resamples of the AUC, and of the share of pairs of one specimen in which it is higher after, by state.
    gears : GearNames
        What columns are called after.
    """

    feature: str
    auc: dict[str, Interval]
    spearman: Interval
    defined_share: float
    direction: int = 0
    samples: dict[str, np.ndarray] = field(default_factory=dict, repr=False)
    same: dict[str, np.ndarray] = field(default_factory=dict, repr=False)
    gears: GearNames = PAIR

    @property
    def strength(self) -> float:
        """Largest distance of an AUC from chance, 0 to 0.5; what the table is sorted by."""
        distance = [abs(found.value - 0.5) for found in self.auc.values() if math.isfinite(found.value)]
        return max(distance, default=0.0)

    def turned(self, state: str) -> Interval:
        """Return the AUC of a state, turned by the direction so that 1 is perfect."""
        found = self.auc[state]
        if (self.direction or (-1 if found.value < 0.5 else 1)) > 0:
            return found
        return Interval(1.0 - found.value, 1.0 - found.high, 1.0 - found.low)


def separability(matrix: FeatureMatrix, seed: int, resamples: int = FEWER_RESAMPLES) -> list[Separability]:
    """Return every indicator's separability, strongest first.

    Parameters
    ----------
    matrix : FeatureMatrix
        Records of the specimens to judge on.
    seed : int
        Seed of the bootstrap.
    resamples : int
        Most resamples to draw.
    """
    records = judged_records(matrix.labels, seed, resamples)
    columns = zip(matrix.names, matrix.values.T, strict=True)
    found = [
        replace(separability_of(records, name, values, records.centred_values(values)), gears=matrix.gears)
        for name, values in columns
    ]
    return by_strength(found)


def by_strength(found: Iterable[Separability]) -> list[Separability]:
    """Return indicators, the strongest first."""
    return sorted(found, key=lambda entry: (-entry.strength, entry.feature))


def separability_of(records: JudgedRecords, name: str, values: np.ndarray, ranks: CentredRanks) -> Separability:
    """Return the separability of one column, (records,), whose centred ranks are given."""
    labels, defined = records.labels, np.isfinite(values)
    healthy = labels["fault"] == HEALTHY
    change = values[records.pairs.rows] - values[records.pairs.partners]
    auc, samples, same = {}, {}, {}
    for state in records.states:
        rows = np.flatnonzero(defined & (healthy | (labels["state"] == state)))
        weights, specimen = records.weights[:, rows], labels["specimen_id"][rows]
        samples[state] = weighted_auc(values[rows], ~healthy[rows], weights, specimen)
        auc[state] = records.interval(samples[state], rows)
        kept = np.isfinite(change) & (labels["state"][records.pairs.rows] == state)
        same[state] = shares_above(change[kept], records.weights[:, records.pairs.rows[kept]])
    rows = np.flatnonzero(defined)
    correlation = rank_correlation(ranks, records.centred("damaged_area_mm2", rows))
    direction = _sign([own[0] for own in same.values()]) or _sign([found.value for found in auc.values()])
    spearman = records.interval(correlation, rows)
    return Separability(name, auc, spearman, float(np.mean(defined)), direction, samples, same)


def _sign(shares: Sequence[float]) -> int:
    """Return which side of 0.5 the shares lie on together, 0 where that is not known."""
    return int(np.sign(round(sum(share - 0.5 for share in shares if math.isfinite(share)), 12)))


def best_by_state(found: Sequence[Separability]) -> dict[str, Separability]:
    """Return by state the indicator of the largest AUC, turned by its direction; states without any are left out."""
    best: dict[str, Separability] = {}
    for entry in found:
        for state in entry.auc:
            area = entry.turned(state).value
            if math.isfinite(area) and (state not in best or area > best[state].turned(state).value):
                best[state] = entry
    return best


def rank_correlation(first: CentredRanks, second: CentredRanks) -> np.ndarray:
    """Return Spearman's rank correlation for every row of weights, (b,), from ranks of the same records and weights.

    NaN where one side does not vary.
    """
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((first.weighted * second.ranks).sum(axis=1) / np.sqrt(first.spread * second.spread))


DEGREE = 2
"""Speed, load and noise enter as a parabola: amplitudes pass resonances."""

DETECTION_SHARES = {"a50": 0.5, "a90": 0.9}
SIZES = {"area_mm2": "damaged_area_mm2", "profile_mm": "damage_profile_length_mm"}


def cohens_d(values: np.ndarray, positive: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return (mean of positives - mean of the rest) / pooled standard deviation, (b,); NaN where nothing varies.

    Parameters
    ----------
    values : (n,) float64
        Without NaN.
    positive : (n,) bool
        Which records belong to the second group.
    weights : (b, n) float64
        Weights of the records.
    """
    parts = [_mean_and_variance(values[group], weights[:, group]) for group in (positive, ~positive)]
    (high, high_variance, high_weight), (low, low_variance, low_weight) = parts
    with np.errstate(invalid="ignore", divide="ignore"):
        pooled = (high_variance * high_weight + low_variance * low_weight) / (high_weight + low_weight - 2.0)
        return np.where(pooled > 0.0, (high - low) / np.sqrt(pooled), np.nan)


def paired_d(difference: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return mean / standard deviation of differences, (b,); NaN where they do not vary.

    Parameters
    ----------
    difference : (k,) float64
        After minus before, without NaN.
    weights : (b, k) float64
        Weights of the pairs.
    """
    mean, variance, weight = _mean_and_variance(difference, weights)
    with np.errstate(invalid="ignore", divide="ignore"):
        unbiased = variance * weight / (weight - 1.0)
        return np.where(unbiased > 0.0, mean / np.sqrt(unbiased), np.nan)


def _mean_and_variance(values: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = weights @ values / total
        variance = (weights * np.square(values[None, :] - mean[:, None])).sum(axis=1) / total
    return mean, variance, total


def explained_share(values: np.ndarray, cause: np.ndarray, *, groups: bool) -> float:
    """Return the adjusted share of rank variance that a cause explains, 0 to 1; NaN where it cannot be judged.

    Parameters
    ----------
    values : (n,) float64
        Indicator in healthy records, without NaN.
    cause : (n,)
        Number (speed ...) or group (sensor ...).
    groups : bool
        Whether the cause is a group; else a parabola is fitted.

    Notes
    -----
    1 - (1 - R^2)(n - 1)/(n - p - 1) with p fitted numbers besides the mean, cut off below zero. NaN with a single
    level of the cause, with n - p - 1 < 1, or where the indicator does not vary.
    """
    from scipy.stats import rankdata

    levels, index = np.unique(cause, return_inverse=True)
    fitted = levels.size - 1 if groups else min(DEGREE, levels.size - 1)
    free = values.size - fitted - 1
    if levels.size < 2 or free < 1:
        return math.nan
    ranks = rankdata(values)
    centred = ranks - ranks.mean()
    total = float(centred @ centred)
    if not total > 0.0:
        return math.nan
    if groups:
        model = (np.bincount(index, centred) / np.bincount(index))[index]
    else:
        scaled = (cause - cause.mean()) / np.ptp(cause)
        model = np.polyval(np.polyfit(scaled, centred, fitted), scaled)
    share = 1.0 - float(np.square(centred - model).sum()) / total
    return max(1.0 - (1.0 - share) * (values.size - 1) / free, 0.0)


@dataclass(frozen=True, slots=True)
class AssessmentSettings:
    """Seed and number of bootstrap resamples, and the rate of false alarms at which sizes are judged."""

    seed: int = 0
    resamples: int = RESAMPLES
    false_alarms: float = 0.05


def assessment(
    table: IndicatorTable, settings: AssessmentSettings | None = None, advance: Callable[[], None] | None = None
) -> list[IndicatorResult]:
    """Return the results of every indicator and channel, best separation between other specimens first.

    Parameters
    ----------
    table : IndicatorTable
        All indicators of the set.
    settings : AssessmentSettings, optional
        Default: `AssessmentSettings()`.
    advance : callable, optional
        Called after every indicator.
    """
    chosen = settings or AssessmentSettings()
    records = judged_records(table.matrix.labels, chosen.seed, chosen.resamples)
    found = []
    for column, name in enumerate(table.matrix.names):
        found.append(_one(records, name, table.matrix.values[:, column], chosen, table.matrix.gears))
        if advance:
            advance()
    _test(records, table.matrix, found)
    _add_sensor_shares(table, found)
    return sorted(found, key=lambda result: (_last_if_nan(result.score_others.value), result.column))


def _one(
    records: JudgedRecords, name: str, values: np.ndarray, settings: AssessmentSettings, gears: GearNames
) -> IndicatorResult:
    indicator, channel = name.split("__", 1)
    ranks = records.centred_values(values)
    judged = separability_of(records, name, values, ranks)
    direction = judged.direction or 1
    rows = np.flatnonzero(np.isfinite(values))
    loss = records.centred("mesh_stiffness_loss", rows)
    stiffness = records.interval(rank_correlation(ranks, loss), rows)
    before, after = records.steps
    rise = values[after] - values[before]
    kept = np.isfinite(rise)
    steps = monotonicity(rise[kept], records.weights[:, after[kept]])
    result = IndicatorResult(
        name, indicator, channel, direction,
        _other_specimens(records, values, judged), _same_specimen(records, values, judged),
        _score(records, list(judged.samples.values()), direction),
        _score(records, list(judged.same.values()), direction),
        judged.spearman, stiffness, records.interval(steps, after[kept]), judged.defined_share, gears,
    )  # fmt: skip
    result.sensitivity = _sensitivity(records.labels, values, channel)
    result.detectable, result.smallest_size = _detectable(records, values * direction, settings.false_alarms)
    return result


def _other_specimens(records: JudgedRecords, values: np.ndarray, judged: Separability) -> dict[str, StateResult]:
    """Return each state against all healthy records."""
    found = {}
    for state, area in judged.auc.items():
        groups = _against_healthy(records, values, state)
        rows = np.sort(np.concatenate(groups))
        effect = cohens_d(values[rows], records.labels["fault"][rows] != HEALTHY, records.weights[:, rows])
        found[state] = StateResult(area, records.interval(effect, rows))
    return found


def _against_healthy(records: JudgedRecords, values: np.ndarray, state: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of healthy records and of a state in which the indicator is defined."""
    healthy, defined = records.labels["fault"] == HEALTHY, np.isfinite(values)
    damaged = ~healthy & (records.labels["state"] == state)
    return np.flatnonzero(defined & healthy), np.flatnonzero(defined & damaged)


def _same_specimen(records: JudgedRecords, values: np.ndarray, judged: Separability) -> dict[str, StateResult]:
    """Return each state against the specimen's own healthy record."""
    found = {}
    for state, share in judged.same.items():
        rows, difference = _changes(records, values, state)
        effect = paired_d(difference, records.weights[:, rows])
        found[state] = StateResult(records.interval(share, rows), records.interval(effect, rows))
    return found


def _changes(records: JudgedRecords, values: np.ndarray, state: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of a state that have a healthy partner, and how far the indicator lies above it."""
    pairs = records.pairs
    change = values[pairs.rows] - values[pairs.partners]
    kept = np.isfinite(change) & (records.labels["state"][pairs.rows] == state)
    return pairs.rows[kept], change[kept]


def _score(records: JudgedRecords, samples: list[np.ndarray], direction: int) -> Interval:
    """Return the mean separation over the states, turned by the direction."""
    if not samples:
        return UNDEFINED
    mean = np.mean(samples, axis=0)
    return records.interval(0.5 + direction * (mean - 0.5), np.arange(records.weights.shape[1]))


def _test(records: JudgedRecords, matrix: FeatureMatrix, found: list[IndicatorResult]) -> None:
    """Add the p-values of both designs, adjusted for all indicators, channels and states."""
    values = dict(zip(matrix.names, matrix.values.T, strict=True))
    specimen = records.labels["specimen_id"]
    others = []
    for entry in found:
        for state in entry.others:
            healthy, damaged = _against_healthy(records, values[entry.column], state)
            means = [specimen_means(values[entry.column][rows], specimen[rows]) for rows in (healthy, damaged)]
            others.append((means[0], means[1]))
    changes = [_changes(records, values[entry.column], state) for entry in found for state in entry.same]
    same = [specimen_means(change, specimen[rows]) for rows, change in changes]
    for design, p_values in (("others", two_sample_p(others)), ("same", paired_p(same))):
        results = [result for entry in found for result in getattr(entry, design).values()]
        adjusted = zip(results, p_values, holm(p_values), false_discovery(p_values), strict=True)
        for result, p_value, strict, mild in adjusted:
            result.p_value, result.holm, result.false_discovery = float(p_value), float(strict), float(mild)


def _sensitivity(labels: dict[str, np.ndarray], values: np.ndarray, channel: str) -> dict[str, float]:
    """Return what explains the indicator in the healthy records of this channel."""
    rows = np.flatnonzero(np.isfinite(values) & (labels["fault"] == HEALTHY))
    causes = {"speed": "speed_hz", "load": "torque_nm", "noise": f"snr_{channel}_db", "specimen": "specimen_id"}
    found = dict.fromkeys(causes, math.nan)
    for cause, label in causes.items():
        if label not in labels or not rows.size:
            continue
        usable = rows[np.isfinite(labels[label][rows])]
        if usable.size:
            found[cause] = explained_share(values[usable], labels[label][usable], groups=cause == "specimen")
    return found


def _add_sensor_shares(table: IndicatorTable, found: list[IndicatorResult]) -> None:
    """Add what the sensor explains, over the healthy records of all channels together; one number per indicator."""
    healthy = table.matrix.labels["fault"] == HEALTHY
    by_name = {result.column: result for result in found}
    place = {name: column for column, name in enumerate(table.matrix.names)}
    for indicator in dict.fromkeys(result.indicator for result in found):
        columns = [(c, f"{indicator}__{c}") for c in table.channels if f"{indicator}__{c}" in place]
        values = np.concatenate([table.matrix.values[healthy, place[name]] for _, name in columns])
        sensor = np.repeat([channel for channel, _ in columns], int(healthy.sum()))
        kept = np.isfinite(values)
        share = explained_share(values[kept], sensor[kept], groups=True) if kept.any() else math.nan
        for _, name in columns:
            by_name[name].sensitivity["sensor"] = share


def _detectable(
    records: JudgedRecords, values: np.ndarray, false_alarms: float
) -> tuple[dict[str, Interval], dict[str, float]]:
    """Return the smallest sizes found, and the size of the smallest group of damage, by design and kind of size.

    Between other specimens and, where healthy records are repeated, on the same one, from changes against its first.
    """
    pairs, fault = records.pairs, records.labels["fault"]
    designs = {"others": (values, fault == HEALTHY, np.arange(values.size))}
    if pairs.null_rows.size:
        after = np.concatenate([pairs.rows, pairs.null_rows])
        change = values[after] - values[np.concatenate([pairs.partners, pairs.null_partners])]
        designs["same"] = (change, np.arange(after.size) >= pairs.rows.size, after)
    found: dict[str, Interval] = {}
    smallest: dict[str, float] = {}
    for design, (judged, healthy, rows) in designs.items():
        kept = np.isfinite(judged)
        sizes = {size: records.labels[label][rows[kept]] for size, label in SIZES.items() if label in records.labels}
        weights = records.weights[:, rows[kept]]
        curves = detection_curves(judged[kept], healthy[kept], list(sizes.values()), weights, false_alarms)
        for size, curve in zip(sizes, curves, strict=True):
            smallest[f"{design}_{size}"] = float(curve.size[0]) if curve else math.nan
            for name, level in DETECTION_SHARES.items():
                found[f"{design}_{size}_{name}"] = size_interval(size_at(curve, level)) if curve else UNDEFINED
    return found, smallest


def size_interval(samples: np.ndarray) -> Interval:
    """Return size and limits; resamples that do not reach the share count as infinite."""
    tail = 0.5 * (1.0 - LEVEL)
    low, high = np.quantile(samples[1:], [tail, 1.0 - tail], method="nearest")
    return Interval(float(samples[0]), float(low), float(high))


def _last_if_nan(score: float) -> float:
    return -score if math.isfinite(score) else math.inf


def result_table(found: list[IndicatorResult]) -> pa.Table:
    """Return all results as a table, one row per indicator and channel, in the order of the ranking."""
    return pa.Table.from_pylist([{"rank": rank, **result.row()} for rank, result in enumerate(found, start=1)])
