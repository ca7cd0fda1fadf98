"""Alarms for damage: best single indicator, a classifier and a network, alone and beside healthy records.

Indicator and classifier are judged on every gearbox: gearboxes are dealt into folds, and what judges a fold was chosen
or trained on the others. The penalty of the classifier is fixed, so nothing is chosen on what is judged. Folds take
different indicators; their scores become comparable as distances from the healthy records of the other folds. Networks
are judged on the test gearboxes only, since training them again for every fold costs minutes. Source: nested
cross-validation, standard literature; the scheme derived.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from diagnostics.attacks.column_attackers import column_auc
from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.detection import damage_score
from diagnostics.statistics.detector import Detector, judged_detector
from diagnostics.statistics.judgement import CIRCULAR, CIRCULAR_REFERENCED, NETWORK, TITLES, VALIDATION_AUROC, Judged
from diagnostics.training.baselines import fitted_classifier
from diagnostics.training.log_features import healthy_referenced
from diagnostics.training.training import Training

FOLDS, DEALT = 5, 2000
"""Folds of gearboxes, and the owner of the generator that deals them: others have other owners."""

FEWEST_SPECIMENS = 4
INDICATOR, CLASSIFIER, NETWORKS = "best single indicator", "logistic regression on all indicators", "network"


@dataclass(frozen=True, slots=True)
class Detectors:
    """Judged detectors, by family, alone and beside healthy records of the same gearbox; a family may be missing."""

    alone: dict[str, Detector]
    referenced: dict[str, Detector]

    @property
    def strongest(self) -> Detector | None:
        """The strongest of those that are judged on all gearboxes without a reference."""
        return _strongest(self.alone)

    @property
    def strongest_referenced(self) -> Detector | None:
        """The same beside a healthy record."""
        return _strongest(self.referenced)


def _strongest(found: dict[str, Detector]) -> Detector | None:
    judged = [detector for family, detector in found.items() if family != NETWORKS]
    return max(judged, key=lambda detector: detector.every.value, default=None)


@single_thread
def judged_detectors(matrix: FeatureMatrix, training: Training | None, seed: int) -> Detectors:
    """Judge all detectors of a set.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records of the one table of the set.
    training : Training, optional
        Its networks are judged too.
    seed : int
        Of folds and resampled gearboxes.
    """
    differences, kept = healthy_referenced(matrix)
    alone = _cross_fitted(matrix, seed, referenced=False)
    referenced = _cross_fitted(differences, seed, referenced=True)
    if training is not None:
        test = training.split.test
        alone |= _network(training.judged, (NETWORK, CIRCULAR), matrix.rows(test), training, seed)
        if training.referenced:
            rows = matrix.rows(test & training.referenced.kept)
            referenced |= _network(training.referenced.judged, (CIRCULAR_REFERENCED,), rows, training, seed)
    return Detectors(alone, referenced if kept.any() else {})


def _network(
    judged: tuple[Judged, ...], names: tuple[str, ...], rows: FeatureMatrix, training: Training, seed: int
) -> dict[str, Detector]:
    """Return the network that validation gearboxes choose, on its test records; empty without any."""
    found = [entry for entry in judged if entry.name in names]
    if not found or training.split.healthy is None:
        return {}
    best = max(found, key=lambda entry: entry.details.get(VALIDATION_AUROC, 0.0))
    score = damage_score(best.predictions, training.split.healthy)
    referenced = best.name == CIRCULAR_REFERENCED
    detector = judged_detector(TITLES[best.name], score, rows.labels, seed, referenced=referenced)
    return {NETWORKS: detector} if detector else {}


def _cross_fitted(matrix: FeatureMatrix, seed: int, *, referenced: bool) -> dict[str, Detector]:
    """Return indicator and classifier; empty with too few gearboxes of either side."""
    labels = matrix.labels
    healthy = labels["fault"] == HEALTHY
    if min(_count(labels["specimen_id"][side]) for side in (healthy, ~healthy)) < FEWEST_SPECIMENS:
        return {}
    fold = dealt(labels["specimen_id"], seed)
    single, chosen = indicator_scores(matrix.values, ~healthy, fold)
    judged = {}
    if chosen.size:
        basis = matrix.names[Counter(chosen.tolist()).most_common(1)[0][0]]
        judged[INDICATOR] = judged_detector(INDICATOR, single, labels, seed, referenced=referenced, basis=basis)
    score = classifier_scores(matrix, ~healthy, fold, take_logarithms=not referenced)
    judged[CLASSIFIER] = judged_detector(CLASSIFIER, score, labels, seed, referenced=referenced)
    return {family: detector for family, detector in judged.items() if detector}


def _count(specimen: np.ndarray) -> int:
    return int(np.unique(specimen).size)


def dealt(specimen: np.ndarray, seed: int) -> np.ndarray:
    """Return the fold of every record, (n,) int; a gearbox is in one fold."""
    unique, index = np.unique(specimen, return_inverse=True)
    place = generator(seed, Purpose.FOLDS, DEALT).permutation(unique.size)
    return np.asarray(place[index.ravel()] % min(FOLDS, unique.size))


def _held(fold: np.ndarray) -> Iterator[np.ndarray]:
    yield from (fold == number for number in np.unique(fold))


def indicator_scores(values: np.ndarray, damaged: np.ndarray, fold: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the score of every record by the column that is best on the other folds, and these columns.

    Parameters
    ----------
    values : (n, columns) float64
        Columns that are undefined in a record are not taken.
    damaged : (n,) bool
    fold : (n,) int

    Returns
    -------
    (n,) float64
        Distance from the median of the other folds' healthy records over their interquartile range, turned so that
        damage is large.
    (folds,) int
        Columns; empty where none is defined throughout.
    """
    usable = np.flatnonzero(np.isfinite(values).all(axis=0))
    score, chosen = np.zeros(damaged.size), []
    if not usable.size:
        return score, np.empty(0, np.int64)
    for held in _held(fold):
        area = column_auc(values[np.ix_(~held, usable)], damaged[~held])
        best = int(np.argmax(np.abs(area - 0.5)))
        column = values[:, usable[best]]
        low, middle, high = np.quantile(column[~held & ~damaged], [0.25, 0.5, 0.75])
        turned = 1.0 if area[best] >= 0.5 else -1.0
        score[held] = turned * (column[held] - middle) / ((high - low) or 1.0)
        chosen.append(int(usable[best]))
    return score, np.array(chosen)


def classifier_scores(
    matrix: FeatureMatrix, damaged: np.ndarray, fold: np.ndarray, *, take_logarithms: bool
) -> np.ndarray:
    """Return the probability of damage of every record, (n,), by logistic regression on the other folds."""
    score, truth = np.zeros(damaged.size), damaged.astype(np.int64)
    for held in _held(fold):
        rest = matrix.rows(~held)
        model = fitted_classifier(rest, truth[~held], (HEALTHY, "damaged"), take_logarithms=take_logarithms)
        score[held] = model.probability(matrix.values[held])[:, 1]
    return score
