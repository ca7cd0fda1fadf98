"""Cohen's d between two groups and of paired differences, for every row of bootstrap weights.

Cliff's delta is 2 AUC - 1 and therefore not given again. Source: Cohen 1988, standard literature.
"""

from __future__ import annotations

import numpy as np


def cohens_d(values: np.ndarray, positive: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return (mean of positives - mean of the rest) / pooled standard deviation, (b,); NaN where nothing varies.

    Parameters
    ----------
    values : (n,) float64
        Without NaN.
    positive : (n,) bool
        Which records belong to the second group.
    weights : (b, n) float64
        Weights of the records.
    """
    parts = [_mean_and_variance(values[group], weights[:, group]) for group in (positive, ~positive)]
    (high, high_variance, high_weight), (low, low_variance, low_weight) = parts
    with np.errstate(invalid="ignore", divide="ignore"):
        pooled = (high_variance * high_weight + low_variance * low_weight) / (high_weight + low_weight - 2.0)
        return np.where(pooled > 0.0, (high - low) / np.sqrt(pooled), np.nan)


def paired_d(difference: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return mean / standard deviation of differences, (b,); NaN where they do not vary.

    Parameters
    ----------
    difference : (k,) float64
        After minus before, without NaN.
    weights : (b, k) float64
        Weights of the pairs.
    """
    mean, variance, weight = _mean_and_variance(difference, weights)
    with np.errstate(invalid="ignore", divide="ignore"):
        unbiased = variance * weight / (weight - 1.0)
        return np.where(unbiased > 0.0, mean / np.sqrt(unbiased), np.nan)


def _mean_and_variance(values: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    total = weights.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = weights @ values / total
        variance = (weights * np.square(values[None, :] - mean[:, None])).sum(axis=1) / total
    return mean, variance, total
