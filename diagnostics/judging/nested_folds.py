"""Every gearbox judged by a classifier that has not seen it: nested folds over all gearboxes of a set.

The outer folds hold gearboxes out; the penalty is chosen inside the rest. So a set of 24 gearboxes
is judged on 24 and not on the few of its test split. What a classifier says of a kind of damage that it was never
shown is asked too: each damaged class is left out of training in turn, and a record is called "something else" where
its largest probability lies below what 95 % of known records exceed, by inner folds. Source: nested cross-validation
and rejection by the largest posterior (Chow 1970), standard literature.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.judging.evaluation import Design
from diagnostics.statistics.evaluation import (
    IntervalScores,
    Predictions,
    area_interval,
    bootstrap_weights,
    macro_auroc,
    scores,
)
from diagnostics.training.feature_classifier import state_index
from diagnostics.training.splits import SpecimenSplit

KNOWN_ACCEPTED = 0.95
"""Share of records of known classes that are not called something else."""

RESAMPLES = 300
DESIGN = Design(folds=4)


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
        Called once for each of `strange_classes(split)`.
    """
    from diagnostics.training.classifiers import LogisticBaseline

    values, truth, specimen = matrix.values, state_index(matrix, split.classes), matrix.groups
    fold = DESIGN.dealt(specimen, seed)[0]
    folds = np.unique(fold).tolist()
    if len(folds) < 3 or any(np.unique(truth[fold != k]).size < len(split.classes) for k in folds):
        return None
    probability = np.zeros((truth.size, len(split.classes)))
    strengths = []
    for k in folds:
        model = LogisticBaseline().fit(values[fold != k], truth[fold != k], specimen[fold != k])
        probability[fold == k] = model.predict_proba(values[fold == k])
        strengths.append(model.strength_)
    strangers = []
    for name in strange_classes(split):
        strangers.append(_stranger(split.classes.index(name), matrix, split, fold, strengths))
        if advance:
            advance()
    found = Predictions(split.classes, truth, probability, specimen)
    return Nested(fold_scores(found, fold, seed), len(folds), tuple(strangers))


def strange_classes(split: SpecimenSplit) -> tuple[str, ...]:
    """Return the classes that are left out in turn: the damaged ones, where two known ones are left without each."""
    damaged = tuple(name for name in split.classes if name != split.healthy)
    return damaged if len(split.classes) > 2 else ()


def _stranger(
    left_out: int, matrix: FeatureMatrix, split: SpecimenSplit, fold: np.ndarray, strengths: list[float]
) -> Stranger:
    """Return what is said of records of a class, by its place, by classifiers that have never seen it."""
    from diagnostics.training.classifiers import FOLDS, LogisticBaseline

    truth, said = state_index(matrix, split.classes), list[str]()
    for k, strength in zip(np.unique(fold).tolist(), strengths, strict=True):
        known = (fold != k) & (truth != left_out)
        values, own, specimen = matrix.values[known], truth[known], matrix.groups[known]
        model = LogisticBaseline((strength,)).fit(values, own, specimen)
        part, largest = np.unique(specimen, return_inverse=True)[1] % FOLDS, np.zeros(own.size)
        for inner in np.unique(part).tolist() if np.unique(part).size > 1 else ():
            rest = LogisticBaseline((strength,)).fit(values[part != inner], own[part != inner], specimen[part != inner])
            largest[part == inner] = rest.predict_proba(values[part == inner]).max(axis=1)
        least = float(np.quantile(largest, 1.0 - KNOWN_ACCEPTED))
        for row in model.predict_proba(matrix.values[(fold == k) & (truth == left_out)]):
            said.append(split.classes[model.classes_[int(np.argmax(row))]] if row.max() >= least else "")
    counts = Counter(said)
    rejected = counts.pop("", 0)
    called = {word: count / len(said) for word, count in counts.most_common()}
    return Stranger(split.classes[left_out], len(said), rejected / len(said), called)


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
