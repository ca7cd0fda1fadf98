"""Scores of a classifier: shares named right and areas, with limits that hold for few specimens too.

Resampled specimens alone give limits that are too short where specimens are few, and none at all at 0 and 1. Accuracy
and macro-AUROC are treated as shares by `area_interval`; how often its limits hold: docs/understand/audit.md.

Interval of an AUC or a share from resampled gearboxes that does not shrink to nothing where all are won.

Near 1 the bootstrap is too narrow: where every damaged record lies above every healthy one, so does it in every
resample. So its limits are widened to those of Clopper and Pearson for a proportion among as many independent gearboxes
as the resamples' variance stands for, and not fewer than there are. Source: Clopper and Pearson 1934, with the
effective sample size of Korn and Graubard (Survey Methodology 24, 1998, 193-201); its least value, the gearboxes of the
smaller class, since the variance of an AUC is at most A(1 - A)/min(m, n): Birnbaum and Klose 1957. Where the resamples
scatter less than that, more gearboxes count than there are, since each is compared with all of the other class; so
limits between the ends may be narrower than those of the gearboxes counted. A share of records is treated like an
AUC: 0 and 1 get the exact limits of so many gearboxes. No AUC gets a higher lower limit than 1
itself would, which is 0.025^(1/n). The combination is derived; its coverage is tested.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from diagnostics.statistics.evaluation import (
    LEVEL,
    RESAMPLES,
    Interval,
    Predictions,
    balanced_accuracy,
    bootstrap_weights,
    confusion_matrix,
    fewest_gearboxes,
    interval,
    macro_auroc,
    weighted_auc,
)


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
