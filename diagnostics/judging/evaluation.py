"""A detector learns on some gearboxes and scores others, under a design: all that judges damage here is that.

Gearboxes are dealt into folds, and what scores a fold has learnt, and chosen, on the others. Where scores of folds are
comparable, all records are ranked together (`pooled_scores`). Where they come from different choices, only records of
one fold are compared with each other (`held_out`). Pairs of records of one gearbox never count. Source: nested
cross-validation, standard literature; the scheme derived.

Many ways of stating the damage are judged at once: ranks, products and their decompositions do not depend on it, so
that hundreds of permutations cost little more than one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any, Protocol

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.statistics.evaluation import Interval, area_interval, bootstrap_weights, column_auc, fewest_gearboxes

FEWEST_SPECIMENS = 4
RESAMPLES = 200


class Detector(Protocol):
    """Learns from records of some gearboxes and scores those of others; larger means more damage."""

    def fit(self, X: Any, y: np.ndarray, groups: np.ndarray) -> Detector:
        """Learn.

        Parameters
        ----------
        X : (n, ...)
            Numbers of records, or places of records in what the detector holds.
        y : (n,) or (ways, n) bool
            Damaged records; several ways of stating it for a detector that takes them.
        groups : (n,) int
            Gearboxes.
        """

    def score(self, X: Any) -> np.ndarray:
        """Return the score of other records, (m,), or (ways, m)."""


@dataclass(frozen=True, slots=True)
class Design:
    """Gearboxes dealt into folds: how many, whose draws, how often (None: once), and the fewest of a fold."""

    folds: int
    owner: int = 0
    deals: int | None = None
    fewest: int = 1

    def dealt(self, groups: np.ndarray, seed: int) -> np.ndarray:
        """Return the fold of every record (n,) in every deal, (deals, n) int; a gearbox is in one fold."""
        names, place = np.unique(groups, return_inverse=True)
        folds = max(min(self.folds, names.size // self.fewest), 1)
        parts = [()] if self.deals is None else [(deal,) for deal in range(self.deals)]
        orders = (generator(seed, Purpose.FOLDS, self.owner, *part).permutation(names.size) for part in parts)
        return np.stack([order[place.ravel()] % folds for order in orders])


@dataclass(frozen=True, slots=True)
class Entry:
    """A detector and what it is asked about.

    Attributes
    ----------
    name : str
        What it is called in tables.
    make : callable
        Returns a detector that has not learnt. After `fit` its `basis`, if it has one, says what scores rest on.
    X : (records, ...)
    usable : (records,) bool
        Records that it can be asked about.
    tried : int
        Columns or features that it chooses from or weighs.
    deals : int
        Deals of the gearboxes into folds that it can afford.
    many : bool
        Whether it takes many ways of stating the damage at once.
    """

    name: str
    make: Callable[[], Detector]
    X: np.ndarray
    usable: np.ndarray
    tried: int = 0
    deals: int = 3
    many: bool = True


@dataclass(frozen=True, slots=True)
class HeldOut:
    """AUC on unseen gearboxes with its interval from resampled gearboxes; what was chosen most often; gearboxes."""

    auc: Interval
    basis: str
    specimens: int


def rounds(
    entry: Entry, rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray
) -> Iterator[tuple[Detector, np.ndarray, np.ndarray]]:
    """Yield what has learnt on the other folds, for every fold of every deal.

    Parameters
    ----------
    entry : Entry
    rows : (n,) int
        Records of the set.
    positive : (ways, n) bool
        Which of them are damaged, one row for each way of stating it.
    specimen : (n,) int
    folds : (deals, n) int
        As of `Design.dealt`.

    Yields
    ------
    Detector
    (n,) bool
        Which of the records it is asked about.
    (ways,) bool
        The ways in which both sides hold both classes; it has learnt these.
    """
    for fold in folds[: entry.deals]:
        for held in np.unique(fold):
            asked = fold == held
            sides = (positive[:, side] for side in (asked, ~asked))
            both = np.all([own.any(axis=1) & ~own.all(axis=1) for own in sides], axis=0)
            if both.any():
                learnt = entry.make().fit(entry.X[rows[~asked]], positive[both][:, ~asked], specimen[~asked])
                yield learnt, asked, both


def wins(score: np.ndarray, positive: np.ndarray, specimen: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return won and all pairs of a damaged and a healthy record of different gearboxes, (2, resamples).

    Parameters
    ----------
    score : (n,) float64
    positive : (n,) bool
    specimen : (n,) int
    weights : (resamples, n) float64
        How often a record counts in each resample.
    """
    above, below = np.flatnonzero(positive), np.flatnonzero(~positive)
    apart = (specimen[above][:, None] != specimen[below]).astype(np.float64)
    won = apart * (0.5 + 0.5 * np.sign(score[above][:, None] - score[below]))
    left, right = weights[:, above], weights[:, below]
    return np.stack([np.einsum("bj,bj->b", left @ pairs, right) for pairs in (won, apart)])


def judged_rows(entry: Entry, healthy: np.ndarray, state: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the rows that an entry is judged on, (n,) int: healthy and of a state; empty with too few gearboxes.

    Parameters
    ----------
    entry : Entry
    healthy, state : (records,) bool
        Which records are healthy, and which are of the state.
    specimen : (records,) int
    """
    rows = np.flatnonzero(entry.usable & (healthy | state))
    return rows if fewest_gearboxes(state[rows], specimen[rows]) >= FEWEST_SPECIMENS else rows[:0]


def held_out(
    entry: Entry, rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray, seed: int
) -> HeldOut:
    """Return what an entry reaches on the gearboxes of other folds; parameters as of `rounds`, `positive` (n,)."""
    weights = bootstrap_weights(specimen, seed, RESAMPLES)
    total, chosen = np.zeros((2, len(weights))), Counter[str]()
    for learnt, asked, _ in rounds(entry, rows, positive[None], specimen, folds):
        score = learnt.score(entry.X[rows[asked]])[0]
        total += wins(score, positive[asked], specimen[asked], weights[:, asked])
        chosen[getattr(learnt, "basis", "")] += 1
    with np.errstate(invalid="ignore", divide="ignore"):
        samples = np.where(total[1] > 0.0, total[0] / total[1], np.nan)
    best = chosen.most_common(1)[0][0] if chosen else ""
    return HeldOut(area_interval(samples, fewest_gearboxes(positive, specimen)), best, int(np.unique(specimen).size))


def held_out_values(
    entry: Entry, rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray
) -> np.ndarray:
    """Return the AUC alone for every way of stating the damaged records, (ways,); NaN where no pair is left."""
    total = np.zeros((2, len(positive)))
    for learnt, asked, both in rounds(entry, rows, positive, specimen, folds):
        score = learnt.score(entry.X[rows[asked]])
        total[:, both] += _wins_by_way(score, positive[both][:, asked], specimen[asked])
    with np.errstate(invalid="ignore"):
        return np.asarray(total[0] / np.where(total[1] > 0.0, total[1], np.nan))


def _wins_by_way(score: np.ndarray, positive: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return won and all pairs as `wins` does, for every way of stating the damage, (2, ways); scores (ways, n)."""
    from scipy.stats import rankdata

    damaged = positive.sum(axis=1)
    won = np.where(positive, rankdata(score, axis=1), 0.0).sum(axis=1) - 0.5 * damaged * (damaged + 1)
    first, second = np.nonzero((specimen[:, None] == specimen) & ~np.eye(specimen.size, dtype=bool))
    own = positive[:, first] & ~positive[:, second]
    won_own = np.where(own, 0.5 + 0.5 * np.sign(score[:, first] - score[:, second]), 0.0).sum(axis=1)
    return np.stack([won - won_own, damaged * (positive.shape[1] - damaged) - own.sum(axis=1)])


def _learnt(entry: Entry, learn: np.ndarray, damaged: np.ndarray, specimen: np.ndarray) -> Detector | None:
    """Return what has learnt from some records; None where these are all healthy or all damaged."""
    if np.unique(damaged[learn]).size < 2:
        return None
    return entry.make().fit(entry.X[learn], damaged[learn], specimen[learn])


def pooled_scores(entry: Entry, damaged: np.ndarray, specimen: np.ndarray, fold: np.ndarray) -> tuple[np.ndarray, str]:
    """Return the score of every record, (n,), by what learnt on the other folds (n,), and what most of these chose."""
    score, chosen = np.zeros(damaged.size), Counter[str]()
    for held in np.unique(fold):
        asked = fold == held
        if detector := _learnt(entry, ~asked, damaged, specimen):
            score[asked] = detector.score(entry.X[asked])
            chosen[getattr(detector, "basis", "")] += 1
    return score, chosen.most_common(1)[0][0] if chosen else ""


def inner_scores(entry: Entry, damaged: np.ndarray, specimen: np.ndarray, fold: np.ndarray) -> np.ndarray:
    """Return scores that know nothing of a fold, (folds, n).

    Row k has a score of every record outside fold k, by what saw neither fold k nor the fold of the record; NaN in
    fold k. One fit serves both folds that it leaves out.
    """
    numbers = np.unique(fold)
    found = np.where(fold == numbers[:, None], np.nan, 0.0)
    for a, b in combinations(range(numbers.size), 2):
        first, second = fold == numbers[a], fold == numbers[b]
        if detector := _learnt(entry, ~(first | second), damaged, specimen):
            found[a, second], found[b, first] = (detector.score(entry.X[asked]) for asked in (second, first))
    return found


def chosen_scores(
    outer: Mapping[str, np.ndarray], inner: Mapping[str, np.ndarray], damaged: np.ndarray, fold: np.ndarray
) -> tuple[np.ndarray, list[str]]:
    """Return scores of every record by the entry that is strongest on the other folds, and its name by fold.

    Which is the strongest would be optimistic if it were seen on the scores that are reported.

    Parameters
    ----------
    outer : mapping of str to (n,) float64
        What `pooled_scores` returned for each entry.
    inner : mapping of str to (folds, n) float64
        What `inner_scores` returned.
    damaged : (n,) bool
    fold : (n,) int

    Returns
    -------
    (n,) float64
        The scores of one entry where all folds choose the same; else distances from the median of the inner scores of
        healthy records over their interquartile range, which makes different entries comparable.
    list of str
    """
    held = [fold == number for number in np.unique(fold)]
    names = []
    for row, own in enumerate(held):
        areas = {name: column_auc(scores[row, ~own][:, None], damaged[~own])[0] for name, scores in inner.items()}
        names.append(max(areas, key=lambda name: np.nan_to_num(areas[name])))
    if len(set(names)) == 1:
        return outer[names[0]], names
    score = np.zeros(damaged.size)
    for row, (own, name) in enumerate(zip(held, names, strict=True)):
        score[own] = distance(outer[name][own], inner[name][row, ~own & ~damaged])
    return score, names


def distance(values: np.ndarray, healthy: np.ndarray) -> np.ndarray:
    """Return how far values lie above the median of healthy ones, in interquartile ranges of these."""
    low, middle, high = np.quantile(healthy, [0.25, 0.5, 0.75])
    return np.asarray((values - middle) / ((high - low) or 1.0))
