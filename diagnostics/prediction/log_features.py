"""Features as logarithms, and minus the mean of healthy records of the same machine.

In logarithms a constant gain, and at every mesh line the gain of the transfer path, becomes a summand, which a
difference to the same machine's healthy state removes as far as speed and load are alike. Source: derived.
"""

from __future__ import annotations

import warnings

import numpy as np

from diagnostics.feature_table import FeatureMatrix

HEALTHY = "healthy"


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
    """Return log features minus the mean of the specimen's healthy records, for the records that have such.

    A healthy record must not be its own reference, and a damaged one must not have a closer reference than its healthy
    twin, or the difference itself would tell the states apart. So the healthy record at the same operating point and
    repeat is left out of the mean for every state.

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
    labels, logs = matrix.labels, log_values(matrix.values)
    healthy = labels["fault"] == HEALTHY
    found, kept = np.full_like(logs, np.nan), np.zeros(len(logs), dtype=bool)
    for row in range(len(logs)):
        same = (labels["operating_point_id"] == labels["operating_point_id"][row]) & (
            labels["repeat"] == labels["repeat"][row]
        )
        chosen = healthy & (labels["specimen_id"] == labels["specimen_id"][row]) & ~same
        if chosen.any():
            found[row], kept[row] = logs[row] - log_mean(matrix.values[chosen]), True
    return FeatureMatrix(found, matrix.names, labels).rows(kept), kept
