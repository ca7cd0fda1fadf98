"""How well single indicators find a state: the best of all that were tried, and the best when others chose it.

The best of hundreds is chosen on the gearboxes that it is judged on, so its AUC is optimistic. The second number is
not: gearboxes are dealt into two halves, one chooses indicator and direction, the other judges; mean over both ways of
ten deals. AUC and direction are those of `diagnostics.statistics.separability`. Source: derived.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.evaluation import Interval, weighted_auc
from diagnostics.statistics.separability import best_by_state, separability

DEALS = 10
RESAMPLES = 200
FEWEST_SPECIMENS = 4


@dataclass(frozen=True, slots=True)
class BestIndicator:
    """The best single indicator for one state.

    Attributes
    ----------
    column : str
        `<indicator>__<channel>`.
    auc : Interval
        Its AUC, turned; chosen on the same gearboxes, so optimistic.
    held_out : float
        AUC of the best indicator on gearboxes that did not choose it; NaN with too few gearboxes.
    tried : int
        How many columns it is the best of.
    """

    column: str
    auc: Interval
    held_out: float
    tried: int


def best_indicators(matrix: FeatureMatrix, seed: int = 0) -> dict[str, BestIndicator]:
    """Return the best single indicator of every damaged state.

    Parameters
    ----------
    matrix : FeatureMatrix
        All indicators of all records.
    seed : int
        Seed of deals and bootstrap.
    """
    found = separability(matrix, seed, RESAMPLES)
    tried = sum(any(math.isfinite(area.value) for area in entry.auc.values()) for entry in found)
    weights = dealt_halves(matrix.labels["specimen_id"], seed)
    return {
        state: BestIndicator(entry.feature, entry.turned(state), held_out_auc(matrix, state, weights), tried)
        for state, entry in best_by_state(found).items()
    }


def dealt_halves(specimen: np.ndarray, seed: int) -> np.ndarray:
    """Return which records belong to each half of the gearboxes, (2 deals, records); rows 2k, 2k + 1 are one deal."""
    unique, index = np.unique(specimen, return_inverse=True)
    rows = []
    for deal in range(DEALS):
        half = generator(seed, Purpose.HALVES, deal).permutation(unique.size) % 2 == 1
        rows += [half[index], ~half[index]]
    return np.array(rows, dtype=np.float64)


def held_out_auc(matrix: FeatureMatrix, state: str, halves: np.ndarray) -> float:
    """Return the AUC of the indicator that is best on one half, with its direction there, on the other half.

    Parameters
    ----------
    matrix : FeatureMatrix
        All indicators of all records.
    state : str
        Against the healthy records.
    halves : (2 deals, records) float64
        As of `dealt_halves`.
    """
    labels = matrix.labels
    chosen = (labels["fault"] == HEALTHY) | (labels["state"] == state)
    specimen, positive = labels["specimen_id"][chosen], labels["state"][chosen] == state
    if min(_count(specimen[positive]), _count(specimen[~positive])) < FEWEST_SPECIMENS:
        return math.nan
    areas = np.stack(
        [_areas(values, positive, halves[:, chosen], specimen) for values in matrix.values[chosen].T], axis=0
    )
    return _mean_of_the_chosen(areas)


def _count(specimen: np.ndarray) -> int:
    return int(np.unique(specimen).size)


def _areas(values: np.ndarray, positive: np.ndarray, weights: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the AUC of one column on every half; NaN where it is undefined in a record."""
    if not np.isfinite(values).all():
        return np.full(len(weights), np.nan)
    return weighted_auc(values, positive, weights, specimen)


def _mean_of_the_chosen(areas: np.ndarray) -> float:
    """Return the mean, over halves, of the AUC (columns, halves) of the column that the other half chose."""
    found = []
    for half in range(areas.shape[1]):
        other = areas[:, half ^ 1]
        if not np.isfinite(other).any():
            continue
        best = int(np.nanargmax(np.abs(other - 0.5)))
        area = areas[best, half]
        found.append(area if other[best] > 0.5 else 1.0 - area)
    defined = [area for area in found if math.isfinite(area)]
    return float(np.mean(defined)) if defined else math.nan
