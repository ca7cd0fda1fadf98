"""Gaps and jumps in a column of times: samples that a recorder lost, or a clock that was set.

A column is a time with gaps if nearly all of its steps are alike and some are longer. Steps back are gaps where the
column's name says that it is a time; elsewhere they may be an angle that begins anew every turn. Source: derived.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from diagnostics.recordings.recorded_columns import LARGEST, OWN_TACHO, Columns
from siggen.errors import UsageError, counted

ALIKE, OFF = 0.9, 0.5
"""Least share of steps that are the median one but for this share of it."""
NAMED = re.compile(r"(^|[^a-z])(t|time|times|timestamp|zeit)($|[^a-z])")
TURNED = re.compile(r"(^|[^a-z])(rad|deg|rev)($|[^a-z])")
"""A column in one of these units counts turns, however evenly it rises."""


def refuse_gaps(path: Path, found: Columns) -> None:
    """Refuse a file in which a column of times jumps.

    Raises
    ------
    UsageError
        If one does; names the first jump, and the longest piece without one.
    """
    samples = max(column.size for column in found.values.values())
    for name, column in found.values.items():
        said = f"{name} {found.units.get(name, '')}".lower()
        if name == OWN_TACHO or column.size < samples or TURNED.search(said):
            continue
        if (jumps := time_jumps(column, bool(NAMED.search(said)))).size:
            raise UsageError(f"{path}: {_sentence(name, column, jumps)}")


def time_jumps(column: np.ndarray, named: bool) -> np.ndarray:
    """Return the indices (k,) of samples behind a gap or a step back, if a column (n,) is a time with such.

    `named`: whether its name says that it is one.
    """
    if column.size < 2 or not np.isfinite(column).all() or np.abs(column).max() > LARGEST:
        return np.empty(0, dtype=np.int64)
    steps = np.diff(column)
    usual = float(np.median(steps))
    alike = np.abs(steps - usual) <= OFF * usual
    if usual <= 0.0 or np.mean(alike) < ALIKE or not (named or (steps > 0.0).all()):
        return np.empty(0, dtype=np.int64)
    return np.flatnonzero((steps > (1.0 + OFF) * usual) | (steps <= 0.0)) + 1


def _sentence(name: str, column: np.ndarray, jumps: np.ndarray) -> str:
    first, ends = int(jumps[0]), np.array([0, *jumps, column.size])
    steps = np.diff(column)
    usual = float(np.delete(steps, jumps - 1).mean())  # times are rounded: the median step is not the mean one
    longest = int(np.diff(ends).argmax())
    more = f" (and {counted(jumps.size - 1, 'more jump')})" if jumps.size > 1 else ""
    return (
        f"column {name} jumps from {column[first - 1]:.9g} to {column[first]:.9g} behind sample {first}, by "
        f"{steps[first - 1] / usual:.0f} steps of {usual:.3g}{more}; allowed: equal steps. Cut the "
        f"recording: samples {ends[longest] + 1} to {ends[longest + 1]} are the longest whole piece"
    )
