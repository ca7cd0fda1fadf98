"""Columns of formats that state rate, unit and name of every signal in the file itself."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from diagnostics.recordings.recorded_columns import Columns


class StatedSignal(NamedTuple):
    """One signal: its possible names, the shortest first; values (n,); rate [Hz] and unit where stated."""

    names: tuple[str, ...]
    values: np.ndarray
    fs_hz: float | None = None
    unit: str | None = None


def stated_columns(signals: Sequence[StatedSignal]) -> Columns:
    """Return the signals of the highest stated rate, and those without one, under the shortest names that differ.

    A recorder that samples a temperature slowly beside the vibration writes several rates into one file. One recording
    has one rate, so slower signals are left out.
    """
    rates = [signal.fs_hz for signal in signals if signal.fs_hz]
    highest = max(rates, default=None)
    kept = [s for s in signals if not s.fs_hz or highest is None or math.isclose(s.fs_hz, highest, rel_tol=1e-9)]
    names = _names([signal.names for signal in kept])
    values = {name: signal.values for name, signal in zip(names, kept, strict=True)}
    units = {name: signal.unit for name, signal in zip(names, kept, strict=True) if signal.unit}
    return Columns(values, highest, units=units)


def rate_from_increment(increment_s: object, digits: int = 15) -> float | None:
    """Return the rate [Hz] of a time step [s]; None if it is no step.

    Parameters
    ----------
    increment_s : object
        What the file holds.
    digits : int
        Decimal digits that the format keeps of the step. A whole number of hertz whose step has the same digits is
        taken, since recorders have such rates: type 58 keeps 1/51200 s as 1.95313e-05.
    """
    step = float(increment_s) if isinstance(increment_s, (int, float, np.number)) else math.nan
    if not (math.isfinite(step) and 0.0 < step < 1e6 and 1.0 / step < 1e12):
        return None
    whole = round(1.0 / step)
    same = whole > 0 and f"{1.0 / whole:.{digits - 1}e}" == f"{step:.{digits - 1}e}"
    return float(whole) if same else 1.0 / step


def _names(known: list[tuple[str, ...]]) -> list[str]:
    for level in range(min((len(names) for names in known), default=0)):
        chosen = [names[level] for names in known]
        if len(set(chosen)) == len(chosen) and all(chosen):
            return chosen
    return [str(number) for number in range(1, len(known) + 1)]
