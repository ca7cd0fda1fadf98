"""What classifiers are judged by, with intervals from a bootstrap over specimens, never over records or windows.

Records of one specimen share its gears and its damage, so only specimens are independent. AUC: Mann-Whitney statistic
with half credit for ties. Source: standard literature (Efron; Hand & Till 2001 for averages over classes); weighted
ranks derived.

Near 1 the bootstrap is too narrow: where every damaged record lies above every healthy one, so does it in every
resample. So limits of an AUC or a share are widened to those of Clopper and Pearson for a proportion among as many
independent gearboxes as the resamples' variance stands for, and not fewer than there are. Source: Clopper and Pearson
1934, with the effective sample size of Korn and Graubard (Survey Methodology 24, 1998, 193-201); its least value, the
gearboxes of the smaller class, since the variance of an AUC is at most A(1 - A)/min(m, n): Birnbaum and Klose 1957.
Where the resamples scatter less than that, more gearboxes count than there are, since each is compared with all of the
other class; so limits between the ends may be narrower than those of the gearboxes counted. A share of records is
treated like an AUC: 0 and 1 get the exact limits of so many gearboxes. No AUC gets a higher lower limit than 1 itself
would, which is 0.025^(1/n). The combination is derived; its coverage is tested (docs/understand/audit.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.base.seeding import Purpose, generator

RESAMPLES = 1000
LEVEL = 0.95
FEWEST_THAT_AGREE = 6
"""Gearboxes: of fewer, all of one sign come by chance in more than one of twenty cases, since 2 / 2^5 = 0.06."""
UNKNOWN = -1
"""Index of a state that a classifier does not know."""


@dataclass(frozen=True, slots=True)
class Interval:
    """A value with the limits of its interval; both limits are NaN where too few specimens or recordings tell them."""

    value: float
    low: float
    high: float

    def numbers(self) -> dict[str, float | None]:
        """Return value and limits for JSON, undefined as null."""
        named = {"value": self.value, "low": self.low, "high": self.high}
        return {name: float(number) if math.isfinite(number) else None for name, number in named.items()}

    def __format__(self, form: str) -> str:
        """Return value and limits as text, each in a form such as `.2f`."""
        if math.isnan(self.value):
            return "undefined"
        limits = f"{self.low:{form}}, {self.high:{form}}" if math.isfinite(self.low) else "no limits"
        return f"{self.value:{form}} [{limits}]"


UNDEFINED = Interval(math.nan, math.nan, math.nan)


@dataclass(frozen=True, slots=True)
class Predictions:
    """Class probabilities of records, with what they are judged by.

    Attributes
    ----------
    classes : tuple of str
        State names in the order of the columns of `probability`.
    truth : (n,) int
        Index of the true state; UNKNOWN for a record of another set in a state that is none of `classes`.
    probability : (n, classes) float64
        Predicted probabilities.
    specimen : (n,) int
        Specimen of each record.
    """

    classes: tuple[str, ...]
    truth: np.ndarray
    probability: np.ndarray
    specimen: np.ndarray

    @property
    def predicted(self) -> np.ndarray:
        """(n,) int: the most probable state."""
        return np.asarray(self.probability.argmax(axis=1))


def bootstrap_weights(specimen: np.ndarray, seed: int, resamples: int = RESAMPLES) -> np.ndarray:
    """Return how often each record counts in each resample of the specimens.

    Parameters
    ----------
    specimen : (n,) int
        Specimen of each record.
    seed : int
        Same seed, same resamples.
    resamples : int
        Number of resamples.

    Returns
    -------
    (resamples + 1, n) float64
        Row 0 is the sample itself, all ones. Of a record all resamples stand together in memory: what orders records
        moves long rows.
    """
    _, index = np.unique(specimen, return_inverse=True)
    count = int(index.max()) + 1
    drawn = generator(seed, Purpose.BOOTSTRAP).multinomial(count, np.full(count, 1.0 / count), size=resamples)
    return np.asfortranarray(np.concatenate([np.ones((1, specimen.size)), drawn[:, index].astype(np.float64)]))


def sums_before(rows: np.ndarray) -> np.ndarray:
    """Return the sum of all rows before each, (n + 1, b), of (n, b): row by row, a third of the time of `cumsum`."""
    found = np.zeros((rows.shape[0] + 1, rows.shape[1]))
    for number, row in enumerate(rows):
        np.add(found[number], row, out=found[number + 1])
    return found


def weighted_midranks(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weight strictly below each value plus half the weight tied with it.

    Parameters
    ----------
    values : (n,) float64
        Without NaN.
    weights : (b, n) float64
        One row per resample.

    Returns
    -------
    (b, n) float64
    """
    order = np.argsort(values, kind="stable")
    ordered = values[order]
    # resamples stand together in memory, so that every step below is one over long rows
    below = sums_before(weights.T[order])
    first = np.searchsorted(ordered, ordered, side="left")
    last = np.searchsorted(ordered, ordered, side="right")
    tied = bool((last - first > 1).any())
    found = below[first] + below[last] if tied else below[:-1] + below[1:]
    found *= 0.5
    ranks: np.ndarray = np.empty_like(found)
    ranks[order] = found
    return ranks.T


@dataclass(frozen=True, slots=True)
class CentredRanks:
    """Midranks about their mean in every resample, (b, n); the same times the weights; their squared spread, (b,)."""

    ranks: np.ndarray
    weighted: np.ndarray
    spread: np.ndarray


def centred_ranks(values: np.ndarray, weights: np.ndarray) -> CentredRanks:
    """Return the centred ranks of values; parameters as of `weighted_midranks`."""
    ranks = weighted_midranks(values, weights)
    with np.errstate(invalid="ignore", divide="ignore"):
        ranks = ranks - ((weights * ranks).sum(axis=1) / weights.sum(axis=1))[:, None]
    weighted = weights * ranks
    return CentredRanks(ranks, weighted, (weighted * ranks).sum(axis=1))


def weighted_auc(values: np.ndarray, positive: np.ndarray, weights: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the area under the ROC curve between records of different specimens, for every row of weights.

    Pairs of records of one specimen are left out: they say what is seen on a specimen that one knows, and resampling
    with replacement would raise their share, so that limits would not lie around the value. Source: Mann-Whitney;
    without the pairs within a cluster derived.

    Parameters
    ----------
    values : (n,) float64
        Score or feature; larger should mean positive.
    positive : (n,) bool
        Which records are positive.
    weights : (b, n) float64
        Weights of the records, the same for all of a specimen.
    specimen : (n,) int
        Specimen of each record.

    Returns
    -------
    (b,) float64
        NaN where no pair has a weight, and where one side comes from a single specimen: it would speak of that one.
    """
    if fewest_gearboxes(positive, specimen) < 2:
        return np.full(len(weights), np.nan)
    above, below = np.flatnonzero(positive), np.flatnonzero(~positive)
    below = below[np.argsort(values[below], kind="stable")]
    drawn, rest = weights.T[above], sums_before(weights.T[below])
    first, last = (np.searchsorted(values[below], values[above], side) for side in ("left", "right"))
    beaten = rest[first] if np.array_equal(first, last) else 0.5 * (rest[first] + rest[last])
    wins = np.einsum("nb,nb->b", drawn, beaten)
    pairs = drawn.sum(axis=0) * rest[-1]
    unique, first, index = np.unique(specimen, return_index=True, return_inverse=True)
    own_wins, own_pairs = _own_pairs(values, positive, index.reshape(-1), unique.size)
    squares = weights[:, first] ** 2
    wins, pairs = wins - squares @ own_wins, pairs - squares @ own_pairs
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(pairs > 0.0, wins / pairs, np.nan))


def _own_pairs(
    values: np.ndarray, positive: np.ndarray, index: np.ndarray, specimens: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return won and all pairs of a positive and a negative record within each specimen, (specimens,) each."""
    above, below = np.flatnonzero(positive), np.flatnonzero(~positive)
    i, j = np.nonzero(index[above][:, None] == index[below])
    left, right, owner = values[above[i]], values[below[j]], index[above[i]]
    won = (left > right) + 0.5 * (left == right)
    return np.bincount(owner, won, specimens), np.bincount(owner, minlength=specimens).astype(np.float64)


def fewest_gearboxes(positive: np.ndarray, specimen: np.ndarray) -> int:
    """Return the gearboxes on the side, (n,) bool, that has fewer: as many the limits of an AUC count."""
    return min(int(np.unique(specimen[positive == side]).size) for side in (True, False))


def column_auc(values: np.ndarray, positive: np.ndarray) -> np.ndarray:
    """Return the AUC of every column, pairs of one gearbox among them: what a choice may rest on.

    Parameters
    ----------
    values : (records, columns) float64
    positive : (..., records) bool

    Returns
    -------
    (..., columns) float64
    """
    from scipy.stats import rankdata

    damaged = positive.sum(axis=-1, keepdims=True)
    ranks = positive.astype(np.float64) @ rankdata(values, axis=0) - 0.5 * damaged * (damaged + 1)
    return np.asarray(ranks / (damaged * (positive.shape[-1] - damaged)))


def interval(samples: np.ndarray, specimens: int) -> Interval:
    """Return the interval of a statistic: row 0 is its value, the others its resamples.

    Few gearboxes that agree make its limits meet, which says nothing of others: then it has none.
    """
    drawn = samples[1:]
    finite = np.isfinite(drawn)
    defined = drawn if finite.all() else drawn[finite]
    if specimens < 2 or defined.size == 0:
        return Interval(float(samples[0]), math.nan, math.nan)
    low, high = _quantiles(defined, ((1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0))
    if specimens < FEWEST_THAT_AGREE and math.isclose(low, high, rel_tol=1e-12):
        low = high = math.nan
    return Interval(float(samples[0]), float(low), float(high))


def _quantiles(values: np.ndarray, shares: Sequence[float]) -> list[float]:
    """Return quantiles of a few hundred values, to the bit as `np.quantile` does, in a fifth of its time."""
    ordered, found = np.sort(values), []
    for share in shares:
        below, part = divmod((values.size - 1) * share, 1.0)
        low, high = ordered[int(below)], ordered[min(int(below) + 1, values.size - 1)]
        found.append(float(low + (high - low) * part if part < 0.5 else high - (high - low) * (1.0 - part)))
    return found


def macro_auroc(predictions: Predictions, weights: np.ndarray) -> np.ndarray:
    """Return the one-against-rest AUC averaged over the states that occur, for every row of weights."""
    areas = np.stack(
        [
            weighted_auc(predictions.probability[:, k], predictions.truth == k, weights, predictions.specimen)
            for k in range(len(predictions.classes))
        ]
    )
    return mean_of_defined(areas)


def mean_of_defined(values: np.ndarray, axis: int = 0) -> np.ndarray:
    """Return the mean of the defined values along an axis; NaN where none is."""
    defined = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        total = np.where(defined, values, 0.0).sum(axis=axis)
        return np.asarray(total / np.where(defined.any(axis=axis), defined.sum(axis=axis), np.nan))


def confusion_matrix(predictions: Predictions) -> np.ndarray:
    """Return counts (true state, predicted state)."""
    size = len(predictions.classes)
    counts = np.zeros((size, size), dtype=np.int64)
    np.add.at(counts, (predictions.truth, predictions.predicted), 1)
    return counts


def balanced_accuracy(predictions: Predictions, weights: np.ndarray) -> np.ndarray:
    """Return the share named right, averaged over the classes that occur, for every row of weights, (b,)."""
    right = weights * (predictions.predicted == predictions.truth)
    mine = [predictions.truth == k for k in np.unique(predictions.truth)]
    with np.errstate(invalid="ignore"):  # a class without weight in a resample
        shares = np.stack([right[:, rows].sum(axis=1) / weights[:, rows].sum(axis=1) for rows in mine])
    return mean_of_defined(shares)


def area_interval(samples: np.ndarray, specimens: int) -> Interval:
    """Return an AUC, or a share of records, with its limits; NaN where it is.

    Parameters
    ----------
    samples : (resamples + 1,) float64
        The value itself, then those of resampled gearboxes.
    specimens : int
        Gearboxes of the class that has fewer; of a share, those that have such records.
    """
    found = interval(samples, specimens)
    if not math.isfinite(found.value) or specimens < 2:
        return found
    low, high = clopper_pearson(found.value, effective_size(found.value, samples[1:], specimens))
    highest_low, lowest_high = clopper_pearson(1.0, specimens)[0], clopper_pearson(0.0, specimens)[1]
    low, high = min(low, highest_low), max(high, lowest_high)
    return Interval(found.value, float(np.fmin(low, found.low)), float(np.fmax(high, found.high)))


def area(values: np.ndarray, positive: np.ndarray, weights: np.ndarray, specimen: np.ndarray) -> Interval:
    """Return the AUC between records of different gearboxes with its limits; parameters as of `weighted_auc`."""
    return area_interval(weighted_auc(values, positive, weights, specimen), fewest_gearboxes(positive, specimen))


def effective_size(value: float, resamples: np.ndarray, specimens: int) -> float:
    """Return how many independent gearboxes an AUC of this scatter stands for, at least those that there are."""
    defined = resamples[np.isfinite(resamples)]
    variance = float(np.var(defined)) if defined.size else 0.0
    own = value * (1.0 - value)
    return max(own / variance, float(specimens)) if variance > 0.0 and own > 0.0 else float(specimens)


def clopper_pearson(share: float, size: float) -> tuple[float, float]:
    """Return the exact 95 % limits of a proportion; sizes may be fractions. All of n won: from 0.025^(1/n) to 1."""
    from scipy.special import betaincinv  # scipy.stats gives the same number, and loads for most of a second

    tail, won = (1.0 - LEVEL) / 2.0, share * size
    low = float(betaincinv(won, size - won + 1.0, tail)) if won > 0.0 else 0.0
    return low, float(betaincinv(won + 1.0, size - won, 1.0 - tail)) if won < size else 1.0


@dataclass(frozen=True, slots=True)
class IntervalScores:
    """Scores with intervals.

    Attributes
    ----------
    classes : tuple of str
    accuracy, macro_auroc : Interval
    balanced_accuracy : Interval
        Mean over the classes of the share that is named right; differs from the accuracy where classes are unequal.
    guess : float
        Accuracy of always naming the most frequent class.
    confusion : (classes, classes) int
        Rows: true class, columns: predicted.
    specimens, records : int
    """

    classes: tuple[str, ...]
    accuracy: Interval
    macro_auroc: Interval
    balanced_accuracy: Interval
    guess: float
    confusion: np.ndarray
    specimens: int
    records: int

    @property
    def balanced(self) -> bool:
        """Whether all classes that occur have equally many records."""
        counts = self.confusion.sum(axis=1)
        return bool(np.ptp(counts[counts > 0]) == 0) if self.records else True


def scores(predictions: Predictions, seed: int, resamples: int = RESAMPLES) -> IntervalScores:
    """Judge predictions, with limits for as many specimens as there are."""
    weights = bootstrap_weights(predictions.specimen, seed, resamples)
    right = (predictions.predicted == predictions.truth).astype(np.float64)
    accuracy = weights @ right / weights.sum(axis=1)
    specimens = int(np.unique(predictions.specimen).size)
    return IntervalScores(
        classes=predictions.classes,
        accuracy=area_interval(accuracy, specimens),
        macro_auroc=area_interval(macro_auroc(predictions, weights), specimens),
        balanced_accuracy=area_interval(balanced_accuracy(predictions, weights), specimens),
        guess=float(np.bincount(predictions.truth).max() / predictions.truth.size),
        confusion=confusion_matrix(predictions),
        specimens=specimens,
        records=int(predictions.truth.size),
    )
