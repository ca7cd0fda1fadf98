"""AUC of an attacker on gearboxes that it was not shown, with what it chose on the others.

Gearboxes are dealt into folds; an attacker learns, and chooses its band, on all folds but one and judges that one.
Scores of different folds come from different choices, so only records of one fold are compared with each other. Pairs
of records of one gearbox do not count. Source: nested cross-validation, standard literature; the scheme derived.

One trial of an attacker: which records it learns from, and which it then has to tell apart.

All permutations of the states are one trial: ranks, products and their decompositions do not depend on the states, so
that hundreds of permutations cost little more than one.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.statistics.evaluation import Interval, bootstrap_weights
from diagnostics.statistics.scores import area_interval

DEALS, MOST_FOLDS = 3, 4
FEWEST_SPECIMENS = 4
RESAMPLES = 200
DEALT = 1000
"""Owner of the folds' generator: classifiers have others."""


@dataclass(frozen=True, slots=True)
class Trial:
    """Healthy records and those of one state, some of them to learn from.

    Attributes
    ----------
    rows : (n,) int
        Records of the set.
    positive : (turns, n) bool
        Which of them are damaged, one row for each way of stating it; in every row both classes stand on both sides.
    specimen : (n,) int
        Their gearboxes.
    train : (n,) bool
        Which of them may be learnt from; whole gearboxes.
    deal, fold : int
        Which trial of how many this is.
    """

    rows: np.ndarray
    positive: np.ndarray
    specimen: np.ndarray
    train: np.ndarray
    deal: int
    fold: int


@dataclass(frozen=True, slots=True)
class Verdicts:
    """What an attacker says of the records that it has not learnt from.

    Attributes
    ----------
    score : (turns, n not learnt from) float64
    basis : str
        What the scores of the first row rest on, such as a band; empty where all counts.
    """

    score: np.ndarray
    basis: str = ""


@dataclass(frozen=True, slots=True)
class Attacker:
    """A way of telling states.

    Attributes
    ----------
    name : str
        What it is called in tables.
    attack : callable
        Verdicts of a trial.
    usable : (records,) bool
        Records that it can be asked about.
    tried : int
        Columns or features that it chooses from or weighs.
    deals : int
        Deals of the gearboxes into folds that it can afford.
    permutable : bool
        Whether it is cheap enough for permuted states.
    """

    name: str
    attack: Callable[[Trial], Verdicts]
    usable: np.ndarray
    tried: int
    deals: int
    permutable: bool = True


@dataclass(frozen=True, slots=True)
class HeldOut:
    """AUC on unseen gearboxes with its interval from resampled gearboxes; what was chosen most often; gearboxes."""

    auc: Interval
    basis: str
    specimens: int


def dealt_folds(specimen: np.ndarray, seed: int, deals: int = DEALS) -> np.ndarray:
    """Return the fold of every record in every deal, (deals, records) int.

    A fold holds whole gearboxes, at least two; so there are four folds from eight gearboxes on.
    """
    unique, index = np.unique(specimen, return_inverse=True)
    folds = max(min(MOST_FOLDS, unique.size // 2), 1)
    places = [generator(seed, Purpose.FOLDS, DEALT, deal).permutation(unique.size) for deal in range(deals)]
    return np.stack([place[index.ravel()] % folds for place in places])


def trials(
    rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray
) -> Iterator[tuple[Trial, np.ndarray]]:
    """Yield a trial for every fold of every deal, with the ways of stating in which both sides hold both classes.

    Parameters
    ----------
    rows : (n,) int
    positive : (turns, n) bool
    specimen : (n,) int
        Records, as of `Trial`.
    folds : (deals, n) int
        Their folds, as of `dealt_folds`.

    Yields
    ------
    Trial
    (turns,) bool
        Which rows of `positive` the trial holds.
    """
    for deal, fold in enumerate(folds):
        for held in np.unique(fold):
            train = fold != held
            both = np.ones(len(positive), dtype=bool)
            for side in (train, ~train):
                both &= positive[:, side].any(axis=1) & ~positive[:, side].all(axis=1)
            if both.any():
                yield Trial(rows, positive[both], specimen, train, deal, int(held)), both


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


def judged_rows(attacker: Attacker, healthy: np.ndarray, state: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the rows that an attacker is judged on, (n,) int: healthy and of a state; empty with too few gearboxes.

    Parameters
    ----------
    attacker : Attacker
    healthy, state : (records,) bool
        Which records are healthy, and which are of the state.
    specimen : (records,) int
    """
    rows = np.flatnonzero(attacker.usable & (healthy | state))
    counts = [np.unique(specimen[rows[state[rows] == side]]).size for side in (True, False)]
    return rows if min(counts) >= FEWEST_SPECIMENS else rows[:0]


def held_out(
    attacker: Attacker, rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray, seed: int
) -> HeldOut:
    """Return what an attacker reaches on the gearboxes of other folds.

    Parameters
    ----------
    attacker : Attacker
    rows, specimen
        As of `trials`.
    positive : (n,) bool
    folds : (deals, n) int
    seed : int
        Of the resampled gearboxes.
    """
    weights = bootstrap_weights(specimen, seed, RESAMPLES)
    total, chosen = np.zeros((2, len(weights))), Counter[str]()
    for trial, _ in trials(rows, positive[None], specimen, folds[: attacker.deals]):
        found, held = attacker.attack(trial), ~trial.train
        total += wins(found.score[0], positive[held], specimen[held], weights[:, held])
        chosen[found.basis] += 1
    with np.errstate(invalid="ignore", divide="ignore"):
        samples = np.where(total[1] > 0.0, total[0] / total[1], np.nan)
    smaller = min(np.unique(specimen[positive == side]).size for side in (True, False))
    best = chosen.most_common(1)[0][0] if chosen else ""
    return HeldOut(area_interval(samples, smaller), best, int(np.unique(specimen).size))


def held_out_values(
    attacker: Attacker, rows: np.ndarray, positive: np.ndarray, specimen: np.ndarray, folds: np.ndarray
) -> np.ndarray:
    """Return the AUC alone for every way of stating the damaged records, (turns,); NaN where no pair is left."""
    total = np.zeros((2, len(positive)))
    for trial, turns in trials(rows, positive, specimen, folds[: attacker.deals]):
        held = ~trial.train
        total[:, turns] += wins_by_turn(attacker.attack(trial).score, trial.positive[:, held], specimen[held])
    with np.errstate(invalid="ignore"):
        return np.asarray(total[0] / np.where(total[1] > 0.0, total[1], np.nan))


def wins_by_turn(score: np.ndarray, positive: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return won and all pairs as `wins` does, for every way of stating the damaged records, (2, turns).

    Parameters
    ----------
    score : (turns, n) float64
    positive : (turns, n) bool
    specimen : (n,) int
    """
    from scipy.stats import rankdata

    damaged = positive.sum(axis=1)
    won = np.where(positive, rankdata(score, axis=1), 0.0).sum(axis=1) - 0.5 * damaged * (damaged + 1)
    first, second = np.nonzero((specimen[:, None] == specimen) & ~np.eye(specimen.size, dtype=bool))
    own = positive[:, first] & ~positive[:, second]
    won_own = np.where(own, 0.5 + 0.5 * np.sign(score[:, first] - score[:, second]), 0.0).sum(axis=1)
    return np.stack([won - won_own, damaged * (positive.shape[1] - damaged) - own.sum(axis=1)])
