"""Scores of records by what was fitted on other gearboxes, and the honest choice among several ways to score.

Gearboxes are dealt into folds. A way to score is fitted on all folds but one and scores that one. Which of several ways
is the strongest would be optimistic if it were seen on the scores that are reported; so for every fold the choice is
made among fits that saw neither that fold nor the one that they score (nested cross-validation, standard literature;
one fit serves both folds that it leaves out: derived).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import combinations

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.evaluation import column_auc

FOLDS, DEALT = 5, 2000
"""Folds of gearboxes, and the owner of the generator that deals them: others have other owners."""

Fitted = Callable[[FeatureMatrix], np.ndarray]
"""Gives the score of every record, large for damage."""

Scorer = Callable[[FeatureMatrix, np.ndarray], Fitted]
"""Fits to records and to whether they are damaged, (n,) bool."""


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
