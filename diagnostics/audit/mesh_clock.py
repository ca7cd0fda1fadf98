"""Pulses of the tacho, and how mesh lines of a raw record drift against them.

A gear turns with its shaft. So the phase of a mesh line, beside the angle that the pulses give, stays where it is over
a record, whatever damage there is: a drift is one of clocks. Source: derived.
"""

from __future__ import annotations

import math

import numpy as np

SEGMENTS, HARMONICS = 8, 3
FEWEST_PULSES = 2 * SEGMENTS
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
