"""A record resampled to equal steps of shaft angle, with the angle taken from the once-per-revolution pulses.

The angle is a cubic spline through the exact pulse times (never the nominal speed: a droop of 0.2 % already destroys an
average over many revolutions). Amplitudes at the angle steps come from a quintic B-spline. Source: order tracking by
interpolation is standard literature.

Slow speed variation of a record, from its shaft pulses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from diagnostics.signal.quintic_spline import spline_coefficients, spline_values

SLOW_BELOW_HZ = 2.5
HALF_POWER = 0.443
"""A moving average of length T has lost half of the power at 0.443 / T."""

SAMPLES_PER_TOOTH = 128
"""Angle steps per mesh period: 128 keeps the band of a 51.2 kHz record above a mesh frequency of 400 Hz and one
definition of every indicator below it."""

EDGE_SAMPLES = 1024


def speed_variation_percent(tacho_s: np.ndarray) -> float:
    """Return the standard deviation of the speed below 2.5 Hz over its mean [%]; NaN with fewer than three pulses.

    Parameters
    ----------
    tacho_s : (k,) float64
        Times of one pulse per revolution [s].

    Notes
    -----
    The mean speed of each revolution is smoothed by a moving average that halves the power at 2.5 Hz. Source: derived.
    """
    if len(tacho_s) < 3:
        return math.nan
    speed_hz = 1.0 / np.diff(np.asarray(tacho_s, dtype=np.float64))
    width = min(max(1, round(HALF_POWER / SLOW_BELOW_HZ * float(speed_hz.mean()))), speed_hz.size)
    slow = np.convolve(speed_hz, np.full(width, 1.0 / width), mode="valid")
    return 100.0 * float(slow.std() / speed_hz.mean())


@dataclass(frozen=True, slots=True)
class AngleGrid:
    """Times of equal steps of pinion angle between the first and the last pulse.

    Attributes
    ----------
    time_s : (revolutions * samples_per_revolution,) float64
        Times of the angle steps since the start of the record; the first step lies on the first pulse.
    revolutions : int
        Whole pinion revolutions between the first and the last pulse.
    samples_per_revolution : int
        Angle steps per pinion revolution.
    slowest_hz : float
        Lowest mean speed of one revolution; it sets the band limit against aliasing.
    """

    time_s: np.ndarray
    revolutions: int
    samples_per_revolution: int
    slowest_hz: float


def angle_grid(tacho_s: np.ndarray, samples_per_revolution: int) -> AngleGrid:
    """Return the times of equal angle steps from the times of one pulse per pinion revolution.

    Parameters
    ----------
    tacho_s : (k,) float64
        Pulse times, increasing; from four pulses on the interpolation is cubic, below linear.
    samples_per_revolution : int
        Angle steps per revolution.

    Raises
    ------
    ValueError
        If fewer than two pulses came or their times do not increase.
    """
    pulses = np.asarray(tacho_s, dtype=np.float64)
    if pulses.size < 2 or not np.all(np.diff(pulses) > 0):
        raise ValueError(f"received {pulses.size} pulse times; at least 2 increasing ones are needed for an angle")
    fraction = np.arange(samples_per_revolution) / samples_per_revolution
    coefficients = _polynomials(pulses)
    time_s = coefficients[0][:, None] * fraction
    for row in coefficients[1:-1]:
        time_s += row[:, None]
        time_s *= fraction
    time_s += coefficients[-1][:, None]
    return AngleGrid(time_s.ravel(), pulses.size - 1, samples_per_revolution, float(1.0 / np.diff(pulses).max()))


def shaft_grid(tacho_s: np.ndarray, samples_per_revolution: int, turns: Fraction) -> AngleGrid | None:
    """Return the times of equal angle steps of a shaft that is geared to the one with the pulses.

    Parameters
    ----------
    tacho_s : (k,) float64
        Pulse times, as of `angle_grid`; both angles are zero at the first pulse.
    samples_per_revolution : int
        Angle steps per revolution of the geared shaft.
    turns : Fraction
        Its revolutions per revolution of the shaft with the pulses, exact: steps do not drift apart from teeth.

    Returns
    -------
    AngleGrid, optional
        Its revolutions are those of the geared shaft; None where that turns less than once.
    """
    pulses = np.asarray(tacho_s, dtype=np.float64)
    revolutions = math.floor((pulses.size - 1) * turns)
    if pulses.size < 2 or revolutions < 1:
        return None
    steps_per_pulse = turns.numerator * samples_per_revolution
    whole, rest = np.divmod(np.arange(revolutions * samples_per_revolution) * turns.denominator, steps_per_pulse)
    fraction = rest / steps_per_pulse
    time_s = np.zeros(fraction.size)
    for row in _polynomials(pulses):
        time_s = time_s * fraction + row[whole]
    slowest_hz = float(turns) / float(np.diff(pulses).max())
    return AngleGrid(time_s, revolutions, samples_per_revolution, slowest_hz)


def geared_pulses(tacho_s: np.ndarray, turns: Fraction) -> np.ndarray:
    """Return the times of whole turns of a shaft that is geared to the one with the pulses, from the first pulse on.

    Parameters
    ----------
    tacho_s : (k,) float64
        Pulse times, as of `angle_grid`.
    turns : Fraction
        Turns of the geared shaft per turn of the shaft with the pulses.

    Returns
    -------
    (1 + whole turns,) float64
        Pulses that are fewer than two, or do not increase, come back as they are.
    """
    pulses = np.asarray(tacho_s, dtype=np.float64)
    if pulses.size < 2 or not np.all(np.diff(pulses) > 0):
        return pulses
    count = math.floor((pulses.size - 1) * turns) + 1
    place = np.arange(count) * float(1 / turns)
    whole = np.minimum(place.astype(np.int64), pulses.size - 2)
    time_s = np.zeros(count)
    for row in _polynomials(pulses):
        time_s = time_s * (place - whole) + row[whole]
    return time_s


def _polynomials(pulses: np.ndarray) -> np.ndarray:
    """Return the coefficients of time over revolutions, highest power first, (powers, revolutions)."""
    if pulses.size < 4:
        return np.stack([np.diff(pulses), pulses[:-1]])
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(np.arange(pulses.size), pulses).c)


def resample_to_angle(signal: np.ndarray, fs_hz: float, grid: AngleGrid) -> np.ndarray:
    """Return the record at the angle steps, limited to the band that the steps can carry.

    The error is below 3e-5 of the amplitude up to 0.25 fs and below 1e-3 up to 0.4 fs (tested), apart from the
    outermost milliseconds of the record.

    Parameters
    ----------
    signal : (n,) float
        The record, sampled at `fs_hz` from time zero.
    fs_hz : float
        Sampling frequency [Hz].
    grid : AngleGrid
        Where to evaluate.

    Returns
    -------
    (revolutions * samples_per_revolution,) float64
    """
    limit = min(grid.samples_per_revolution * grid.slowest_hz / fs_hz, 1.0) / 2.0
    spline = spline_coefficients(_extended(np.asarray(signal, dtype=np.float64)), limit)
    return spline_values(spline, grid.time_s * fs_hz + EDGE_SAMPLES)


def _extended(signal: np.ndarray) -> np.ndarray:
    """Continue the record on both sides by tapered odd reflection, so that the FFT meets no step at its ends."""
    from scipy.fft import next_fast_len

    edge = min(EDGE_SAMPLES, signal.size - 1)
    fade = 0.5 + 0.5 * np.cos(np.pi * np.arange(1, edge + 1) / edge)
    length = next_fast_len(signal.size + 2 * EDGE_SAMPLES, real=True)
    padded = np.zeros(length)
    end = EDGE_SAMPLES + signal.size
    padded[EDGE_SAMPLES:end] = signal
    padded[EDGE_SAMPLES - edge : EDGE_SAMPLES] = ((2 * signal[0] - signal[1 : edge + 1]) * fade)[::-1]
    padded[end : end + edge] = (2 * signal[-1] - signal[-2 : -edge - 2 : -1]) * fade
    return padded
