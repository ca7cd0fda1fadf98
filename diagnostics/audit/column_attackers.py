"""Attackers that read a table: its best single column, one given column, or all columns together."""

from __future__ import annotations

import numpy as np

from diagnostics.audit.held_out import DEALS
from diagnostics.audit.ridge_scores import products, ridge_scores
from diagnostics.audit.trial import Attacker, Trial, Verdicts
from diagnostics.statistics.evaluation import column_auc


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
