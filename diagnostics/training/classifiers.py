"""Logistic regression and gradient boosting on indicators, as estimators of scikit-learn.

`fit(X, y, groups)`: what is chosen (C, rounds) is chosen on gearboxes that are left out, so `groups` is the gearbox of
each record. Undefined values are NaN. They stand in pipelines, searches and cross-validation as any other estimator.

Logistic regression: no column is left out; the strength of the penalty is what few gearboxes can choose, by
cross-validation over whole gearboxes. Source: standard literature (ridge penalty, grouped cross-validation).

Boosting: undefined indicators need no replacement, since a tree sends them to the side that suits. Source: standard
literature (Friedman 2001), as in scikit-learn's histogram version.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.pipeline import make_pipeline
from sklearn.utils.validation import check_is_fitted

from diagnostics.base.single_thread import single_thread
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.statistics.calibration import SMALLEST_PROBABILITY, fitted_temperature
from diagnostics.statistics.evaluation import Predictions, macro_auroc
from diagnostics.training.feature_classifier import (
    DEFAULT_STRENGTH,
    FeatureClassifier,
    PreparedRecords,
    state_index,
    told,
    with_logarithms,
)
from diagnostics.training.splits import SpecimenSplit
from siggen.errors import UsageError

STRENGTHS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)
"""Candidates for C, the inverse strength of regularisation, strongest regularisation first."""

FOLDS = 4
MOST_TREES, DEFAULT_TREES = 100, 60
LEFT_OUT = 5
"""One of so many gearboxes chooses the rounds of boosting where none is set aside."""


class _Baseline(ClassifierMixin, BaseEstimator):  # type: ignore[misc]  # the type checker does not read sklearn
    """What both have in common: what comes in, classes, probabilities."""

    classes_: np.ndarray
    pipeline_: Any
    columns_: np.ndarray
    logs_: np.ndarray
    strength_: float
    note_ = ""

    @single_thread()
    def fit(self, X: Any, y: Any, groups: Any, aside: Any = None) -> Any:
        """Fit on records.

        Parameters
        ----------
        X : (n, columns)
            Such as `diagnostics.table(dataset).values`.
        y : (n,)
            Classes.
        groups : (n,)
            Gearbox of each record.
        aside : (n,) bool, optional
            Records that only choose (C, rounds).

        Raises
        ------
        UsageError
            If they differ in length.
        """
        values, target, owner = np.asarray(X, dtype=np.float64), np.asarray(y), np.asarray(groups)
        if not len(values) == len(target) == len(owner):
            raise UsageError(f"fit: received {len(values)} rows, {len(target)} classes, {len(owner)} groups")
        self.classes_ = np.unique(target)
        self.n_features_in_ = values.shape[1]
        self._learn(values, target, np.unique(owner, return_inverse=True)[1], aside)
        return self

    @abstractmethod
    def _learn(self, values: np.ndarray, truth: np.ndarray, gearbox: np.ndarray, aside: np.ndarray | None) -> None:
        """Set `pipeline_`, the places of the columns that it takes, which are logarithms, and what was chosen."""

    def predict_proba(self, X: Any) -> np.ndarray:
        """Return the probabilities of `classes_`, (n, classes)."""
        check_is_fitted(self)
        values = np.asarray(X, dtype=np.float64)[:, self.columns_]
        return told(self.pipeline_, with_logarithms(values, self.logs_), self.classes_)

    def predict(self, X: Any) -> np.ndarray:
        """Return the most probable class of each record, (n,)."""
        return np.asarray(self.classes_[self.predict_proba(X).argmax(axis=1)])


class LogisticBaseline(_Baseline):
    """Logistic regression on logarithms; C is chosen on gearboxes left out.

    Parameters
    ----------
    strengths : sequence of float
        Candidates for C; a single one is taken as it is.
    take_logarithms : bool
        Whether columns that are positive in all records to learn from are taken as logarithms.
    """

    def __init__(self, strengths: Sequence[float] = STRENGTHS, *, take_logarithms: bool = True) -> None:
        self.strengths = strengths
        self.take_logarithms = take_logarithms

    def _learn(self, values: np.ndarray, truth: np.ndarray, gearbox: np.ndarray, aside: np.ndarray | None) -> None:
        self.strength_ = self.strengths[0]
        if len(self.strengths) > 1:
            self.strength_, self.note_ = _chosen_strength(
                values, truth, gearbox, tuple(self.strengths), take_logarithms=self.take_logarithms
            )
        learn = slice(None) if aside is None else ~aside
        own = PreparedRecords(values[learn], take_logarithms=self.take_logarithms)
        self.pipeline_ = make_pipeline(*own.steps, own.fitted(truth[learn], self.strength_))
        self.columns_, self.logs_ = np.arange(values.shape[1]), own.logs


def _chosen_strength(
    values: np.ndarray, truth: np.ndarray, gearbox: np.ndarray, strengths: Sequence[float], *, take_logarithms: bool
) -> tuple[float, str]:
    """Return the C of largest macro-AUROC on gearboxes left out (ties: stronger penalty), or why none was chosen."""
    classes, own = np.unique(truth, return_inverse=True)
    fold, ones = gearbox % FOLDS, np.ones((1, own.size))
    if any(np.unique(own[fold != k]).size < 2 for k in np.unique(fold)):
        note = f"too few training specimens to choose by: C = {DEFAULT_STRENGTH} was taken as it is"
        return DEFAULT_STRENGTH, note
    held_out = np.zeros((len(strengths), own.size, classes.size))
    for k in np.unique(fold):
        rest = PreparedRecords(values[fold != k], take_logarithms=take_logarithms)
        ready = rest.of(values[fold == k])
        for number, strength in enumerate(strengths):
            held_out[number, fold == k] = told(rest.fitted(truth[fold != k], strength), ready, classes)
    said = (Predictions(tuple(map(str, classes)), own, probability, gearbox) for probability in held_out)
    areas = [float(np.nan_to_num(macro_auroc(found, ones)[0], nan=0.5)) for found in said]
    best = max(range(len(areas)), key=lambda k: (round(areas[k], 12), -k))
    return strengths[best], ""


class BoostingBaseline(_Baseline):
    """Gradient boosting; the number of rounds is chosen on gearboxes left out.

    Parameters
    ----------
    seed : int
        Of the histograms' sample.
    rounds : int, optional
        Taken as they are; else those that lose least on what is set aside, or on every fifth gearbox, before all are
        fitted.
    """

    def __init__(self, seed: int = 0, rounds: int | None = None) -> None:
        self.seed = seed
        self.rounds = rounds

    def _learn(self, values: np.ndarray, truth: np.ndarray, gearbox: np.ndarray, aside: np.ndarray | None) -> None:
        chooses = gearbox % LEFT_OUT == LEFT_OUT - 1 if aside is None else aside
        trees = self.rounds
        if trees is None and not chooses.any():
            trees = DEFAULT_TREES
            self.note_ = f"no validation specimens: {trees} boosting rounds were not chosen but taken as they are"
        if trees is None:
            trees = _chosen_trees(_defined(values, ~chooses), truth, chooses, self.seed)
        learn = slice(None) if aside is None else ~aside
        self.columns_ = np.flatnonzero(np.isfinite(values[learn]).any(axis=0))
        self.logs_ = np.zeros(self.columns_.size, dtype=bool)
        self.pipeline_ = _model(trees, self.seed).fit(_defined(values, learn)[learn], truth[learn])
        self.strength_ = float(trees)


def _defined(values: np.ndarray, learn: Any) -> np.ndarray:
    """Return the columns that some records to learn from define: one that is never defined has no histogram."""
    return values[:, np.isfinite(values[learn]).any(axis=0)]


def _model(trees: int, seed: int) -> Any:
    # small trees and leaves: a few hundred records of a few dozen specimens carry no deeper ones
    return HistGradientBoostingClassifier(
        learning_rate=0.1,
        max_iter=trees,
        max_leaf_nodes=6,
        min_samples_leaf=5,
        l2_regularization=1.0,
        max_features=0.2,
        early_stopping=False,
        random_state=seed,
    )


def _chosen_trees(values: np.ndarray, truth: np.ndarray, chooses: np.ndarray, seed: int) -> int:
    """Return the rounds of lowest log loss on the records that choose (n,) bool."""
    model = _model(MOST_TREES, seed).fit(values[~chooses], truth[~chooses])
    known = np.isin(truth[chooses], model.classes_)
    if not known.any():
        return DEFAULT_TREES
    right = np.arange(int(known.sum())), np.searchsorted(model.classes_, truth[chooses][known])
    staged = model.staged_predict_proba(values[chooses])
    losses = [-np.log(np.maximum(said[known][right], SMALLEST_PROBABILITY)).mean() for said in staged]
    return 1 + int(np.argmin(losses))


def trained(model: _Baseline, matrix: FeatureMatrix, split: SpecimenSplit) -> FeatureClassifier:
    """Return a classifier learnt from training specimens, whose choices and temperature suit the validation specimens.

    Parameters
    ----------
    model : LogisticBaseline or BoostingBaseline
        C is chosen on training and validation specimens left out in turn, rounds on validation specimens.
    matrix : FeatureMatrix
        All records.
    split : SpecimenSplit
        Whose specimens are which.
    """
    truth = state_index(matrix, split.classes)
    used = split.train | split.validation
    seen = matrix.rows(used)
    model.fit(seen.values, truth[used], seen.groups, split.validation[used])
    names = tuple(matrix.names[k] for k in model.columns_)
    logs = tuple(name for name, log in zip(names, model.logs_.tolist(), strict=True) if log)
    found = FeatureClassifier(model.pipeline_, names, split.classes, model.strength_, model.note_, logarithms=logs)
    if not split.validation.any():
        return found
    said = replace(found.predict(matrix.rows(split.validation)), truth=truth[split.validation])
    return replace(found, temperature=fitted_temperature(said))
