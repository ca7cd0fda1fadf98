"""The one judgement of every indicator: AUC of each state against healthy, its direction, how it follows the damage.

Report, ranking and audit read it from here, so that an indicator has one AUC. Intervals come from resampled specimens.
Indicators are not trained, so all specimens count; but reading off the best of hundreds is a choice made on the same
specimens, and its value is optimistic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.gear_train import PAIR, GearNames
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.evaluation import CentredRanks, Interval, centred_ranks, weighted_auc
from diagnostics.statistics.judged_records import RESAMPLES, JudgedRecords, judged_records
from diagnostics.statistics.multiple_tests import shares_above


@dataclass(frozen=True, slots=True)
class Separability:
    """One indicator in one channel.

    Attributes
    ----------
    feature : str
        Its column.
    auc : dict of str to Interval
        AUC of every state against healthy, between other specimens; below 0.5 where it falls.
    spearman : Interval
        Rank correlation with the damaged area.
    defined_share : float
        Share of records where it is defined.
    direction : int
        1 where it rises with damage, -1 where it falls: mean change of the same specimens, else of the AUC; 0 unknown.
    samples, same : dict of str to (resamples + 1,)
        Resamples of the AUC, and of the share of pairs of one specimen in which it is higher after, by state.
    gears : GearNames
        What columns are called after.
    """

    feature: str
    auc: dict[str, Interval]
    spearman: Interval
    defined_share: float
    direction: int = 0
    samples: dict[str, np.ndarray] = field(default_factory=dict, repr=False)
    same: dict[str, np.ndarray] = field(default_factory=dict, repr=False)
    gears: GearNames = PAIR

    @property
    def strength(self) -> float:
        """Largest distance of an AUC from chance, 0 to 0.5; what the table is sorted by."""
        distance = [abs(found.value - 0.5) for found in self.auc.values() if math.isfinite(found.value)]
        return max(distance, default=0.0)

    def turned(self, state: str) -> Interval:
        """Return the AUC of a state, turned by the direction so that 1 is perfect."""
        found = self.auc[state]
        if (self.direction or (-1 if found.value < 0.5 else 1)) > 0:
            return found
        return Interval(1.0 - found.value, 1.0 - found.high, 1.0 - found.low)


def separability(matrix: FeatureMatrix, seed: int, resamples: int = RESAMPLES) -> list[Separability]:
    """Return every indicator's separability, strongest first.

    Parameters
    ----------
    matrix : FeatureMatrix
        Records of the specimens to judge on.
    seed : int
        Seed of the bootstrap.
    resamples : int
        Most resamples to draw.
    """
    records = judged_records(matrix.labels, seed, resamples)
    columns = zip(matrix.names, matrix.values.T, strict=True)
    found = [
        replace(separability_of(records, name, values, records.centred_values(values)), gears=matrix.gears)
        for name, values in columns
    ]
    return sorted(found, key=lambda entry: (-entry.strength, entry.feature))


def separability_of(records: JudgedRecords, name: str, values: np.ndarray, ranks: CentredRanks) -> Separability:
    """Return the separability of one column, (records,), whose centred ranks are given."""
    labels, defined = records.labels, np.isfinite(values)
    healthy = labels["fault"] == HEALTHY
    change = values[records.pairs.rows] - values[records.pairs.partners]
    auc, samples, same = {}, {}, {}
    for state in records.states:
        rows = np.flatnonzero(defined & (healthy | (labels["state"] == state)))
        weights, specimen = records.weights[:, rows], labels["specimen_id"][rows]
        samples[state] = weighted_auc(values[rows], ~healthy[rows], weights, specimen)
        auc[state] = records.interval(samples[state], rows)
        kept = np.isfinite(change) & (labels["state"][records.pairs.rows] == state)
        same[state] = shares_above(change[kept], records.weights[:, records.pairs.rows[kept]])
    rows = np.flatnonzero(defined)
    correlation = rank_correlation(ranks, records.centred("damaged_area_mm2", rows))
    direction = _sign([own[0] for own in same.values()]) or _sign([found.value for found in auc.values()])
    spearman = records.interval(correlation, rows)
    return Separability(name, auc, spearman, float(np.mean(defined)), direction, samples, same)


def _sign(shares: Sequence[float]) -> int:
    """Return which side of 0.5 the shares lie on together, 0 where that is not known."""
    return int(np.sign(round(sum(share - 0.5 for share in shares if math.isfinite(share)), 12)))


def best_by_state(found: Sequence[Separability]) -> dict[str, Separability]:
    """Return by state the indicator of the largest AUC, turned by its direction; states without any are left out."""
    best: dict[str, Separability] = {}
    for entry in found:
        for state in entry.auc:
            area = entry.turned(state).value
            if math.isfinite(area) and (state not in best or area > best[state].turned(state).value):
                best[state] = entry
    return best


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
    return rank_correlation(centred_ranks(first, weights), centred_ranks(second, weights))


def rank_correlation(first: CentredRanks, second: CentredRanks) -> np.ndarray:
    """Return what `weighted_spearman` does of ranks of the same records and weights."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((first.weighted * second.ranks).sum(axis=1) / np.sqrt(first.spread * second.spread))
