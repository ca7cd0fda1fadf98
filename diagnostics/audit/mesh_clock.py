"""Pulses of the tacho, and mesh lines of a raw record against them: drift, and lines at quarters of the mesh frequency.

A gear turns with its shaft. So the phase of a mesh line, beside the angle that the pulses give, stays where it is over
a record, whatever damage there is: a drift is one of clocks. A tone at a fraction of the mesh frequency comes from no
single tooth, which is heard at every turn and so on all orders of the shaft alike: such a line is compared with those
one to three turns beside it. Source: derived.
"""

from __future__ import annotations

import math

import numpy as np

SEGMENTS, HARMONICS = 8, 3
FEWEST_PULSES = 2 * SEGMENTS
QUARTERS, HIGHEST_MESH = 4, 8
REACH, BESIDE = 2, 3
"""Bins around a line of which the highest counts, and turns on either side that it is compared with."""

TINY = 1e-30


def clock_drift(signal: np.ndarray, fs_hz: float, pulses_s: np.ndarray, teeth: int) -> float:
    """Return by what share of its speed the mesh runs ahead of the pulses; NaN with too few of these.

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    pulses_s : (k,) float64
        One per turn [s].
    teeth : int
    """
    if pulses_s.size < FEWEST_PULSES:
        return math.nan
    first, last = (int(pulses_s[k] * fs_hz) + 1 for k in (0, -1))
    length = (min(last, signal.size) - first) // SEGMENTS
    if first < 0 or length < 1:
        return math.nan
    kept = slice(first, first + length * SEGMENTS)
    turns = np.interp(np.arange(kept.start, kept.stop) / fs_hz, pulses_s, np.arange(pulses_s.size))
    once, lines = np.exp(-2j * np.pi * teeth * turns), []
    for harmonic in range(1, HARMONICS + 1):
        lines.append((signal[kept] * once**harmonic).reshape(SEGMENTS, length).sum(axis=1))
    across = np.array([np.sum(line[1:] * line[:-1].conj()) for line in lines])
    ahead = np.angle(across) / (2.0 * np.pi * teeth * np.arange(1, HARMONICS + 1))
    weight = np.abs(across) * np.square(np.arange(1, HARMONICS + 1))
    return float((weight @ ahead) / (weight.sum() + TINY) / ((turns[-1] - turns[0]) / SEGMENTS))


def pulse_roughness(pulses_s: np.ndarray) -> float:
    """Return log10 of the scatter of third differences of pulse times (k,) [s]; a shaft's own speed leaves few."""
    third = np.diff(np.asarray(pulses_s, dtype=np.float64), 3)
    return float(np.log10(third.std() + 1e-12)) if third.size > 1 else math.nan


def mesh_fractions(signal: np.ndarray, fs_hz: float, rate_hz: float, teeth: int) -> dict[float, float]:
    """Return how far a line at k/4 of the mesh frequency stands over those a few turns beside it [dB], by k/4.

    Parameters
    ----------
    signal : (n,) float64
    fs_hz, rate_hz : float
        Sampling frequency and speed of the pinion [Hz].
    teeth : int
        Of the pinion.
    """
    from scipy import fft

    power = np.square(np.abs(fft.rfft((signal - signal.mean()) * np.hanning(signal.size)))) + TINY
    decibels = 10.0 * np.log10(power)
    turns = np.array([turn for turn in range(-BESIDE, BESIDE + 1) if turn])
    found = {}
    for quarter in range(1, QUARTERS * HIGHEST_MESH):
        order = quarter * teeth / QUARTERS
        if quarter % QUARTERS and (order + BESIDE) * rate_hz < 0.49 * fs_hz:
            peaks = _peaks(decibels, np.append(order, order + turns) * rate_hz * signal.size / fs_hz)
            found[quarter / QUARTERS] = float(peaks[0] - peaks[1:].mean())
    return found


def _peaks(decibels: np.ndarray, places: np.ndarray) -> np.ndarray:
    around = np.round(places).astype(int)[:, None] + np.arange(-REACH, REACH + 1)
    return np.asarray(decibels[np.clip(around, 0, decibels.size - 1)].max(axis=1))
