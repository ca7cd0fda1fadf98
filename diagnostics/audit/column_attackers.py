"""Attackers that read a table: its best single column, one given column, or all columns together.

Scores of a linear classifier with very many columns: ridge regression in its dual form, penalty chosen inside.

The penalty is the one whose scores on left-out gearboxes of the training records rank best by squared error; leaving a
gearbox out has a closed form. Source: ridge regression, standard literature; leaving out groups: (1 - H_gg)^-1 e_g,
derived.
"""

from __future__ import annotations

import numpy as np

from diagnostics.audit.held_out import DEALS, Attacker, Trial, Verdicts
from diagnostics.statistics.evaluation import column_auc

PENALTIES = np.logspace(-4.0, 3.0, 8)
"""Times the mean squared length of a standardised record."""


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


def ridge_scores(product: np.ndarray, positive: np.ndarray, specimen: np.ndarray, train: np.ndarray) -> np.ndarray:
    """Return the scores of the records that were not trained on.

    Parameters
    ----------
    product : (records, records) float64
        As of `products`.
    positive : (turns, records) bool
        Damaged records, one row for each way of stating them.
    specimen : (records,) int
        Gearbox of each record.
    train : (records,) bool
        Records to train on.

    Returns
    -------
    (turns, records not trained on) float64
    """
    inner = product[np.ix_(train, train)]
    across = product[np.ix_(~train, train)]
    mean = inner.mean(axis=0)
    centred = inner - mean[None, :] - inner.mean(axis=1)[:, None] + inner.mean()
    across = across - mean[None, :] - across.mean(axis=1)[:, None] + inner.mean()
    target = _balanced(positive[:, train]).T
    values, vectors = np.linalg.eigh(centred)
    values = np.maximum(values, 0.0)
    scale = float(values.mean()) or 1.0
    rotated = vectors.T @ target
    errors = _left_out_errors(values, vectors, rotated, target, specimen[train], PENALTIES * scale)
    best = PENALTIES[np.argmin(errors, axis=0)]
    scores = across @ (vectors @ (rotated / (values[:, None] + best * scale)))
    return np.asarray(scores.T)


def _balanced(positive: np.ndarray) -> np.ndarray:
    """Return targets whose mean is zero in every row."""
    share = positive.mean(axis=1, keepdims=True)
    return np.asarray(np.where(positive, 1.0 - share, -share))


def _left_out_errors(
    values: np.ndarray,
    vectors: np.ndarray,
    rotated: np.ndarray,
    target: np.ndarray,
    specimen: np.ndarray,
    penalties: np.ndarray,
) -> np.ndarray:
    """Return the squared error on left-out gearboxes, (penalties, turns); rotated and target are (records, turns).

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


def best_column(name: str, values: np.ndarray, names: tuple[str, ...]) -> Attacker:
    """Return the attacker that takes the column, and its direction, that is best on the gearboxes to learn from.

    Parameters
    ----------
    name : str
    values : (records, columns) float64
        Records with NaN are not asked about; columns that are never defined do not count.
    names : (columns,) tuple of str
    """
    kept, usable = _defined(values)
    chosen = tuple(name for name, is_kept in zip(names, kept, strict=True) if is_kept)
    values = values[:, kept]

    def attack(trial: Trial) -> Verdicts:
        area = column_auc(values[trial.rows[trial.train]], trial.positive[:, trial.train])
        best = np.argmax(np.abs(area - 0.5), axis=1)
        turned = np.where(np.take_along_axis(area, best[:, None], axis=1) >= 0.5, 1.0, -1.0)
        return Verdicts(turned * values[trial.rows[~trial.train]][:, best].T, chosen[best[0]])

    return Attacker(name, attack, usable & (values.shape[1] > 0), int(values.shape[1]), DEALS)


def all_columns(name: str, values: np.ndarray) -> Attacker:
    """Return the attacker that weighs all columns by ridge regression.

    Parameters
    ----------
    name : str
    values : (records, columns) float64
        Records with NaN are not asked about; columns that are never defined do not count.
    """
    kept, usable = _defined(values)
    place = np.cumsum(usable) - 1
    product = products(values[np.ix_(usable, kept)]) if usable.any() and kept.any() else np.zeros((0, 0))

    def attack(trial: Trial) -> Verdicts:
        own = place[trial.rows]
        return Verdicts(ridge_scores(product[np.ix_(own, own)], trial.positive, trial.specimen, trial.train))

    return Attacker(name, attack, usable & kept.any(), int(kept.sum()), DEALS)


def _defined(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which columns are ever defined, and which records are defined in all of these."""
    finite = np.isfinite(values)
    kept = finite.any(axis=0)
    return kept, finite[:, kept].all(axis=1)
