"""Which columns of a recording are its time or count its samples, and the rate that a time states.

A recorder writes the time of every sample beside the signals, rounded to some digits. Its mean step is the rate, known
to the rounding of the first and last time; a whole number of hertz within that is taken, since recorders have such
rates. A column that counts up by one states no rate. Source: derived.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping
from functools import cache

import numpy as np

from diagnostics.recordings.signal_problem import LARGEST

OFF_A_STEP = 0.25
"""How far a time may lie off equal steps, in steps: 1/25600 s written with five digits behind the point is off by
0.13."""

FEWEST_SAMPLES = 3
MILLI, MICRO = re.compile(r"(^|[^a-z])m(illi)?s(ec)?($|[^a-z])"), re.compile(r"(^|[^a-z])([uµμ]|micro)s(ec)?($|[^a-z])")


def clocks(values: Mapping[str, np.ndarray], units: Mapping[str, str], leave: str) -> dict[str, float | None]:
    """Return the columns that are times, with the rate [Hz] they state, or counters, with None.

    Parameters
    ----------
    values : mapping of str to (n,) float64
        Columns by name.
    units : mapping of str to str
        Of columns whose unit is known; else the column's name says milliseconds, or a time is in seconds.
    leave : str
        Column that is no time of samples, though it rises: pulse times.
    """
    found: dict[str, float | None] = {}
    for name, column in values.items():
        if name != leave and (step := _step(column)) is not None:
            counted = step == 1.0 and bool((column == np.rint(column)).all())
            found[name] = None if counted else _rate(column, step, f"{name} {units.get(name, '')}".lower())
    return found


@cache
def say(column: str, rate_hz: float) -> None:
    """Say once that a column is the time, and which rate it states."""
    logging.getLogger(__name__).warning("note: column %s is the time; it states %g Hz", column, rate_hz)


def _step(column: np.ndarray) -> float | None:
    """Return the mean step of a column that strictly rises by equal steps; None for others."""
    if column.size < FEWEST_SAMPLES or not np.isfinite(column).all() or np.abs(column).max() > LARGEST:
        return None
    step = float(column[-1] - column[0]) / (column.size - 1)
    if not step > 0.0 or not (np.diff(column) > 0.0).all():
        return None
    off = np.abs(column - column[0] - step * np.arange(column.size)).max()
    return step if off <= OFF_A_STEP * step else None


def _rate(column: np.ndarray, step: float, text: str) -> float:
    seconds = 1e-3 if MILLI.search(text) else 1e-6 if MICRO.search(text) else 1.0
    rate = 1.0 / (step * seconds)
    off = np.abs(column - column[0] - step * np.arange(column.size)).max()
    # both ends are rounded, each by as much as any time between is off
    doubt = 2.0 * off / (step * column.size) + 1e-9
    return float(round(rate)) if abs(round(rate) / rate - 1.0) <= doubt else rate
