"""Evaluation of every indicator in every channel of a set, in both designs, best first.

Intervals: 95 %, bootstrap over specimens. Nothing is trained; but the direction of each indicator is read from the same
specimens, and so is the place in the ranking: the best of many is optimistic, which the adjusted p-values account for.

Cohen's d between two groups and of paired differences, for every row of bootstrap weights.

Cliff's delta is 2 AUC - 1 and therefore not given again. Source: Cohen 1988, standard literature.

What moves an indicator in healthy records: share of variance that speed, load, sensor, noise, specimen explain.

Each cause alone, adjusted for its degrees of freedom, on ranks (so that one wild record does not decide). Causes may
share variance, so shares need not add up to one. Source: adjusted R^2 of a linear model, standard literature.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.ranking_table import IndicatorTable
from diagnostics.records.gear_train import GearNames
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.detectable_size import detection_curves, size_at
from diagnostics.statistics.evaluation import LEVEL, RESAMPLES, Interval
from diagnostics.statistics.indicator_result import UNDEFINED, IndicatorResult, StateResult
from diagnostics.statistics.judged_records import JudgedRecords, judged_records, monotonicity
from diagnostics.statistics.multiple_tests import false_discovery, holm, paired_p, specimen_means, two_sample_p
from diagnostics.statistics.separability import Separability, rank_correlation, separability_of

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
