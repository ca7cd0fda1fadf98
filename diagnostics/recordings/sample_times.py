"""The rate that a column of times states, or why it states none: gaps, steps back, jitter, an unknown unit.

A recorder writes the time of every sample, rounded to some digits. What lies off equal steps by more than the digits
explain is jitter; a few long steps are gaps. Coarse stamps that repeat give the rate from the first to the last change.

Samples at uneven times are laid on even ones by a cubic spline and kept to 0.4 of the new rate.
Source: standard literature (interpolation by cubic splines); limits derived.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from diagnostics.recordings.units import known_unit
from siggen.errors import UsageError, counted

FEWEST_SAMPLES = 3
ALIKE, ALIKE_STEP, GAP_STEP = 0.9, 0.5, 1.5
"""Least share of steps within this share of the median one; a step longer by that factor is then a gap."""
OFF_STEPS = 0.02
"""Jitter that is let pass, in steps: at 0.4 of the rate a phase of 0.05 rad."""
DRIFT = 1e-4
MOST_DOUBT = 1e-3
"""Of a rate from stamps that repeat."""
RATES_HZ = (100.0, 1e7)
"""Rates that recordings of gearboxes have; a time without a unit that states another one may be in other units."""
UNIX = ((1e8, 1e10, 1.0, "s"), (1e11, 1e13, 1e-3, "ms"), (1e14, 1e16, 1e-6, "us"), (1e17, 1e19, 1e-9, "ns"))
"""From, to, seconds, name: times since 1970 tell their unit by their size."""
USED_BAND = 0.4
SHOWN_DIGITS = 9


class SampleTimes(NamedTuple):
    """What a column of times states: rate [Hz], why, the times [s] from the first one where they are uneven."""

    fs_hz: float
    why: str
    uneven_s: np.ndarray | None = None


def sample_times(path: Path, name: str, column: np.ndarray, unit: str, said_hz: float | None = None) -> SampleTimes:
    """Return what a column that is a time states.

    Parameters
    ----------
    path, name : Path, str
        Named in messages.
    column : (n,) float64
    unit : str
        As stated; empty: told by the size of Unix times, else seconds, if the rate is then one of recordings.
    said_hz : float, optional
        Rate of the user; tells the unit where nothing else does.

    Raises
    ------
    UsageError
        If it jumps, steps back, or is in a unit that nothing tells.
    """
    if column.size < FEWEST_SAMPLES or not np.isfinite(column).all():
        raise UsageError(f"{path}: column {name}: a time needs a number for every sample; give the rate: --fs 51200")
    seconds, why = _seconds(path, name, column, unit, said_hz)
    times = (column - column[0]) * seconds
    steps = np.diff(times)
    span, count = float(times[-1]), times.size - 1
    _refuse_jumps(path, name, column, steps)
    if span <= 0.0:
        raise UsageError(f"{path}: column {name} is a time by its name, but does not rise; rename it, or give --fs")
    if np.mean(steps == 0.0) > 0.3:
        return _coarse(path, name, times, why)
    mean = span / count
    rounded = _resolution(column) * seconds
    off = float(np.abs(times - mean * np.arange(times.size)).max())
    local = float(np.abs(steps - mean).max())
    is_even = local <= 1.02 * rounded + 2.0 * OFF_STEPS * mean and off <= rounded + max(OFF_STEPS * mean, DRIFT * span)
    rate = _whole(1.0 / mean, 2.0 * min(off, rounded + OFF_STEPS * mean) / span + 1e-9)
    if is_even:
        return SampleTimes(rate, why)
    return SampleTimes(1.0 / mean, f"{why}, uneven by {local / mean:.2f} steps", times)


def looks_like_time(column: np.ndarray) -> bool:
    """Return whether a column rises by nearly equal steps, as nothing but a time or a counter does."""
    if column.size < FEWEST_SAMPLES or not np.isfinite(column).all():
        return False
    steps = np.diff(column)
    usual = float(np.median(steps))
    alike = np.mean(np.abs(steps - usual) <= ALIKE_STEP * usual) >= ALIKE
    return usual > 0.0 and bool((steps > 0.0).all() and alike)


def counts_samples(column: np.ndarray) -> bool:
    """Return whether a column counts up by one."""
    return bool(column.size >= FEWEST_SAMPLES and (np.diff(column) == 1.0).all() and float(column[0]).is_integer())


def resampled(times_s: np.ndarray, signal: np.ndarray, rate_hz: float) -> np.ndarray:
    """Return a signal (n,) at uneven times [s] on even ones, by a cubic spline, low-passed to 0.4 of the rate."""
    from scipy.interpolate import CubicSpline
    from scipy.signal import firwin, oaconvolve

    mean_hz = (times_s.size - 1) / float(times_s[-1])
    finer = max(1, math.ceil(mean_hz / rate_hz))
    grid_hz = finer * rate_hz
    count = math.floor(float(times_s[-1]) * grid_hz + 1e-6) + 1
    fine = CubicSpline(times_s, signal)(np.arange(count) / grid_hz)
    taps = firwin(101 * finer | 1, (USED_BAND + 0.03) * rate_hz, fs=grid_hz)
    edge = taps.size // 2
    padded = np.pad(fine, edge, mode="reflect" if fine.size > edge else "edge")
    return np.asarray(oaconvolve(padded, taps, mode="valid")[::finer])


def _seconds(path: Path, name: str, column: np.ndarray, unit: str, said_hz: float | None) -> tuple[float, str]:
    """Return what a value of the column is in seconds, and why."""
    known = known_unit(unit)
    if known is not None and known.quantity == "time":
        return known.factor, f"times of {name} in {known.text}"
    size = float(np.median(np.abs(column)))
    for low, high, seconds, text in UNIX:
        if low <= size <= high:
            return seconds, f"times of {name}, {text} since 1970"
    span = float(column[-1] - column[0])
    rate = (column.size - 1) / span if span > 0.0 else 0.0
    for seconds in (1.0, 1e-3, 1e-6):
        if said_hz and rate > 0.0 and abs(rate / seconds / said_hz - 1.0) < MOST_DOUBT:
            return seconds, f"times of {name}, as --fs says"
    if not RATES_HZ[0] <= rate <= RATES_HZ[1] and span > 0.0:
        raise UsageError(
            f"{path}: column {name} states {rate:.6g} Hz if its times are in seconds, {1e3 * rate:.6g} Hz in "
            f"milliseconds; the file does not tell. Give the rate, such as --fs {1e3 * rate:.6g}, or write the unit "
            f"behind its name: {name} [ms]"
        )
    return 1.0, f"times of {name}, taken as s"


def _refuse_jumps(path: Path, name: str, column: np.ndarray, steps: np.ndarray) -> None:
    usual = float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 0.0
    back = np.flatnonzero(steps < 0.0) + 1
    alike = np.mean(np.abs(steps - usual) <= 0.1 * usual) >= ALIKE if usual > 0.0 else False
    repeated = np.mean(steps == 0.0) > 0.3
    # the steps between stamps that repeat are all long
    limit = GAP_STEP if alike and not repeated else 2.0 * GAP_STEP
    gaps = np.flatnonzero(steps > limit * usual) + 1 if usual > 0.0 else np.empty(0, dtype=np.int64)
    jumps = np.union1d(back, gaps).astype(np.int64)
    if not jumps.size:
        return
    first, ends = int(jumps[0]), np.array([0, *jumps, column.size])
    values = np.diff(column)
    mean = float(np.delete(values, jumps - 1).mean()) if values.size > jumps.size else 0.0
    longest = int(np.diff(ends).argmax())
    more = f" (and {counted(jumps.size - 1, 'more jump')})" if jumps.size > 1 else ""
    kind = "steps back" if steps[first - 1] < 0.0 else "has a gap"
    by = f"by {values[first - 1] / mean:.0f} steps of {mean:.3g}" if mean else ""
    raise UsageError(
        f"{path}: column {name}, a time, {kind}: it jumps from {column[first - 1]:.{SHOWN_DIGITS}g} to "
        f"{column[first]:.{SHOWN_DIGITS}g} behind sample {first}, {by}{more}; allowed: equal steps. Cut the "
        f"recording: samples {ends[longest] + 1} to {ends[longest + 1]} are the longest whole piece"
    )


def _coarse(path: Path, name: str, times: np.ndarray, why: str) -> SampleTimes:
    """Return the rate of stamps that repeat: samples between the first and the last change over the time between."""
    changes = np.flatnonzero(np.diff(times) > 0.0) + 1
    samples = int(changes[-1] - changes[0]) if changes.size > 1 else 0
    span = float(times[changes[-1]] - times[changes[0]]) if samples else 0.0
    doubt = 2.0 / samples if samples else math.inf
    even = samples and np.ptp(changes - np.arange(changes.size) * samples / (changes.size - 1)) <= 0.05 * samples + 2.0
    if doubt > MOST_DOUBT or not even:
        raise UsageError(
            f"{path}: column {name} repeats its coarse times, which state the rate to {100 * min(doubt, 1.0):.2g} % "
            "only, or unevenly; give the true one in Hz, e.g. --fs 51200"
        )
    return SampleTimes(_whole(samples / span, doubt), f"{why}, coarse: from first and last, to {100 * doubt:.1g} %")


def _whole(rate: float, doubt: float) -> float:
    """Return the whole number of hertz within the doubt, since recorders have such rates."""
    return float(round(rate)) if round(rate) and abs(round(rate) / rate - 1.0) <= doubt else rate


def _resolution(column: np.ndarray) -> float:
    """Return the step of the last digit that the largest times have, or of single precision."""
    values = column[:: max(1, column.size // 4096)]
    largest = float(np.abs(values).max())
    if largest == 0.0:
        return 0.0
    single = np.spacing(np.float32(largest)) if np.array_equal(values, values.astype(np.float32)) else 0.0
    filled = values[values != 0.0]
    exponent = np.floor(np.log10(np.abs(filled)))
    for digits in range(2, 15):
        scaled = filled * 10.0 ** (digits - 1 - exponent)
        if np.abs(scaled - np.rint(scaled)).max() < 1e-4:
            return max(float(single), 10.0 ** (math.floor(math.log10(largest)) - digits + 1))
    return max(float(single), float(np.spacing(largest)))
