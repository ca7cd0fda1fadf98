"""How well each single feature separates a state from healthy, and how it follows the damaged area.

AUC of healthy against each state and Spearman's rank correlation with the damaged area, with intervals from resampled
specimens. Features are not trained, so all specimens count; but reading off the best of hundreds of features is a
choice made on the same specimens, and its value is optimistic.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from diagnostics.indicators.feature_table import FeatureMatrix
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.evaluation import Interval, bootstrap_weights, interval, weighted_auc, weighted_midranks

RESAMPLES = 400
LARGEST_BLOCK = 4_000_000
"""Largest resamples times records; more records get fewer resamples, since their intervals are narrow anyway."""


@dataclass(frozen=True, slots=True)
class Separability:
    """One feature: AUC against healthy by state, correlation with the damaged area, share of records where defined."""

    feature: str
    auc: dict[str, Interval]
    spearman: Interval
    defined_share: float

    @property
    def strength(self) -> float:
        """Largest distance of an AUC from chance, 0 to 0.5; what the table is sorted by."""
        distance = [abs(found.value - 0.5) for found in self.auc.values() if math.isfinite(found.value)]
        return max(distance, default=0.0)


def separability(matrix: FeatureMatrix, seed: int, resamples: int = RESAMPLES) -> list[Separability]:
    """Return every feature's separability, strongest first.

    Parameters
    ----------
    matrix : FeatureMatrix
        Records of the specimens to judge on.
    seed : int
        Seed of the bootstrap.
    resamples : int
        Most resamples to draw.
    """
    records = matrix.values.shape[0]
    weights = bootstrap_weights(matrix.labels["specimen_id"], seed, min(resamples, max(50, LARGEST_BLOCK // records)))
    found = [_one(matrix, column, weights) for column in range(len(matrix.names))]
    return sorted(found, key=lambda entry: (-entry.strength, entry.feature))


def _one(matrix: FeatureMatrix, column: int, weights: np.ndarray) -> Separability:
    values, labels = matrix.values[:, column], matrix.labels
    defined = np.isfinite(values)
    states, healthy = labels["state"], labels["fault"] == HEALTHY
    auc = {}
    for state in dict.fromkeys(states[~healthy].tolist()):
        chosen = defined & (healthy | (states == state))
        specimen = labels["specimen_id"][chosen]
        area = weighted_auc(values[chosen], ~healthy[chosen], weights[:, chosen], specimen)
        auc[state] = _interval(area, labels, chosen)
    area = labels["damaged_area_mm2"]
    correlation = weighted_spearman(values[defined], area[defined], weights[:, defined])
    return Separability(matrix.names[column], auc, _interval(correlation, labels, defined), float(np.mean(defined)))


def _interval(samples: np.ndarray, labels: dict[str, np.ndarray], chosen: np.ndarray) -> Interval:
    return interval(samples, int(np.unique(labels["specimen_id"][chosen]).size))


def weighted_spearman(first: np.ndarray, second: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return Spearman's rank correlation for every row of weights; NaN where one side does not vary.

    Parameters
    ----------
    first, second : (n,) float64
        Without NaN.
    weights : (b, n) float64
        Weights of the records.

    Returns
    -------
    (b,) float64
    """
    total = weights.sum(axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        centred = [
            ranks - (weights * ranks).sum(axis=1, keepdims=True) / total
            for ranks in (weighted_midranks(first, weights), weighted_midranks(second, weights))
        ]
        covariance = (weights * centred[0] * centred[1]).sum(axis=1)
        spread = [(weights * side * side).sum(axis=1) for side in centred]
        return np.asarray(covariance / np.sqrt(spread[0] * spread[1]))


def separability_table(found: list[Separability]) -> pa.Table:
    """Return the entries as a table: value, low and high of every AUC and of the correlation."""
    rows = []
    for entry in found:
        row: dict[str, object] = {"feature": entry.feature, "defined_share": entry.defined_share}
        for name, result in [
            *((f"auc_{state}", a) for state, a in entry.auc.items()),
            ("spearman_area", entry.spearman),
        ]:
            row |= {name: result.value, f"{name}_low": result.low, f"{name}_high": result.high}
        rows.append(row)
    return pa.Table.from_pylist(rows)
