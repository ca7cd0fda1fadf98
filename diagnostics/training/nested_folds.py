"""Every gearbox judged by a classifier that has not seen it: nested folds over all gearboxes of a set.

The outer folds hold gearboxes out; the penalty is chosen inside the rest (`train_classifier`). So a set of 24 gearboxes
is judged on 24 and not on the few of its test split. What a classifier says of a kind of damage that it was never
shown is asked too: each damaged class is left out of training in turn, and a record is called "something else" where
its largest probability lies below what 95 % of known records exceed, by inner folds. Source: nested cross-validation
and rejection by the largest posterior (Chow 1970), standard literature.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.evaluation import Predictions, bootstrap_weights, macro_auroc
from diagnostics.statistics.scores import IntervalScores, area_interval, scores
from diagnostics.training.baselines import FOLDS, fitted_classifier, state_index, train_classifier
from diagnostics.training.splits import SpecimenSplit

KNOWN_ACCEPTED = 0.95
"""Share of records of known classes that are not called something else."""

RESAMPLES = 300
Fold = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True, slots=True)
class Stranger:
    """What is said of records of a class that training did not have.

    Attributes
    ----------
    name : str
        The class.
    records : int
        Of all gearboxes, each judged by a classifier that has seen neither the class nor the gearbox.
    rejected : float
        Share called something else.
    called : dict of str to float
        Share of the records called by the name of each known class, the most frequent first.
    """

    name: str
    records: int
    rejected: float
    called: dict[str, float]


@dataclass(frozen=True, slots=True)
class Nested:
    """Scores of nested folds over all gearboxes, and what becomes of classes that training lacked."""

    scores: IntervalScores
    folds: int
    strangers: tuple[Stranger, ...]


def nested_folds(
    matrix: FeatureMatrix, split: SpecimenSplit, seed: int, advance: Callable[[], None] | None = None
) -> Nested | None:
    """Return the scores of logistic regression on indicators, judged on every gearbox; None without three gearboxes.

    Parameters
    ----------
    matrix : FeatureMatrix
        All records of the set.
    split : SpecimenSplit
        Its classes; who trains and who tests is dealt anew.
    seed : int
        Seeds folds and bootstrap.
    advance : callable, optional
        Called `nested_steps(split)` times.
    """
    truth = state_index(matrix, split.classes)
    fold = fold_of(matrix.labels["specimen_id"], seed)
    folds = held_out(fold)
    if len(folds) < 3 or any(np.unique(truth[train]).size < len(split.classes) for train, _ in folds):
        return None
    probability = np.zeros((truth.size, len(split.classes)))
    strengths = []
    for train, test in folds:
        nobody = np.zeros_like(train)
        model = train_classifier(matrix, replace(split, train=train, validation=nobody, test=test))
        probability[test] = model.probability(matrix.values[test])
        strengths.append(model.strength)
    found = Predictions(split.classes, truth, probability, matrix.labels["specimen_id"])
    strangers = []
    for name in strange_classes(split):
        strangers.append(_stranger(name, matrix, split, folds, strengths))
        if advance:
            advance()
    return Nested(fold_scores(found, fold, seed), len(folds), tuple(strangers))


def strange_classes(split: SpecimenSplit) -> tuple[str, ...]:
    """Return the classes that are left out in turn: the damaged ones, where two known ones are left without each."""
    damaged = tuple(name for name in split.classes if name != split.healthy)
    return damaged if len(split.classes) > 2 else ()


def _stranger(
    name: str, matrix: FeatureMatrix, split: SpecimenSplit, folds: list[Fold], strengths: list[float]
) -> Stranger:
    truth = state_index(matrix, split.classes)
    left_out = truth == split.classes.index(name)
    said: list[str] = []
    for (train, test), strength in zip(folds, strengths, strict=True):
        known = matrix.rows(train & ~left_out)
        model = fitted_classifier(known, truth[train & ~left_out], split.classes, strength)
        least = _least_certainty(known, truth[train & ~left_out], split.classes, strength)
        said += _named(model.probability(matrix.values[test & left_out]), split.classes, least)
    counts = Counter(said)
    rejected = counts.pop("", 0)
    called = {word: count / len(said) for word, count in counts.most_common()}
    return Stranger(name, len(said), rejected / len(said), called)


def _named(probability: np.ndarray, classes: tuple[str, ...], least: float) -> Iterator[str]:
    """Yield the class that each record (n, classes) is called; nothing for something else."""
    for row in probability:
        yield classes[int(np.argmax(row))] if row.max() >= least else ""


def _least_certainty(matrix: FeatureMatrix, truth: np.ndarray, classes: tuple[str, ...], strength: float) -> float:
    """Return what `KNOWN_ACCEPTED` of the records exceed with their largest probability on gearboxes not trained on."""
    _, place = np.unique(matrix.labels["specimen_id"], return_inverse=True)
    largest = np.zeros(truth.size)
    for train, test in held_out(place % FOLDS):
        model = fitted_classifier(matrix.rows(train), truth[train], classes, strength)
        largest[test] = model.probability(matrix.values[test]).max(axis=1)
    return float(np.quantile(largest, 1.0 - KNOWN_ACCEPTED))


def nested_metrics(found: Nested) -> dict[str, Any]:
    """Return what `metrics.json` says about nested folds."""
    return {
        "folds": found.folds,
        "specimens": found.scores.specimens,
        "records": found.scores.records,
        "accuracy": found.scores.accuracy.numbers(),
        "macro_auroc": found.scores.macro_auroc.numbers(),
        "classes": list(found.scores.classes),
        "confusion": found.scores.confusion.tolist(),
        "classes_left_out": [
            {"class": one.name, "records": one.records, "something_else": one.rejected, "called": one.called}
            for one in found.strangers
        ],
    }


def fold_of(group: np.ndarray, seed: int) -> np.ndarray:
    """Return the fold of every row; rows of a group share it."""
    members, index = np.unique(group, return_inverse=True)
    return (generator(seed, Purpose.FOLDS).permutation(members.size) % min(FOLDS, members.size))[index]


def held_out(part: np.ndarray) -> list[Fold]:
    """Return one fold per part: trained on the others, tested on it; none where there is a single part."""
    parts = np.unique(part)
    return [(part != one, part == one) for one in parts] if parts.size > 1 else []


def fold_scores(found: Predictions, fold: np.ndarray, seed: int) -> IntervalScores:
    """Judge out-of-fold predictions with the macro-AUROC averaged over folds, never ranked across them.

    A state that is rare in a fold is frequent in its training; ranked across folds, even a classifier that knows
    nothing but these frequencies would fall below chance.
    """
    weights = bootstrap_weights(found.specimen, seed, RESAMPLES)
    areas, sizes = [], []
    for one in np.unique(fold):
        mine = fold == one
        part = Predictions(found.classes, found.truth[mine], found.probability[mine], found.specimen[mine])
        areas.append(macro_auroc(part, weights[:, mine]))
        sizes.append(weights[:, mine].sum(axis=1))
    area, size = np.stack(areas), np.where(np.isfinite(areas), sizes, 0.0)
    with np.errstate(invalid="ignore"):
        mean = (np.nan_to_num(area) * size).sum(axis=0) / size.sum(axis=0)
    specimens = int(np.unique(found.specimen).size)
    return replace(scores(found, seed, RESAMPLES), macro_auroc=area_interval(mean, specimens))
