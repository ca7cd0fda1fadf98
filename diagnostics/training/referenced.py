"""Features as logarithms, and minus the mean of healthy records of the same machine.

In logarithms a constant gain, and at every mesh line the gain of the transfer path, becomes a summand, which a
difference to the same machine's healthy state removes as far as speed and load are alike. Source: derived.

Which healthy records of the same gearbox a record is compared with, so that the choice itself tells nothing.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.records.state_classes import HEALTHY

PLACE = ("specimen_id", "operating_point_id", "repeat")
"""Where a damaged record has its healthy twin."""


def healthy_references(labels: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Return the rows that every record refers to: its specimen's healthy records but one; empty where there is none.

    A healthy record leaves itself out. A damaged one leaves out the first healthy record at its operating point and
    repeat, its twin, so that neither number nor nearness of the references tells the states apart. A damaged record
    without a twin has no reference: its references would stand farther away than those of any healthy record.

    Parameters
    ----------
    labels : mapping of str to (records,)
        Columns `specimen_id`, `fault`, `operating_point_id`, `repeat`, `state_id`, `record_id`.
    """
    healthy = labels["fault"] == HEALTHY
    order = np.lexsort((labels["record_id"], labels["state_id"]))
    own: dict[int, list[int]] = {}
    twin: dict[tuple[int, ...], int] = {}
    places = list(zip(*(labels[name].tolist() for name in PLACE), strict=True))
    for row in order[healthy[order]].tolist():
        own.setdefault(places[row][0], []).append(row)
        twin.setdefault(places[row], row)
    found = []
    for row, place in enumerate(places):
        left_out = row if healthy[row] else twin.get(place)
        rows = [] if left_out is None else [other for other in own[place[0]] if other != left_out]
        found.append(np.array(rows, dtype=np.int64))
    return found


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
    return replace(matrix, values=found).rows(kept), kept


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
