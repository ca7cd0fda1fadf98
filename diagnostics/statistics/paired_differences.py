"""Differences of each record to the healthy record of the same specimen at the same operating point.

The second design of an evaluation: same specimen before and after. What differs between gearboxes, sensors and
operating points falls out; noise and start angle do not. Source: derived.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from diagnostics.records.state_classes import HEALTHY


@dataclass(frozen=True, slots=True)
class PairedRecords:
    """Rows of records and of their healthy partners.

    Attributes
    ----------
    rows, partners : (k,) int
        A record with damage and the healthy record of the same specimen, operating point and repeat; where the healthy
        state has no such repeat, its first.
    null_rows, null_partners : (m,) int
        Two healthy records of one specimen and operating point, different repeats; empty where nothing is repeated.
    """

    rows: np.ndarray
    partners: np.ndarray
    null_rows: np.ndarray
    null_partners: np.ndarray


def paired_records(labels: Mapping[str, np.ndarray]) -> PairedRecords:
    """Return which records are compared with which.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `specimen_id`, `operating_point_id`, `repeat`, `fault`.
    """
    healthy: dict[tuple[int, int], dict[int, int]] = {}
    keys = list(zip(labels["specimen_id"].tolist(), labels["operating_point_id"].tolist(), strict=True))
    repeats = labels["repeat"].tolist()
    is_healthy = labels["fault"] == HEALTHY
    for row in np.flatnonzero(is_healthy).tolist():
        healthy.setdefault(keys[row], {}).setdefault(repeats[row], row)
    pairs, null = [], []
    for row, key in enumerate(keys):
        found = healthy.get(key)
        if not found:
            continue
        first = found[min(found)]
        if not is_healthy[row]:
            pairs.append((row, found.get(repeats[row], first)))
        elif row != first:
            null.append((row, first))
    return PairedRecords(*_columns(pairs), *_columns(null))


def _columns(pairs: list[tuple[int, int]]) -> tuple[np.ndarray, np.ndarray]:
    found = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return found[:, 0], found[:, 1]


def shares_above(difference: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return the weighted share of positive differences, zeros counting half, for every row of weights.

    Parameters
    ----------
    difference : (k,) float64
        After minus before, without NaN.
    weights : (b, k) float64
        Weights of the pairs.

    Returns
    -------
    (b,) float64
        0.5: no change; 1: always higher after. NaN without weight.
    """
    above = 0.5 + 0.5 * np.sign(difference)
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(weights @ above / total)
