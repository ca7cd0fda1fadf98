"""Separation of a state from healthy over the signal-to-noise ratio of the records.

Records are sorted by their ratio into groups of equal count; each group's AUC compares its damaged with its healthy
records. Source: derived.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.statistics.evaluation import Interval, interval, weighted_auc

GROUPS = 4
RECORDS_PER_CLASS = 4


@dataclass(frozen=True, slots=True)
class NoiseCurve:
    """Median signal-to-noise ratio [dB] of each group, and the AUC there."""

    snr_db: tuple[float, ...]
    auc: tuple[Interval, ...]


def noise_curve(
    values: np.ndarray, positive: np.ndarray, snr_db: np.ndarray, specimen: np.ndarray, weights: np.ndarray
) -> NoiseCurve:
    """Return the AUC over the signal-to-noise ratio; groups with fewer than four records of either class are left out.

    Parameters
    ----------
    values : (n,) float64
        Indicator, larger means more damage; without NaN.
    positive : (n,) bool
        Records of the state; the others are healthy.
    snr_db : (n,) float64
        Signal-to-noise ratio of each record [dB].
    specimen : (n,) int
        Specimen of each record.
    weights : (b, n) float64
        Bootstrap weights.
    """
    order = np.flatnonzero(np.isfinite(snr_db))
    order = order[np.argsort(snr_db[order], kind="stable")]
    middle, areas = [], []
    for rows in np.array_split(order, GROUPS):
        count = int(positive[rows].sum())
        if min(count, rows.size - count) < RECORDS_PER_CLASS:
            continue
        samples = weighted_auc(values[rows], positive[rows], weights[:, rows], specimen[rows])
        middle.append(float(np.median(snr_db[rows])))
        areas.append(interval(samples, int(np.unique(specimen[rows]).size)))
    return NoiseCurve(tuple(middle), tuple(areas))
