"""p-values of one indicator after another, and their correction for how many were looked at.

Units are specimens, never records. Other specimens: Mann-Whitney on specimen means; healthy and damaged records of one
gearbox are positively correlated, which makes this conservative. Same specimen: Wilcoxon's signed ranks of the mean
differences. Source: standard literature; Holm 1979; Benjamini & Hochberg 1995.

Differences of each record to the healthy record of the same specimen at the same operating point.

The second design of an evaluation: same specimen before and after. What differs between gearboxes, sensors and
operating points falls out; noise and start angle do not. Source: derived.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.records.state_classes import HEALTHY

FEWEST_SPECIMENS = 3


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


def specimen_means(values: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the mean of the values of each specimen, (specimens,)."""
    _, index = np.unique(specimen, return_inverse=True)
    return np.asarray(np.bincount(index, values) / np.bincount(index))


def two_sample_p(samples: Sequence[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Return the two-sided p-values of Mann-Whitney's test on specimen means; NaN below three specimens a side.

    Parameters
    ----------
    samples : sequence of ((h,), (d,) float64)
        Healthy and damaged specimens of each test.

    Returns
    -------
    (tests,) float64
    """
    from scipy.stats import mannwhitneyu

    found = np.full(len(samples), np.nan)
    judged = {k: pair for k, pair in enumerate(samples) if min(map(len, pair)) >= FEWEST_SPECIMENS}
    for alike in _alike(
        {k: np.concatenate(pair) for k, pair in judged.items()}, {k: len(p[0]) for k, p in judged.items()}
    ):
        healthy, damaged = (np.stack([judged[k][side] for k in alike]) for side in (0, 1))
        found[alike] = mannwhitneyu(damaged, healthy, alternative="two-sided", axis=1).pvalue
    return found


def paired_p(differences: Sequence[np.ndarray]) -> np.ndarray:
    """Return the two-sided p-values of Wilcoxon's signed-rank test on specimen means; NaN below three specimens.

    Parameters
    ----------
    differences : sequence of (k,) float64
        Of the specimens of each test.

    Returns
    -------
    (tests,) float64
    """
    from scipy.stats import wilcoxon

    found = np.array([np.nan if own.size < FEWEST_SPECIMENS or own.any() else 1.0 for own in differences])
    judged = {k: own for k, own in enumerate(differences) if own.size >= FEWEST_SPECIMENS and own.any()}
    # a zero beside the amounts: one that is zero itself counts as a tie
    amounts = {k: np.append(np.abs(own), 0.0) for k, own in judged.items()}
    for alike in _alike(amounts, dict.fromkeys(judged, 0)):
        found[alike] = wilcoxon(np.stack([judged[k] for k in alike]), alternative="two-sided", axis=1).pvalue
    return found


def _alike(values: Mapping[int, np.ndarray], sides: Mapping[int, int]) -> list[list[int]]:
    """Return tests that can be done together: of one size, without ties, for which scipy takes another method."""
    groups: dict[tuple[int, int, int], list[int]] = {}
    for k, own in values.items():
        is_tied = np.unique(own).size < own.size
        groups.setdefault((own.size, sides[k], k if is_tied else -1), []).append(k)
    return list(groups.values())


def holm(p_values: np.ndarray) -> np.ndarray:
    """Return p-values adjusted by Holm: below a, no false discovery at all with probability 1 - a.

    Parameters
    ----------
    p_values : (n,) float64
        NaN stays NaN and does not count.
    """
    order = _ascending(p_values)
    factor = order.size - np.arange(order.size)
    return _scattered(p_values.size, order, np.maximum.accumulate(p_values[order] * factor))


def false_discovery(p_values: np.ndarray) -> np.ndarray:
    """Return p-values adjusted by Benjamini and Hochberg: below q, a share q of the discoveries is false on average.

    Parameters
    ----------
    p_values : (n,) float64
        NaN stays NaN and does not count.
    """
    from scipy.stats import false_discovery_control

    defined = np.isfinite(p_values)
    found = np.full(p_values.size, np.nan)
    if defined.any():
        found[defined] = false_discovery_control(p_values[defined], method="bh")
    return found


def _ascending(p_values: np.ndarray) -> np.ndarray:
    """Return the positions of the defined values in ascending order."""
    defined = np.flatnonzero(np.isfinite(p_values))
    return defined[np.argsort(p_values[defined], kind="stable")]


def _scattered(size: int, order: np.ndarray, adjusted: np.ndarray) -> np.ndarray:
    found = np.full(size, np.nan)
    found[order] = np.minimum(adjusted, 1.0)
    return found


def smallest_paired_p(specimens: int) -> float:
    """Return the smallest p-value that the signed-rank test can give with so many specimens."""
    return float(2.0 ** (1 - specimens))
