"""Features as logarithms, and minus the mean of healthy records of the same machine.

In logarithms a constant gain, and at every mesh line the gain of the transfer path, becomes a summand, which a
difference to the same machine's healthy state removes as far as speed and load are alike. Source: derived.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.healthy_references import healthy_references


def log_values(values: np.ndarray) -> np.ndarray:
    """Return natural logarithms, NaN where a feature is undefined or not positive."""
    positive = np.isfinite(values) & (values > 0.0)
    return np.where(positive, np.log(np.where(positive, values, 1.0)), np.nan)


def log_mean(values: np.ndarray) -> np.ndarray:
    """Return the mean of log features over records, (features,), NaN where no record defines one."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a feature that no record defines has no mean
        return np.asarray(np.nanmean(log_values(values), axis=0))


def healthy_referenced(matrix: FeatureMatrix) -> tuple[FeatureMatrix, np.ndarray]:
    """Return log features minus the mean of the references, for the records that have such, and which those are.

    Parameters
    ----------
    matrix : FeatureMatrix
        Features of a set.

    Returns
    -------
    FeatureMatrix
        The records with a reference.
    (records,) bool
        Which those are.
    """
    logs = log_values(matrix.values)
    references = healthy_references(matrix.labels)
    found, kept = np.full_like(logs, np.nan), np.array([rows.size > 0 for rows in references], dtype=bool)
    for row in np.flatnonzero(kept):
        found[row] = logs[row] - log_mean(matrix.values[references[row]])
    return FeatureMatrix(found, matrix.names, matrix.labels).rows(kept), kept


def reference_speed_ratio(labels: Mapping[str, np.ndarray]) -> float:
    """Return the largest ratio, 1 or more, of the speeds of a record and of one it refers to; NaN without references.

    Parameters
    ----------
    labels : mapping of str to (records,)
        As of `healthy_references`, and `speed_hz`.
    """
    speed = np.log(labels["speed_hz"].astype(np.float64))
    ratios = [np.abs(speed[rows] - speed[k]).max() for k, rows in enumerate(healthy_references(labels)) if rows.size]
    return float(np.exp(max(ratios))) if ratios else np.nan
