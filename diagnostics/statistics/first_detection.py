"""When damage is first seen over a life: an index beside what gearboxes without a pit reach, and when it leaves that.

An alarm is an inspection above what 99 % of other gearboxes' inspections without a pit stay below. Damage counts as
detected at the second alarm in a row, since single ones are chance. Source: standard practice; the index derived.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

QUIET = 0.99
"""Share of inspections without a pit, of other gearboxes, that raise no alarm."""
IN_A_ROW = 2


@dataclass(frozen=True, slots=True)
class Watch:
    """An index over the inspections of gearboxes.

    Attributes
    ----------
    index : (n,) float64
        Over its limit: from 1 on an alarm; NaN where undefined.
    detected : dict of int to int
        Row at which damage of a gearbox counts as detected; gearboxes that end before that are missing.
    """

    index: np.ndarray
    detected: dict[int, int]


def watched(index: np.ndarray, specimen: np.ndarray, whole: np.ndarray) -> Watch:
    """Return an index (n,) over its limit, and where each gearbox is detected.

    Parameters
    ----------
    index : (n,) float64
        Above 0, the larger the more damaged; inspections in the order of gearbox and age.
    specimen : (n,) int
    whole : (n,) bool
        Whether no tooth has a pit.
    """
    over = np.full(index.size, np.nan)
    detected: dict[int, int] = {}
    for unit in np.unique(specimen).tolist():
        own, others = np.flatnonzero(specimen == unit), index[whole & (specimen != unit)]
        others = others[np.isfinite(others)]
        if others.size:
            over[own] = index[own] / max(float(np.quantile(others, QUIET)), 1e-300)
            found = _first_run(over[own] >= 1.0)
            detected |= {} if found is None else {unit: int(own[found])}
    return Watch(over, detected)


def _first_run(alarms: np.ndarray) -> int | None:
    """Return the place of the last of the first so many alarms in a row."""
    row = 0
    for place, alarm in enumerate(alarms.tolist()):
        row = row + 1 if alarm else 0
        if row == IN_A_ROW:
            return place
    return None


def rise(values: np.ndarray, specimen: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Return the largest rise among indicators (n, columns) since a gearbox's first inspection, (n,).

    A rise is the logarithm of the ratio to the first inspection over its deviation among inspections without a pit;
    what falls counts as 0. NaN where no column is defined.
    """
    place = np.arange(specimen.size)
    first = np.maximum.accumulate(np.where(np.diff(specimen, prepend=specimen[0] - 1) != 0, place, 0))
    with np.errstate(invalid="ignore", divide="ignore"):
        logs = np.log(values / values[first])
    logs = np.where(np.isfinite(logs), logs, np.nan)
    spread = np.array([_spread(column[whole & (first != place)]) for column in logs.T])
    with np.errstate(invalid="ignore", divide="ignore"):
        rises = np.where(spread > 0.0, logs / spread, np.nan)
    largest = np.where(np.isfinite(rises), np.maximum(rises, 0.0), -np.inf).max(axis=1)
    return np.asarray(np.where(np.isfinite(largest), largest, np.nan))


def _spread(column: np.ndarray) -> float:
    known = column[np.isfinite(column)]
    return float(np.sqrt(np.mean(known**2))) if known.size > 1 else 0.0
