"""The baselines as scikit-learn estimators: `fit(X, y, groups)`, as the trainings of a report fit them.

What is chosen (C, rounds) is chosen on gearboxes that are left out, so `groups` is the gearbox of each record.
Undefined values are NaN. They stand in pipelines, searches and cross-validation as any other estimator does.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.validation import check_is_fitted

from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.training.baselines import STRENGTHS, FeatureClassifier, train_classifier
from diagnostics.training.boosting import fitted_boosting, train_boosting
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError

LEFT_OUT = 5
"""One of so many gearboxes chooses the rounds of boosting."""


class _Baseline(ClassifierMixin, BaseEstimator):  # type: ignore[misc]  # the type checker does not read sklearn
    """What both have in common: columns, classes, probabilities."""

    classes_: np.ndarray
    model_: FeatureClassifier

    @single_thread()
    def fit(self, X: Any, y: Any, groups: Any) -> Any:
        """Fit on records.

        Parameters
        ----------
        X : (n, columns)
            Such as `diagnostics.table(dataset).values`.
        y : (n,)
            Classes.
        groups : (n,)
            Gearbox of each record.

        Raises
        ------
        UsageError
            If the three differ in length.
        """
        values, target, owner = np.asarray(X, dtype=np.float64), np.asarray(y), np.asarray(groups)
        if not len(values) == len(target) == len(owner):
            raise UsageError(f"fit: received {len(values)} rows, {len(target)} classes, {len(owner)} groups")
        self.classes_, truth = np.unique(target, return_inverse=True)
        self.n_features_in_ = values.shape[1]
        _, gearbox = np.unique(owner, return_inverse=True)
        names = tuple(str(k) for k in range(values.shape[1]))
        self.model_ = self._fitted(FeatureMatrix(values, names, {"specimen_id": gearbox}), truth)
        return self

    @abstractmethod
    def _fitted(self, matrix: FeatureMatrix, truth: np.ndarray) -> FeatureClassifier:
        """Return what is fitted to places of classes (n,)."""

    def _classes(self) -> tuple[str, ...]:
        return tuple(str(name) for name in self.classes_)

    def predict_proba(self, X: Any) -> np.ndarray:
        """Return the probabilities of `classes_`, (n, classes)."""
        check_is_fitted(self)
        values = np.asarray(X, dtype=np.float64)
        return self.model_.probability(values[:, [int(name) for name in self.model_.features]])

    def predict(self, X: Any) -> np.ndarray:
        """Return the most probable class of each record, (n,)."""
        return np.asarray(self.classes_[self.predict_proba(X).argmax(axis=1)])


class LogisticBaseline(_Baseline):
    """Logistic regression on logarithms of what is positive; C is chosen on gearboxes left out.

    Parameters
    ----------
    strengths : sequence of float
        Candidates for C; a single one is taken as it is.
    """

    def __init__(self, strengths: Sequence[float] = STRENGTHS) -> None:
        self.strengths = strengths

    def _fitted(self, matrix: FeatureMatrix, truth: np.ndarray) -> FeatureClassifier:
        every, nobody = np.ones(truth.size, dtype=bool), np.zeros(truth.size, dtype=bool)
        split = SpecimenSplit(every, nobody, nobody, self._classes())
        return train_classifier(matrix, split, truth, strengths=tuple(self.strengths))


class BoostingBaseline(_Baseline):
    """Gradient boosting; rounds are chosen on every fifth gearbox, then all are fitted.

    Parameters
    ----------
    seed : int
        Of the histograms' sample.
    """

    def __init__(self, seed: int = 0) -> None:
        self.seed = seed

    def _fitted(self, matrix: FeatureMatrix, truth: np.ndarray) -> FeatureClassifier:
        left_out = matrix.labels["specimen_id"] % LEFT_OUT == LEFT_OUT - 1
        split = SpecimenSplit(~left_out, left_out, np.zeros_like(left_out), self._classes())
        chosen = train_boosting(matrix, split, self.seed, truth)
        return fitted_boosting(matrix, truth, self._classes(), self.seed, int(chosen.strength), note=chosen.note)
