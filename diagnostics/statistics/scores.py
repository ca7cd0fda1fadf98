"""Scores of a classifier: shares named right and areas, with limits that hold for few specimens too.

Resampled specimens alone give limits that are too short where specimens are few, and none at all at 0 and 1. Accuracy
and macro-AUROC are treated as shares by `area_interval`; how often its limits hold: docs/understand/audit.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.statistics.area_interval import area_interval
from diagnostics.statistics.evaluation import (
    RESAMPLES,
    Interval,
    Predictions,
    balanced_accuracy,
    bootstrap_weights,
    confusion_matrix,
    macro_auroc,
)


@dataclass(frozen=True, slots=True)
class Scores:
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


def scores(predictions: Predictions, seed: int, resamples: int = RESAMPLES) -> Scores:
    """Judge predictions, with limits for as many specimens as there are."""
    weights = bootstrap_weights(predictions.specimen, seed, resamples)
    right = (predictions.predicted == predictions.truth).astype(np.float64)
    accuracy = weights @ right / weights.sum(axis=1)
    specimens = int(np.unique(predictions.specimen).size)
    return Scores(
        classes=predictions.classes,
        accuracy=area_interval(accuracy, specimens),
        macro_auroc=area_interval(macro_auroc(predictions, weights), specimens),
        balanced_accuracy=area_interval(balanced_accuracy(predictions, weights), specimens),
        guess=float(np.bincount(predictions.truth).max() / predictions.truth.size),
        confusion=confusion_matrix(predictions),
        specimens=specimens,
        records=int(predictions.truth.size),
    )
