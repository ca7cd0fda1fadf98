"""How well damage is detected on specimens that were neither trained on nor seen healthy: AUC by state.

Logistic regression on standardised {log RMS, kurtosis, FM4, log sideband index}, averaged over the channels. In every
repeat the specimens are dealt into two halves: healthy records come from one, faulty ones from the other, so that no
specimen serves both classes; folds hold whole specimens of both halves. The AUC of the held-out scores is averaged over
repeats; its interval resamples specimens. Paired: differences from a healthy record of the same specimen at the
same operating point, energy ratio and sideband energy ratio added. Source: standard literature; the scheme derived.

Single indicators: the best of hundreds is chosen on the gearboxes that it is judged on, so its AUC is optimistic. A
second number is not: gearboxes are dealt into two halves, one chooses indicator and direction, the other judges; mean
over both ways of ten deals. AUC and direction are those of `indicator_statistics`. Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from diagnostics.audit.measured_set import MeasuredSet, reference_records
from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.evaluation import Entry, pooled_scores
from diagnostics.records.state_classes import HEALTHY, damage_kind
from diagnostics.statistics.evaluation import (
    UNDEFINED,
    Interval,
    area_interval,
    bootstrap_weights,
    fewest_gearboxes,
    mean_of_defined,
    weighted_auc,
)
from diagnostics.statistics.indicator_statistics import best_by_state, separability

LEVELS, PLAIN, ADDED = ("rms", "sideband_index"), ("kurtosis", "fm4"), ("energy_ratio", "sideband_ratio")
"""Indicators, those of mesh harmonics of the first one."""
REPEATS, FOLDS, RESAMPLES = 10, 5, 200
FEWEST_SPECIMENS = 4
SIZES = ("damaged_area_mm2", "damaged_area_share", "damage_profile_length_mm")
TARGETS = (0.75, 0.85)


@dataclass(frozen=True, slots=True)
class Detectability:
    """AUC of one state against healthy, with its damage: kind of fault and means of the size labels.

    `basis` is what the detector chose most often, such as a band; `tried` how many columns it chose from or weighed.
    """

    state: str
    fault: str
    sizes: dict[str, float]
    auc: Interval
    specimens: int
    basis: str = ""
    tried: int = 0

    @property
    def area_mm2(self) -> float:
        """Mean damaged area: pits and spalls grow in area, whether or not the longest of them grows."""
        return self.sizes[SIZES[0]]


def features(measured: MeasuredSet, *, paired: bool = False) -> np.ndarray:
    """Return the features averaged over channels, (records, 4), or differences from the reference, (records, 6).

    Of planetary sets every member has them; those that no record defines are left out.
    """
    columns = [*(_log(values) for values in _taken(measured, LEVELS)), *_taken(measured, PLAIN)]
    if paired:
        columns += _taken(measured, ADDED)
    found = np.stack([mean_of_defined(column, axis=1) for column in columns], axis=1)
    if not paired:
        return found
    reference = reference_records(measured)
    return np.where((reference >= 0)[:, None], found - found[reference], np.nan)


def _taken(measured: MeasuredSet, names: Sequence[str]) -> list[np.ndarray]:
    values, of_set = measured.values, measured.gears[0].planetary
    harmonic = {"sideband_ratio": {"harmonic": 1}}
    found = [column for name in names for column in measured.columns_of(name, **harmonic.get(name, {}))]
    return [values[column] for column in found if not of_set or np.isfinite(values[column]).any()]


def waveform_change(measured: MeasuredSet) -> np.ndarray:
    """Return log10 of the rms of (averaged waveform - that of the reference) over the reference's, (records, 1)."""
    found = np.full(len(measured.waveforms), np.nan)
    for record, reference in enumerate(reference_records(measured).tolist()):
        if reference >= 0:
            pairs = zip(measured.waveforms[record], measured.waveforms[reference], strict=True)
            changes = [change for own, other in pairs if math.isfinite(change := _change(own, other))]
            found[record] = float(np.mean(changes)) if changes else math.nan
    return found[:, None]


def _change(own: np.ndarray, other: np.ndarray) -> float:
    orders = min(own.size, other.size)
    if orders < 2:
        return math.nan
    # from order 1: the mean of an accelerometer is not a vibration
    left = float(np.linalg.norm(own[1:orders] - other[1:orders])) / float(np.linalg.norm(other[1:orders]))
    return math.log10(left) if left > 0.0 else math.nan


def _log(values: np.ndarray) -> np.ndarray:
    return np.log10(np.where(values > 0, values, np.nan))


def detections(measured: MeasuredSet, values: np.ndarray, seed: int = 0) -> list[Detectability]:
    """Return the detection of every damaged state, by fault and damaged area.

    Parameters
    ----------
    measured : MeasuredSet
        The set.
    values : (records, features) float64
        What the classifier takes; records with an undefined value are left out.
    seed : int
        Seed of halves, folds and bootstrap.
    """
    usable = np.isfinite(values).all(axis=1)
    labels, found = measured.labels, []
    for state in dict.fromkeys(labels["state"][~measured.healthy].tolist()):
        chosen = usable & (measured.healthy | (labels["state"] == state))
        specimen, positive = labels["specimen_id"][chosen], ~measured.healthy[chosen]
        smaller = fewest_gearboxes(positive, specimen)
        count = int(np.unique(specimen).size)
        auc = (
            area_interval(state_auc(values[chosen], positive, specimen, seed), smaller)
            if smaller >= FEWEST_SPECIMENS
            else UNDEFINED
        )
        rows = labels["state"] == state
        sizes = damage_sizes(measured, rows)
        found.append(Detectability(state, damage_kind(labels, rows), sizes, auc, count, "", int(values.shape[1])))
    return in_order(found)


def damage_sizes(measured: MeasuredSet, rows: np.ndarray) -> dict[str, float]:
    """Return the means of the size labels that the set has over some rows."""
    return {name: float(np.mean(measured.labels[name][rows])) for name in SIZES if name in measured.labels}


def in_order(entries: list[Detectability]) -> list[Detectability]:
    """Return detections by fault and damaged area."""
    return sorted(entries, key=lambda entry: (entry.fault, entry.area_mm2))


def state_auc(values: np.ndarray, positive: np.ndarray, specimen: np.ndarray, seed: int) -> np.ndarray:
    """Return the AUC averaged over repeats: row 0 of the sample itself, the others of resampled specimens."""
    weights = bootstrap_weights(specimen, seed, RESAMPLES)
    areas = []
    for repeat in range(REPEATS):
        half, fold = dealt(specimen, seed, repeat)
        used = half == positive
        entry = Entry("", BalancedLogistic, values[used], used[used])
        score = pooled_scores(entry, positive[used], specimen[used], fold[used])[0]
        areas.append(weighted_auc(score, positive[used], weights[:, used], specimen[used]))
    return mean_of_defined(np.array(areas))


def dealt(specimen: np.ndarray, seed: int, repeat: int) -> tuple[np.ndarray, np.ndarray]:
    """Return for every record whether its specimen serves the faulty class, and its fold."""
    unique, index = np.unique(specimen, return_inverse=True)
    place = generator(seed, Purpose.HALVES, repeat).permutation(unique.size)
    return (place % 2 == 1)[index], (place // 2 % FOLDS)[index]


class BalancedLogistic:
    """Logistic regression on standardised columns, both classes of equal weight; scores are log odds."""

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> BalancedLogistic:  # noqa: ARG002
        """Fit to X (n, columns) and y (n,)."""
        from sklearn import config_context
        from sklearn.linear_model import LogisticRegression

        spread = X.std(axis=0)
        self.mean, self.spread = X.mean(axis=0), np.where(spread > 0.0, spread, 1.0)
        # thousands of fits of a few records: a pipeline and its checks cost more than the fits
        with config_context(assume_finite=True, skip_parameter_validation=True):
            model = LogisticRegression(class_weight="balanced", max_iter=1000)
            self.model = model.fit((X - self.mean) / self.spread, y)
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the log odds, (m,)."""
        return np.asarray(((X - self.mean) / self.spread) @ self.model.coef_[0] + self.model.intercept_[0])


@dataclass(frozen=True, slots=True)
class DetectedArea:
    """Damaged area [mm²] at which an AUC is reached; an upper bound where the smallest damage exceeds it already."""

    area_mm2: float
    is_upper_bound: bool


def area_at(entries: list[Detectability], target: float) -> dict[str, DetectedArea | None]:
    """Return by fault the damaged area at which the AUC first reaches a target, linear between states; None if never.

    A fault without a damaged area, or with two states of one area, is left out.

    Parameters
    ----------
    entries : list of Detection
        Ordered by size.
    target : float
        AUC.
    """
    judged = [entry for entry in entries if math.isfinite(entry.auc.value) and entry.area_mm2 > 0.0]
    ladders = {fault: [entry for entry in judged if entry.fault == fault] for fault in (e.fault for e in entries)}
    return {fault: _first_reaching(found, target) for fault, found in ladders.items() if differ_in_area(found)}


def differ_in_area(entries: list[Detectability]) -> bool:
    """Return whether states differ in damaged area, so that they can be ranked by it."""
    areas = sorted(entry.area_mm2 for entry in entries)
    return all(high > low * (1.0 + 1e-6) for low, high in pairwise(areas))


def _first_reaching(entries: list[Detectability], target: float) -> DetectedArea | None:
    first = next((place for place, entry in enumerate(entries) if entry.auc.value >= target), None)
    if first is None:
        return None
    area, auc = entries[first].area_mm2, entries[first].auc.value
    if first == 0:
        return DetectedArea(area, True)
    below, auc_below = entries[first - 1].area_mm2, entries[first - 1].auc.value
    share = (target - auc_below) / (auc - auc_below)
    return DetectedArea(below + share * (area - below), False)


DEALS = 10


@dataclass(frozen=True, slots=True)
class BestIndicator:
    """The best single indicator for one state.

    Attributes
    ----------
    column : str
        `<indicator>__<channel>`.
    auc : Interval
        Its AUC, turned; chosen on the same gearboxes, so optimistic.
    held_out : float
        AUC of the best indicator on gearboxes that did not choose it; NaN with too few gearboxes.
    tried : int
        How many columns it is the best of.
    """

    column: str
    auc: Interval
    held_out: float
    tried: int


def best_indicators(matrix: FeatureMatrix, seed: int = 0) -> dict[str, BestIndicator]:
    """Return the best single indicator of every damaged state.

    Parameters
    ----------
    matrix : FeatureMatrix
        All indicators of all records.
    seed : int
        Seed of deals and bootstrap.
    """
    found = separability(matrix, seed, RESAMPLES)
    tried = sum(any(math.isfinite(area.value) for area in entry.auc.values()) for entry in found)
    weights = dealt_halves(matrix.labels["specimen_id"], seed)
    return {
        state: BestIndicator(entry.feature, entry.turned(state), held_out_auc(matrix, state, weights), tried)
        for state, entry in best_by_state(found).items()
    }


def dealt_halves(specimen: np.ndarray, seed: int) -> np.ndarray:
    """Return which records belong to each half of the gearboxes, (2 deals, records); rows 2k, 2k + 1 are one deal."""
    unique, index = np.unique(specimen, return_inverse=True)
    rows = []
    for deal in range(DEALS):
        half = generator(seed, Purpose.HALVES, deal).permutation(unique.size) % 2 == 1
        rows += [half[index], ~half[index]]
    return np.array(rows, dtype=np.float64)


def held_out_auc(matrix: FeatureMatrix, state: str, halves: np.ndarray) -> float:
    """Return the AUC of the indicator that is best on one half, with its direction there, on the other half.

    Parameters
    ----------
    matrix : FeatureMatrix
        All indicators of all records.
    state : str
        Against the healthy records.
    halves : (2 deals, records) float64
        As of `dealt_halves`.
    """
    labels = matrix.labels
    chosen = (labels["fault"] == HEALTHY) | (labels["state"] == state)
    specimen, positive = labels["specimen_id"][chosen], labels["state"][chosen] == state
    if fewest_gearboxes(positive, specimen) < FEWEST_SPECIMENS:
        return math.nan
    areas = np.stack(
        [_areas(values, positive, halves[:, chosen], specimen) for values in matrix.values[chosen].T], axis=0
    )
    return _mean_of_the_chosen(areas)


def _areas(values: np.ndarray, positive: np.ndarray, weights: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the AUC of one column on every half; NaN where it is undefined in a record."""
    if not np.isfinite(values).all():
        return np.full(len(weights), np.nan)
    return weighted_auc(values, positive, weights, specimen)


def _mean_of_the_chosen(areas: np.ndarray) -> float:
    """Return the mean, over halves, of the AUC (columns, halves) of the column that the other half chose."""
    found = []
    for half in range(areas.shape[1]):
        other = areas[:, half ^ 1]
        if not np.isfinite(other).any():
            continue
        best = int(np.nanargmax(np.abs(other - 0.5)))
        area = areas[best, half]
        found.append(area if other[best] > 0.5 else 1.0 - area)
    defined = [area for area in found if math.isfinite(area)]
    return float(np.mean(defined)) if defined else math.nan
