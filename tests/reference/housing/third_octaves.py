"""Third octaves of accelerances, and how far two sets of them lie apart."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

LINES_A_BAND = 100
DAMPING = 0.02


class Distance(NamedTuple):
    """Of third octaves in dB: share within 6 dB, median and 95 % quantile of the size, largest, median with sign."""

    within_6_db: float
    median: float
    most_95: float
    most: float
    bias: float

    @property
    def text(self) -> str:
        """One row of a table."""
        numbers = " | ".join(f"{number:.1f}" for number in self[1:])
        return f"{100.0 * self.within_6_db:.1f} % | {numbers}"


def centres_hz(low_hz: float, high_hz: float) -> np.ndarray:
    """Return the middles of third octaves between two frequencies."""
    first, last = np.ceil(3.0 * np.log2(low_hz / 1000.0)), np.floor(3.0 * np.log2(high_hz / 1000.0))
    return 1000.0 * 2.0 ** (np.arange(first, last + 1) / 3.0)


def lines_hz(centres: np.ndarray) -> np.ndarray:
    """Return frequencies (bands * lines,) evenly in every band's logarithm."""
    within = 2.0 ** (((np.arange(LINES_A_BAND) + 0.5) / LINES_A_BAND - 0.5) / 3.0)
    return (centres[:, None] * within).ravel()


def bands_db(accelerance: np.ndarray) -> np.ndarray:
    """Return mean squares (..., bands) in dB of accelerances (..., bands * lines)."""
    power = np.abs(accelerance) ** 2
    return 10.0 * np.log10(power.reshape(*power.shape[:-1], -1, LINES_A_BAND).mean(axis=-1))


def distance(one_db: np.ndarray, other_db: np.ndarray) -> Distance:
    """Return how far two arrays of levels lie apart."""
    apart = one_db - other_db
    size = np.abs(apart)
    return Distance(
        float((size <= 6.0).mean()),
        float(np.median(size)),
        float(np.quantile(size, 0.95)),
        float(size.max()),
        float(np.median(apart)),
    )
