"""Fewer points of a long signal by minimum and maximum of buckets, so that no impulse is lost. Source: standard."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np


@dataclass(frozen=True, slots=True)
class Drawn:
    """Points of a signal to draw: sample numbers (n,), ascending, and values (n,)."""

    sample: np.ndarray
    value: np.ndarray


def extreme_points(signal: np.ndarray, buckets: int) -> Drawn:
    """Return the smallest and the largest sample of every bucket, at their own places.

    Parameters
    ----------
    signal : (n,) float
    buckets : int
        Number of equal stretches; a signal of at most twice as many samples comes back whole.
    """
    samples = signal.size
    if samples <= 2 * buckets:
        return Drawn(np.arange(samples), np.asarray(signal))
    edges = np.linspace(0, samples, buckets + 1).astype(np.int64)
    found = [
        low + place
        for low, high in pairwise(edges)
        for place in sorted((int(signal[low:high].argmin()), int(signal[low:high].argmax())))
    ]
    sample = np.unique(found)  # a bucket that does not vary has one extreme
    return Drawn(sample, np.asarray(signal)[sample])


def drawn_signal(signal: np.ndarray, buckets: int, fine: tuple[int, int]) -> Drawn:
    """Return extremes of a signal with every sample of one stretch.

    Parameters
    ----------
    signal : (n,) float
    buckets : int
        As of `extreme_points`.
    fine : (int, int)
        First sample of the stretch, and the one after its last.
    """
    sample = np.union1d(outside(extreme_points(signal, buckets).sample, fine), np.arange(*fine))
    return Drawn(sample, np.asarray(signal)[sample])


def outside(sample: np.ndarray, fine: tuple[int, int]) -> np.ndarray:
    """Return the sample numbers that do not lie in a stretch."""
    return np.asarray(sample[(sample < fine[0]) | (sample >= fine[1])])
