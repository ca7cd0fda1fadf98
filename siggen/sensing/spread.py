"""Spread: mean and standard deviation of values that come in parts."""

from __future__ import annotations

import math

from siggen.arrays import FloatArray


class Spread:
    """Of parts joined: squares about the mean of two parts are those of each and (m_2 - m_1)² n_1 n_2 / n (derived).

    One part gives the last bit that numpy gives.
    """

    def __init__(self) -> None:
        self._count, self._mean, self._squares = 0, 0.0, 0.0

    def take(self, values: FloatArray) -> None:
        """Add values (k,), from 1 on."""
        before, mean = self._count, float(values.mean())
        self._count += values.size
        squares = float(((values - mean) ** 2).sum())
        if before:
            squares += self._squares + (mean - self._mean) ** 2 * before * values.size / self._count
            mean = self._mean + (mean - self._mean) * values.size / self._count
        self._mean, self._squares = mean, squares

    @property
    def std(self) -> float:
        """Standard deviation of all values taken."""
        return math.sqrt(self._squares / self._count)

    @property
    def mean(self) -> float:
        """Mean of all values taken."""
        return self._mean
