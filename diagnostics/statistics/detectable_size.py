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
from functools import lru_cache

import numpy as np

from diagnostics.statistics.evaluation import sums_before

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
    below = sums_before(weights.T[order])[1:]
    # a rounding error of the sum must not push the threshold to the next record
    reached = below >= level * below[-1] * (1.0 - 1e-12)
    found: np.ndarray = values[order][reached.argmax(axis=0)]
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
    damaged = np.flatnonzero(~healthy)
    judged, drawn = values[damaged], weights[:, damaged]
    return [_curve(judged, threshold, size[damaged], drawn) for size in sizes]


def _curve(values: np.ndarray, threshold: np.ndarray, size: np.ndarray, weights: np.ndarray) -> DetectionCurve | None:
    """Return the curve of damaged records, (n,), whose thresholds are given, (b,)."""
    medians, rows, first = _members(size.astype(np.float64).tobytes())
    if medians.size < 2:
        return None
    drawn = weights.T[rows]
    alarms = np.add.reduceat(drawn * (values[rows, None] > threshold), first, axis=0)
    return DetectionCurve(medians, isotonic(alarms.T, np.add.reduceat(drawn, first, axis=0).T))


@lru_cache(maxsize=16)
def _members(sizes: bytes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return median sizes of groups, their rows one after the other, and where each begins, of (n,) float64 as bytes.

    Most columns have the same.
    """
    size = np.frombuffer(sizes)
    positive = np.flatnonzero(size > 0.0)
    order = positive[np.argsort(size[positive], kind="stable")]
    members = _groups(order, size[order])
    if not members:
        return np.empty(0), order, order
    first = np.cumsum([0, *map(len, members[:-1])])
    return np.array([float(np.median(size[rows])) for rows in members]), np.concatenate(members), first


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
    total, weight = sums_before(sums.T), sums_before(counts.T)
    fit, whole = np.empty_like(sums), bool((counts > 0.0).all())
    highest = np.full(sums.T.shape, -np.inf)
    # mean of groups j ... k: the largest over j <= i, of which the least over k >= i is the fit of group i
    for i in range(sums.shape[1]):
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = (total[i + 1 :] - total[i]) / (weight[i + 1 :] - weight[i])
        if not whole:
            mean[~np.isfinite(mean)] = -np.inf  # a stretch without weight takes part in neither bound
        np.maximum(highest[i:], mean, out=highest[i:])
        bound = highest[i:] if whole else np.where(np.isneginf(highest[i:]), np.inf, highest[i:])
        fit[:, i] = bound.min(axis=0)
    return fit


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
