"""Alarms for damage: best single indicator, classifiers and a network, alone and beside healthy records.

Indicator and classifiers are judged on every gearbox: gearboxes are dealt into folds, and what judges a fold was chosen
or trained on the others. Penalty and number of trees are fixed, so nothing is chosen on what is judged; neither is
which of them is the strongest (`fold_scores`). Folds take different indicators; their scores become comparable as
distances from the healthy records of the other folds. Networks are judged on the test gearboxes only, since training
them again for every fold costs minutes. Source: nested cross-validation, standard literature; the scheme derived.

Scores of records by what was fitted on other gearboxes, and the honest choice among several ways to score.

Gearboxes are dealt into folds. A way to score is fitted on all folds but one and scores that one. Which of several ways
is the strongest would be optimistic if it were seen on the scores that are reported; so for every fold the choice is
made among fits that saw neither that fold nor the one that they score (nested cross-validation, standard literature;
one fit serves both folds that it leaves out: derived).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.detection import damage_score
from diagnostics.statistics.detector import Detector, judged_detector
from diagnostics.statistics.evaluation import column_auc
from diagnostics.statistics.judgement import NETWORK, NETWORK_REFERENCED, TITLES, Judged
from diagnostics.training.baselines import FeatureClassifier, fitted_classifier
from diagnostics.training.boosting import fitted_boosting
from diagnostics.training.referenced import healthy_referenced
from diagnostics.training.training import Training

FOLDS, DEALT = 5, 2000
"""Folds of gearboxes, and the owner of the generator that deals them: others have other owners."""

Fitted = Callable[[FeatureMatrix], np.ndarray]
"""Gives the score of every record, large for damage."""

Scorer = Callable[[FeatureMatrix, np.ndarray], Fitted]
"""Fits to records and to whether they are damaged, (n,) bool."""

FEWEST_SPECIMENS = 4
INDICATOR, CLASSIFIER = "best single indicator", "logistic regression on all indicators"
BOOSTED, NETWORKS, CHOSEN = "gradient boosting on all indicators", "network", "chosen"
CHOICE = "chosen by the other gearboxes"
SMALLEST = 1e-12
"""Probability below which odds are cut off."""


def dealt(specimen: np.ndarray, seed: int) -> np.ndarray:
    """Return the fold of every record, (n,) int; a gearbox is in one fold."""
    unique, index = np.unique(specimen, return_inverse=True)
    place = generator(seed, Purpose.FOLDS, DEALT).permutation(unique.size)
    return np.asarray(place[index.ravel()] % min(FOLDS, unique.size))


def held_out(fold: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the records of each fold as a mask, (n,) bool."""
    yield from (fold == number for number in np.unique(fold))


def fold_scores(scorer: Scorer, matrix: FeatureMatrix, damaged: np.ndarray, fold: np.ndarray) -> np.ndarray:
    """Return the score of every record, (n,), by what was fitted on the other folds."""
    score = np.zeros(damaged.size)
    for held in held_out(fold):
        score[held] = _fitted(scorer, matrix, damaged, ~held)(matrix.rows(held))
    return score


def _fitted(scorer: Scorer, matrix: FeatureMatrix, damaged: np.ndarray, rows: np.ndarray) -> Fitted:
    """Fit to these records; where all are healthy or all damaged nothing is learnt, and all scores are alike."""
    if np.unique(damaged[rows]).size < 2:
        return lambda other: np.zeros(other.values.shape[0])
    return scorer(matrix.rows(rows), damaged[rows])


def inner_scores(scorer: Scorer, matrix: FeatureMatrix, damaged: np.ndarray, fold: np.ndarray) -> np.ndarray:
    """Return scores that know nothing of a fold, (folds, n).

    Row k has a score of every record outside fold k, by what saw neither fold k nor the fold of the record; NaN in
    fold k.
    """
    numbers = np.unique(fold)
    found = np.full((numbers.size, damaged.size), np.nan)
    for a, b in combinations(range(numbers.size), 2):
        first, second = fold == numbers[a], fold == numbers[b]
        rest = ~(first | second)
        fitted = _fitted(scorer, matrix, damaged, rest)
        found[a, second], found[b, first] = fitted(matrix.rows(second)), fitted(matrix.rows(first))
    return found


def chosen_scores(
    outer: Mapping[str, np.ndarray], inner: Mapping[str, np.ndarray], damaged: np.ndarray, fold: np.ndarray
) -> tuple[np.ndarray, list[str]]:
    """Return scores of every record by the way that is strongest on the other folds, and its name by fold.

    Parameters
    ----------
    outer : mapping of str to (n,) float64
        What `fold_scores` returned for each way.
    inner : mapping of str to (folds, n) float64
        What `inner_scores` returned.
    damaged : (n,) bool
    fold : (n,) int

    Returns
    -------
    (n,) float64
        The scores of one way where all folds choose the same; else distances from the median of the inner scores of
        healthy records over their interquartile range, which makes different ways comparable.
    list of str
    """
    names = []
    for row, held in enumerate(held_out(fold)):
        areas = {name: column_auc(scores[row, ~held][:, None], damaged[~held])[0] for name, scores in inner.items()}
        names.append(max(areas, key=lambda name: np.nan_to_num(areas[name])))
    if len(set(names)) == 1:
        return outer[names[0]], names
    score = np.zeros(damaged.size)
    for row, held in enumerate(held_out(fold)):
        healthy = inner[names[row]][row, ~held & ~damaged]
        score[held] = distance(outer[names[row]][held], healthy)
    return score, names


def distance(values: np.ndarray, healthy: np.ndarray) -> np.ndarray:
    """Return how far values lie above the median of healthy ones, in interquartile ranges of these."""
    low, middle, high = np.quantile(healthy, [0.25, 0.5, 0.75])
    return np.asarray((values - middle) / ((high - low) or 1.0))


@dataclass(frozen=True, slots=True)
class Detectors:
    """Judged detectors, by family, alone and beside healthy records of the same gearbox; a family may be missing."""

    alone: dict[str, Detector]
    referenced: dict[str, Detector]

    @property
    def strongest(self) -> Detector | None:
        """The one that the other gearboxes choose, of those that are judged on all gearboxes without a reference."""
        return self.alone.get(CHOSEN)

    @property
    def strongest_referenced(self) -> Detector | None:
        """The same beside a healthy record."""
        return self.referenced.get(CHOSEN)


@single_thread()
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
        alone |= _network(training.judged, NETWORK, matrix.rows(test), training, seed)
        if training.referenced:
            rows = matrix.rows(test & training.referenced.kept)
            referenced |= _network(training.referenced.judged, NETWORK_REFERENCED, rows, training, seed)
    return Detectors(alone, referenced if kept.any() else {})


def _network(
    judged: tuple[Judged, ...], name: str, rows: FeatureMatrix, training: Training, seed: int
) -> dict[str, Detector]:
    """Return the network of this name on its test records; empty without it."""
    network = next((entry for entry in judged if entry.name == name), None)
    if network is None or training.split.healthy is None:
        return {}
    score = damage_score(network.predictions, training.split.healthy)
    detector = judged_detector(TITLES[name], score, rows.labels, seed, referenced=name == NETWORK_REFERENCED)
    return {NETWORKS: detector} if detector else {}


def _cross_fitted(matrix: FeatureMatrix, seed: int, *, referenced: bool) -> dict[str, Detector]:
    """Return indicator, classifiers and the choice among them; empty with too few gearboxes of either side."""
    labels = matrix.labels
    healthy = labels["fault"] == HEALTHY
    if min(_count(labels["specimen_id"][side]) for side in (healthy, ~healthy)) < FEWEST_SPECIMENS:
        return {}
    fold = dealt(labels["specimen_id"], seed)
    usable = np.isfinite(matrix.values).all(axis=0)
    whole = matrix.columns([name for name, kept in zip(matrix.names, usable, strict=True) if kept])
    ways: dict[str, tuple[Scorer, FeatureMatrix]] = {
        **({INDICATOR: (indicator_scorer, whole)} if usable.any() else {}),
        CLASSIFIER: (partial(logistic_scorer, take_logarithms=not referenced), matrix),
        BOOSTED: (partial(boosting_scorer, seed=seed), matrix),
    }
    outer = {family: fold_scores(way, taken, ~healthy, fold) for family, (way, taken) in ways.items()}
    inner = {family: inner_scores(way, taken, ~healthy, fold) for family, (way, taken) in ways.items()}
    score, names = chosen_scores(outer, inner, ~healthy, fold)
    judged = {}
    for family, scores in outer.items():
        basis = most_chosen(whole, ~healthy, fold) if family == INDICATOR else ""
        detector = judged_detector(family, scores, labels, seed, referenced=referenced, basis=basis)
        judged[family] = detector and replace(detector, gears=matrix.gears)
    chosen = judged[names[0]]
    if len(set(names)) > 1:
        mixed = judged_detector(CHOICE, score, labels, seed, referenced=referenced)
        chosen = replace(mixed, picks=tuple(Counter(names).most_common())) if mixed else None
    return {family: detector for family, detector in {**judged, CHOSEN: chosen}.items() if detector}


def _count(specimen: np.ndarray) -> int:
    return int(np.unique(specimen).size)


def strongest_column(values: np.ndarray, damaged: np.ndarray) -> tuple[int, float]:
    """Return the column that is best by itself, and 1 where damage raises it or -1 where it lowers it."""
    area = column_auc(values, damaged)
    best = int(np.argmax(np.abs(area - 0.5)))
    return best, 1.0 if area[best] >= 0.5 else -1.0


def indicator_scorer(matrix: FeatureMatrix, damaged: np.ndarray) -> Fitted:
    """Take the column that is best: its distance from healthy records, turned so that damage is large."""
    best, turned = strongest_column(matrix.values, damaged)
    healthy = matrix.values[~damaged, best]
    return lambda other: turned * distance(other.values[:, best], healthy)


def most_chosen(matrix: FeatureMatrix, damaged: np.ndarray, fold: np.ndarray) -> str:
    """Return the column that most folds choose."""
    found = [strongest_column(matrix.values[~held], damaged[~held])[0] for held in held_out(fold)]
    return matrix.names[Counter(found).most_common(1)[0][0]]


def logistic_scorer(matrix: FeatureMatrix, damaged: np.ndarray, *, take_logarithms: bool) -> Fitted:
    """Fit logistic regression; the score is the logarithm of the odds of damage."""
    truth = damaged.astype(np.int64)
    return _odds(fitted_classifier(matrix, truth, (HEALTHY, "damaged"), take_logarithms=take_logarithms))


def boosting_scorer(matrix: FeatureMatrix, damaged: np.ndarray, *, seed: int) -> Fitted:
    """Fit gradient boosting of a fixed number of trees; the score is the logarithm of the odds of damage."""
    return _odds(fitted_boosting(matrix, damaged.astype(np.int64), (HEALTHY, "damaged"), seed))


def _odds(model: FeatureClassifier) -> Fitted:
    def score(other: FeatureMatrix) -> np.ndarray:
        damage = model.probability(other.columns(model.features).values)[:, 1]
        return np.asarray(np.log(np.maximum(damage, SMALLEST)) - np.log(np.maximum(1.0 - damage, SMALLEST)))

    return score
