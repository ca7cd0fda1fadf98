"""Detectors that take a table: its best single column, all columns by ridge regression, and any classifier.

Ridge regression is in its dual form, since columns are many. Its penalty is the one whose scores of left-out gearboxes
have the least squared error; leaving a gearbox out has a closed form. Source: ridge regression, standard literature;
leaving out groups: (1 - H_gg)^-1 e_g, derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from inspect import signature
from typing import Any

import numpy as np

from diagnostics.judging.evaluation import Entry, distance
from diagnostics.statistics.evaluation import column_auc

PENALTIES = np.logspace(-4.0, 3.0, 8)
"""Times the mean squared length of a standardised record."""

SMALLEST = 1e-12
"""Probability below which odds are cut off."""


class BestColumn:
    """The column, and its direction, that is best on the gearboxes to learn from.

    Parameters
    ----------
    names : sequence of str
        Of the columns.
    pooled : bool
        Whether scores of several folds are ranked together: then they are distances from the healthy records.
    """

    def __init__(self, names: Sequence[str], *, pooled: bool = False) -> None:
        self.names, self.pooled = names, pooled

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> BestColumn:  # noqa: ARG002
        """Choose; X (n, columns) without NaN, y (n,) or (ways, n)."""
        area = column_auc(X, y)
        self.best = np.argmax(np.abs(area - 0.5), axis=-1)
        self.turned = np.where(np.take_along_axis(area, self.best[..., None], axis=-1) >= 0.5, 1.0, -1.0)
        self.basis = self.names[int(np.ravel(self.best)[0])]
        self.healthy = X[~y, self.best] if self.pooled else None
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the column, turned so that damage is large."""
        values = X[:, self.best].T
        return np.asarray(self.turned * (values if self.healthy is None else distance(values, self.healthy)))


class GroupRidge:
    """Ridge regression on products of all pairs of records, (records, records); X are their places."""

    def __init__(self, product: np.ndarray) -> None:
        self.product = product

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> GroupRidge:
        """Fit to places (n,) and y (ways, n)."""
        self.learnt, inner = X, self.product[np.ix_(X, X)]
        self.mean, self.middle = inner.mean(axis=0), inner.mean()
        centred = inner - self.mean[None, :] - inner.mean(axis=1)[:, None] + self.middle
        share = y.mean(axis=1, keepdims=True)
        target = np.where(y, 1.0 - share, -share).T
        values, vectors = np.linalg.eigh(centred)
        values = np.maximum(values, 0.0)
        scale = float(values.mean()) or 1.0
        rotated = vectors.T @ target
        errors = _left_out_errors(values, vectors, rotated, target, groups, PENALTIES * scale)
        self.weights = vectors @ (rotated / (values[:, None] + PENALTIES[np.argmin(errors, axis=0)] * scale))
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the scores, (ways, m)."""
        across = self.product[np.ix_(X, self.learnt)]
        return np.asarray(((across - self.mean - across.mean(axis=1)[:, None] + self.middle) @ self.weights).T)


def _left_out_errors(
    values: np.ndarray,
    vectors: np.ndarray,
    rotated: np.ndarray,
    target: np.ndarray,
    specimen: np.ndarray,
    penalties: np.ndarray,
) -> np.ndarray:
    """Return the squared error on left-out gearboxes, (penalties, ways); rotated and target are (records, ways).

    With one gearbox nothing is left to fit where it is left out: the errors rank the largest penalty first.
    """
    owners = np.unique(specimen)
    if owners.size < 2:
        return np.repeat(1.0 / penalties[:, None], target.shape[1], axis=1)
    shrunk = values / (values + penalties[:, None])
    left = target - vectors @ (shrunk[:, :, None] * rotated)
    total = np.zeros((penalties.size, target.shape[1]))
    for owner in owners:
        rows = np.flatnonzero(specimen == owner)
        # the mean is fitted with the rest: 1/n beside the hat matrix
        hat = (vectors[rows] * shrunk[:, None, :]) @ vectors[rows].T + 1.0 / len(target)
        total += np.square(np.linalg.solve(np.eye(rows.size) - hat, left[:, rows])).sum(axis=1)
    return total


class Odds:
    """Any classifier of scikit-learn as a detector: its decision function, else the logarithm of the odds of damage.

    Parameters
    ----------
    classifier
        With `fit(X, y)` or `fit(X, y, groups)`, and `decision_function(X)` or `predict_proba(X)`.
    """

    def __init__(self, classifier: Any) -> None:
        self.classifier = classifier

    def fit(self, X: np.ndarray, y: np.ndarray, groups: np.ndarray) -> Odds:
        """Fit to X (n, columns) and y (n,)."""
        given = (X, y, groups) if "groups" in signature(self.classifier.fit).parameters else (X, y)
        self.classifier.fit(*given)
        return self

    def score(self, X: np.ndarray) -> np.ndarray:
        """Return the score, (m,)."""
        if hasattr(self.classifier, "decision_function"):
            return np.asarray(self.classifier.decision_function(X))
        damage = self.classifier.predict_proba(X)[:, 1]
        return np.asarray(np.log(np.maximum(damage, SMALLEST)) - np.log(np.maximum(1.0 - damage, SMALLEST)))


def products(values: np.ndarray) -> np.ndarray:
    """Return products of standardised records, (records, records); columns that do not vary do not count.

    Parameters
    ----------
    values : (records, columns) float64
        Without NaN. Mean and spread come from all records, without their states.
    """
    centred = values - values.mean(axis=0)
    spread = centred.std(axis=0)
    kept = spread > 1e-9 * np.maximum(np.abs(values).max(axis=0), 1e-300)
    scaled = centred[:, kept] / spread[kept]
    return np.asarray(scaled @ scaled.T / max(int(kept.sum()), 1))


def best_column(name: str, values: np.ndarray, names: Sequence[str]) -> Entry:
    """Return the entry that takes the best column; records with NaN are not asked, undefined columns do not count.

    Parameters
    ----------
    name : str
    values : (records, columns) float64
    names : (columns,) sequence of str
    """
    kept, usable = _defined(values)
    chosen = [name for name, is_kept in zip(names, kept, strict=True) if is_kept]
    return Entry(name, lambda: BestColumn(chosen), values[:, kept], usable & bool(chosen), len(chosen))


def all_columns(name: str, values: np.ndarray) -> Entry:
    """Return the entry that weighs all columns by ridge regression; parameters as of `best_column`."""
    kept, usable = _defined(values)
    product = products(values[np.ix_(usable, kept)]) if usable.any() and kept.any() else np.zeros((0, 0))
    return Entry(name, lambda: GroupRidge(product), np.cumsum(usable) - 1, usable & kept.any(), int(kept.sum()))


def _defined(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which columns are ever defined, and which records are defined in all of these."""
    finite = np.isfinite(values)
    kept = finite.any(axis=0)
    return kept, finite[:, kept].all(axis=1)
