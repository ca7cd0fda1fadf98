"""The columns of a recorded file by its suffix; nothing in a file is ever executed.

Which columns of a recording are its time or count its samples, and the rate that a time states.

A recorder writes the time of every sample beside the signals, rounded to some digits. Its mean step is the rate, known
to the rounding of the first and last time; a whole number of hertz within that is taken, since recorders have such
rates. A column that counts up by one states no rate. Source: derived.

What makes a channel of a recording unusable, and the way out of it.
"""

from __future__ import annotations

import logging
import re
import shlex
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from diagnostics.recordings.columns_apart import columns_read_apart
from diagnostics.recordings.file_columns import READERS
from diagnostics.recordings.recorded_columns import LARGEST, OWN_TACHO, Columns
from diagnostics.recordings.time_gaps import TURNED, refuse_gaps
from diagnostics.recordings.units import known_unit, unit_of_name
from diagnostics.records.record_problems import LARGEST_CLIPPED_SHARE, clipped_share
from siggen.errors import UsageError

PULSE_SHARE = 0.5
"""A vibration that stands at its ends for more than half the time is none; pulses do so nearly always."""

OFF_A_STEP = 0.25
"""How far a time may lie off equal steps, in steps: 1/25600 s written with five digits behind the point is off by
0.13."""

FEWEST_SAMPLES = 3
MILLI, MICRO = re.compile(r"(^|[^a-z])m(illi)?s(ec)?($|[^a-z])"), re.compile(r"(^|[^a-z])([uµμ]|micro)s(ec)?($|[^a-z])")

TIMES_ALIKE = 1e-3
"""Rates of two time columns of one file that are the same, rounded differently; an angle that rises evenly is not."""


def signal_problem(signal: np.ndarray, column: str) -> str:
    """Return why a channel (n,) of a column cannot be used, or nothing: not finite, too large, constant, clipped."""
    broken = int(np.count_nonzero(~np.isfinite(signal)))
    if broken:
        return f"{broken} of {signal.size} samples are not finite; cut the recording to where it is whole"
    if signal.size == 0 or signal.min() == signal.max():
        return f"constant over all {signal.size} samples; check sensor and cable, or name another column"
    largest = float(np.abs(signal).max())
    if largest > LARGEST:
        return (
            f"received values up to {largest:.3g}, allowed: up to {LARGEST:g}; the file is damaged, or its unit wrong"
        )
    share = clipped_share(signal)
    if share > PULSE_SHARE:
        return (
            f"{share:.2%} of the samples stand at {signal.min():g} or {signal.max():g}, as pulses do; if these are "
            f"those of the tacho, say so: --tacho {shlex.quote(column)}; else name the channels: --channel NAME=COLUMN"
        )
    if share > LARGEST_CLIPPED_SHARE:
        return (
            f"{share:.2%} of the samples stand clipped at {signal.min():g} or {signal.max():g}, up to "
            f"{LARGEST_CLIPPED_SHARE:.1%} is allowed; record again with a wider range"
        )
    return ""


def clocks(values: Mapping[str, np.ndarray], units: Mapping[str, str], leave: str) -> dict[str, float | None]:
    """Return the columns that are times, with the rate [Hz] they state, or counters and angles, with None.

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
    samples = max((column.size for name, column in values.items() if name != leave), default=0)
    for name, column in values.items():
        # a time has one value per sample: a record's list of angles or teeth may rise evenly too
        if name != leave and column.size == samples and (step := _step(column)) is not None:
            said = f"{name} {units.get(name, '')}".lower()
            counted = TURNED.search(said) or (step == 1.0 and bool((column == np.rint(column)).all()))
            found[name] = None if counted else _rate(column, step, said)
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


def read_columns(path: Path, row: int | None = None) -> Columns:
    """Read a file by its suffix, one of `READERS`.

    Parameters
    ----------
    path : Path
        The file.
    row : int, optional
        Which row of a Parquet file with one record per row, from zero.

    Raises
    ------
    UsageError
        If it does not exist, has another suffix, cannot be read, holds no column of numbers, or one of times jumps.
    """
    if path.is_dir():
        raise UsageError(f"{path}: is a folder; give the file of one recording")
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    if path.suffix.lower() not in READERS:
        raise UsageError(
            f"{path}: received suffix {path.suffix!r}; allowed are {', '.join(READERS)}. Convert the recording."
        )
    found = columns_read_apart(path, row)
    if not found.values:
        raise UsageError(f"{path}: holds no column of numbers")
    found = replace(found, units=_named_units(path, found))
    refuse_gaps(path, found)
    return _with_clocks(found)


def _named_units(path: Path, found: Columns) -> dict[str, str]:
    """Return the units that the file states of its columns, beside them or in their names."""
    units = dict(found.units)
    for name in found.values:
        in_name = unit_of_name(name)[1]
        if known_unit(in_name) is None:
            continue
        if name in units and known_unit(units[name]) not in (None, known_unit(in_name)):
            raise UsageError(f"{path}: column {name} names {in_name}, its row of units {units[name]}; correct the file")
        units.setdefault(name, in_name)
    return units


def _with_clocks(found: Columns) -> Columns:
    """Return what a file holds with its times and counters, and the rate where times agree on one."""
    known = clocks(found.values, found.units, OWN_TACHO)
    rates = {name: rate for name, rate in known.items() if rate is not None}
    if found.fs_hz is not None or not rates:
        return replace(found, clocks=known)
    if max(rates.values()) > min(rates.values()) * (1.0 + TIMES_ALIKE):
        return replace(found, clocks=known)
    name, rate = next(iter(rates.items()))
    say(name, rate)
    return replace(found, fs_hz=rate, clocks=known)
