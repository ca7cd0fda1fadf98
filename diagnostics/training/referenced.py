"""Classifiers that know a healthy record of the same gearbox, beside those that do not, on the same test records.

Features as logarithms, and minus the mean of healthy records of the same machine.

In logarithms a constant gain, and at every mesh line the gain of the transfer path, becomes a summand, which a
difference to the same machine's healthy state removes as far as speed and load are alike. Source: derived.

Which healthy records of the same gearbox a record is compared with, so that the choice itself tells nothing.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.base.progress import Stage
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import CLASS, HEALTHY
from diagnostics.statistics.comparison import Comparison, comparison
from diagnostics.statistics.evaluation import Predictions
from diagnostics.statistics.judgement import INDICATORS, NETWORK, NETWORK_REFERENCED, REFERENCED, Judged, judged
from diagnostics.training.baselines import FeatureClassifier, calibrated_classifier, train_classifier
from diagnostics.training.network_training import NetworkOptions, judge_network
from diagnostics.training.splits import SpecimenSplit

if TYPE_CHECKING:
    from diagnostics.training.average_rows import AveragedRecords

PLACE = ("specimen_id", "operating_point_id", "repeat")
"""Where a damaged record has its healthy twin."""

PAIRS = ((REFERENCED, INDICATORS), (NETWORK_REFERENCED, NETWORK), (NETWORK_REFERENCED, REFERENCED))
"""Differences that are told: what the reference is worth, and which classifier uses it better."""


def healthy_references(labels: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Return the rows that every record refers to: its specimen's healthy records but one; empty where there is none.

    A healthy record leaves itself out. A damaged one leaves out the first healthy record at its operating point and
    repeat, its twin, so that neither number nor nearness of the references tells the states apart. A damaged record
    without a twin has no reference: its references would stand farther away than those of any healthy record.

    Parameters
    ----------
    labels : mapping of str to (records,)
        Columns `specimen_id`, `fault`, `operating_point_id`, `repeat`, `state_id`, `record_id`.
    """
    healthy = labels["fault"] == HEALTHY
    order = np.lexsort((labels["record_id"], labels["state_id"]))
    own: dict[int, list[int]] = {}
    twin: dict[tuple[int, ...], int] = {}
    places = list(zip(*(labels[name].tolist() for name in PLACE), strict=True))
    for row in order[healthy[order]].tolist():
        own.setdefault(places[row][0], []).append(row)
        twin.setdefault(places[row], row)
    found = []
    for row, place in enumerate(places):
        left_out = row if healthy[row] else twin.get(place)
        rows = [] if left_out is None else [other for other in own[place[0]] if other != left_out]
        found.append(np.array(rows, dtype=np.int64))
    return found


def log_values(values: np.ndarray) -> np.ndarray:
    """Return natural logarithms, NaN where a feature is undefined or not positive."""
    positive = np.isfinite(values) & (values > 0.0)
    return np.where(positive, np.log(np.where(positive, values, 1.0)), np.nan)


def log_mean(values: np.ndarray) -> np.ndarray:
    """Return the mean of log features over records, (features,), NaN where no record defines one."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a feature that no record defines has no mean
        return np.asarray(np.nanmean(log_values(values), axis=0))


def healthy_referenced(matrix: FeatureMatrix) -> tuple[FeatureMatrix, np.ndarray]:
    """Return log features minus the mean of the references, for the records that have such, and which those are.

    Parameters
    ----------
    matrix : FeatureMatrix
        Features of a set.

    Returns
    -------
    FeatureMatrix
        The records with a reference.
    (records,) bool
        Which those are.
    """
    logs = log_values(matrix.values)
    references = healthy_references(matrix.labels)
    found, kept = np.full_like(logs, np.nan), np.array([rows.size > 0 for rows in references], dtype=bool)
    for row in np.flatnonzero(kept):
        found[row] = logs[row] - log_mean(matrix.values[references[row]])
    return replace(matrix, values=found).rows(kept), kept


def reference_speed_ratio(labels: Mapping[str, np.ndarray]) -> float:
    """Return the largest ratio, 1 or more, of the speeds of a record and of one it refers to; NaN without references.

    Parameters
    ----------
    labels : mapping of str to (records,)
        As of `healthy_references`, and `speed_hz`.
    """
    speed = np.log(labels["speed_hz"].astype(np.float64))
    ratios = [np.abs(speed[rows] - speed[k]).max() for k, rows in enumerate(healthy_references(labels)) if rows.size]
    return float(np.exp(max(ratios))) if ratios else np.nan


@dataclass(frozen=True, slots=True)
class Referenced:
    """Healthy-referenced classifiers.

    Attributes
    ----------
    classifier : FeatureClassifier
        Logistic regression on log indicators minus those of the gearbox's own healthy records.
    kept : (records,) bool
        Records that have such a reference.
    split : SpecimenSplit
        Of the kept records.
    judged : tuple of Judged
        On the kept test records: those that stand alone, and those with a reference.
    comparisons : tuple of Comparison
        Paired differences on these records.
    """

    classifier: FeatureClassifier
    kept: np.ndarray
    split: SpecimenSplit
    judged: tuple[Judged, ...]
    comparisons: tuple[Comparison, ...]


def referenced_classifiers(
    matrix: FeatureMatrix,
    split: SpecimenSplit,
    alone: list[Judged],
    averages: AveragedRecords | None,
    seed: int,
    options: NetworkOptions,
    stage: Stage,
) -> Referenced | None:
    """Return the healthy-referenced classifiers; None where the set has no second healthy record of its gearboxes.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records.
    split : SpecimenSplit
        Whose specimens are which.
    alone : list of Judged
        Classifiers without a reference, judged on all test records.
    averages : AveragedRecords, optional
        For the 1-D network; None leaves it out.
    seed : int
        Seeds networks and bootstrap.
    options : NetworkOptions
        Of the network.
    stage : Stage
        Told of every step.
    """
    differences, kept = healthy_referenced(matrix)
    part = replace(split, train=split.train[kept], validation=split.validation[kept], test=split.test[kept])
    if np.unique(differences.labels[CLASS][part.train]).size < 2 or not part.test.any():
        return None
    classifier = calibrated_classifier(train_classifier(differences, part, take_logarithms=False), differences, part)
    shown = kept[split.test]
    results = [_of_kept(found, shown, seed, split.healthy) for found in alone if found.name in (INDICATORS, NETWORK)]
    results.append(_judged_linear(classifier, differences, part, seed))
    if averages is not None:
        from diagnostics.training.average_rows import with_references

        places = np.flatnonzero(kept)
        rows = healthy_references(matrix.labels)
        beside = with_references(averages, places, [rows[place] for place in places])
        results.append(judge_network(NETWORK_REFERENCED, beside, differences, part, seed, options, stage)[1])
    return Referenced(classifier, kept, part, tuple(results), _comparisons(results, split.healthy, seed))


def _of_kept(found: Judged, shown: np.ndarray, seed: int, healthy: str | None) -> Judged:
    """Return a classifier judged on the shown ones of its test records; its probabilities are calibrated already."""
    every = found.predictions
    some = Predictions(every.classes, every.truth[shown], every.probability[shown], every.specimen[shown])
    return judged(found.name, some, 1.0, np.empty(0), found.details, seed, healthy)


def _judged_linear(classifier: FeatureClassifier, matrix: FeatureMatrix, split: SpecimenSplit, seed: int) -> Judged:
    found = replace(classifier, temperature=1.0).predict(matrix.rows(split.test))
    details = {"features": len(classifier.features), "strength": classifier.strength, "note": classifier.note}
    return judged(REFERENCED, found, classifier.temperature, np.empty(0), details, seed, split.healthy)


def _comparisons(results: list[Judged], healthy: str | None, seed: int) -> tuple[Comparison, ...]:
    by_name = {found.name: found.predictions for found in results}
    return tuple(
        comparison(pair, by_name[pair[0]], by_name[pair[1]], seed, healthy)
        for pair in PAIRS
        if set(pair) <= set(by_name)
    )
