"""p-values of one indicator after another, and their correction for how many were looked at.

Units are specimens, never records. Other specimens: Mann-Whitney on specimen means; healthy and damaged records of one
gearbox are positively correlated, which makes this conservative. Same specimen: Wilcoxon's signed ranks of the mean
differences. Source: standard literature; Holm 1979; Benjamini & Hochberg 1995.
"""

from __future__ import annotations

import math

import numpy as np

FEWEST_SPECIMENS = 3


def specimen_means(values: np.ndarray, specimen: np.ndarray) -> np.ndarray:
    """Return the mean of the values of each specimen, (specimens,)."""
    _, index = np.unique(specimen, return_inverse=True)
    return np.asarray(np.bincount(index, values) / np.bincount(index))


def two_sample_p(healthy: np.ndarray, damaged: np.ndarray) -> float:
    """Return the two-sided p-value of Mann-Whitney's test on specimen means; NaN below three specimens a side."""
    if min(healthy.size, damaged.size) < FEWEST_SPECIMENS:
        return math.nan
    from scipy.stats import mannwhitneyu

    return float(mannwhitneyu(damaged, healthy, alternative="two-sided").pvalue)


def paired_p(difference: np.ndarray) -> float:
    """Return the two-sided p-value of Wilcoxon's signed-rank test on specimen means; NaN below three specimens."""
    if difference.size < FEWEST_SPECIMENS:
        return math.nan
    if not difference.any():
        return 1.0
    from scipy.stats import wilcoxon

    return float(wilcoxon(difference, alternative="two-sided").pvalue)


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
