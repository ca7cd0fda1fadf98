"""Smallest damage that an indicator finds at a given rate of false alarms.

The threshold is the quantile of healthy records that the rate leaves above it. Damaged records are sorted by size into
groups, of one size each where the set holds few sizes, else of equal count; the share of alarms per group is made to
rise with size by isotonic regression, and the size at which it reaches the wanted share is read between the groups'
medians, on a logarithmic axis. Source: probability of detection (a50, a90), standard literature of non-destructive
testing; isotonic instead of logistic: derived, since no indicator has to follow a logistic curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

GROUPS = 12
RECORDS_PER_GROUP = 5


@dataclass(frozen=True, slots=True)
class DetectionCurve:
    """Share of alarms over size: (g,) median sizes and (b, g) shares, one row per resample, rising with size."""

    size: np.ndarray
    share: np.ndarray


def weighted_quantile(values: np.ndarray, weights: np.ndarray, level: float) -> np.ndarray:
    """Return the smallest value with at least `level` of the weight at or below it, (b,) for every row of weights.

    Parameters
    ----------
    values : (n,) float64
        Without NaN.
    weights : (b, n) float64
        Weights of the records.
    level : float
        Between 0 and 1.
    """
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[:, order], axis=1)
    # a rounding error of the sum must not push the threshold to the next record
    reached = below >= level * below[:, -1:] * (1.0 - 1e-12)
    found: np.ndarray = values[order][reached.argmax(axis=1)]
    return found


def detection_curve(
    values: np.ndarray, healthy: np.ndarray, size: np.ndarray, weights: np.ndarray, false_alarms: float
) -> DetectionCurve | None:
    """Return the share of alarms over size; None with fewer than two groups.

    Parameters
    ----------
    values : (n,) float64
        Indicator, larger means more damage; without NaN.
    healthy : (n,) bool
        Which records set the threshold; all others are damaged.
    size : (n,) float64
        Damaged area or profile length of each record, positive where damaged.
    weights : (b, n) float64
        Weights of the records, of bootstrap resamples of the specimens; the threshold is drawn anew in each.
    false_alarms : float
        Share of healthy records above the threshold.
    """
    return detection_curves(values, healthy, [size], weights, false_alarms)[0]


def detection_curves(
    values: np.ndarray, healthy: np.ndarray, sizes: Sequence[np.ndarray], weights: np.ndarray, false_alarms: float
) -> list[DetectionCurve | None]:
    """Return the curve over each of several sizes of the same damage; parameters as of `detection_curve`."""
    if not healthy.any():
        return [None] * len(sizes)
    threshold = weighted_quantile(values[healthy], weights[:, healthy], 1.0 - false_alarms)
    alarms = weights * (values > threshold[:, None])
    return [_curve(alarms, ~healthy & (size > 0.0), size, weights) for size in sizes]


def _curve(alarms: np.ndarray, chosen: np.ndarray, size: np.ndarray, weights: np.ndarray) -> DetectionCurve | None:
    damaged = np.flatnonzero(chosen)
    order = damaged[np.argsort(size[damaged], kind="stable")]
    members = _groups(order, size[order])
    if len(members) < 2:
        return None
    belongs = np.zeros((size.size, len(members)))
    for group, rows in enumerate(members):
        belongs[rows, group] = 1.0
    medians = np.array([float(np.median(size[rows])) for rows in members])
    # sums of whole numbers: a product of matrices gives them without a rounding error
    return DetectionCurve(medians, isotonic(alarms @ belongs, weights @ belongs))


def _groups(order: np.ndarray, size: np.ndarray) -> list[np.ndarray]:
    """Return rows in order of size as groups: one per size where a ladder has few sizes, else of like count.

    Records of one size stay together: groups within a size would rise by chance, and the last of them would be taken.
    """
    rises = np.flatnonzero(np.diff(size) > 1e-9 * size[:-1]) + 1
    levels = np.split(order, rises)
    if len(levels) <= GROUPS and min(map(len, levels)) >= RECORDS_PER_GROUP:
        return levels
    groups = min(GROUPS, order.size // RECORDS_PER_GROUP)
    cuts = order.size * np.arange(1, groups) // max(groups, 1)
    if not rises.size or not cuts.size:
        return [order] if order.size else []
    nearest = rises[np.abs(rises[:, None] - cuts).argmin(axis=0)]
    return np.split(order, np.unique(nearest))


def isotonic(sums: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Return the rising least-squares fit to group means, (b, g), by the min-max formula.

    Parameters
    ----------
    sums, counts : (b, g) float64
        Sum and weight of each group; a group without weight takes the value of the one below.
    """
    total, weight = _sums_from_start(sums), _sums_from_start(counts)
    fit = np.empty_like(sums)
    highest = np.full(sums.T.shape, -np.inf)
    # mean of groups j ... k: the largest over j <= i, of which the least over k >= i is the fit of group i
    for i in range(sums.shape[1]):
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = (total[i + 1 :] - total[i]) / (weight[i + 1 :] - weight[i])
        mean[~np.isfinite(mean)] = -np.inf  # a stretch without weight takes part in neither bound
        np.maximum(highest[i:], mean, out=highest[i:])
        fit[:, i] = np.where(np.isneginf(highest[i:]), np.inf, highest[i:]).min(axis=0)
    return fit


def _sums_from_start(values: np.ndarray) -> np.ndarray:
    """Return the sums of the groups before each, (g + 1, b): resamples stand together in memory."""
    found = np.zeros((values.shape[1] + 1, values.shape[0]))
    np.cumsum(values.T, axis=0, out=found[1:])
    return found


def size_at(curve: DetectionCurve, share: float) -> np.ndarray:
    """Return the size at which the share of alarms is reached, (b,); infinite where the largest damage does not.

    Where the group of the smallest damage reaches it already, that group's size: an upper bound.
    """
    reached = curve.share >= share - 1e-12
    first = reached.argmax(axis=1)
    rows = np.arange(first.size)
    before = np.maximum(first - 1, 0)
    low, high = curve.share[rows, before], curve.share[rows, first]
    with np.errstate(invalid="ignore", divide="ignore"):
        part = np.where(first > 0, (share - low) / (high - low), 1.0)
    logarithm = np.log(curve.size)
    found = np.exp(logarithm[before] + part * (logarithm[first] - logarithm[before]))
    return np.where(reached.any(axis=1), found, np.inf)
