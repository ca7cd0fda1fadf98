"""Modulation of noise by what turns and by chance: M = C(mesh) G(shafts) exp(s U - s²/2), of mean 1.

Closed forms (derived; Gaussian noise n, C = G = 1): kurtosis of n √M is 3 exp(s²), the squared coefficient of
variation of its envelope (4/π) exp(s²/4) - 1; with shaft lines of depth d_k alone, kurtosis 3 (1 + Σ d_k²/2).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.compiled import entry

SHAFT_LINES = 3
"""Lines of a shaft's modulation."""


def shaft_course(lines: Sequence[FloatArray]) -> FloatArray:
    """Return G (n,) = 1 + lines (n,) of shafts, not below 0."""
    return np.asarray(np.maximum(1.0 + np.add.reduce(lines), 0.0))


def shaft_phasors(depth: float, phase_rad: FloatArray) -> ComplexArray:
    """Return the lines of one shaft as phasors (SHAFT_LINES,): depths d, d/√2, d/√3 with phases (SHAFT_LINES,)."""
    return np.asarray(depth / np.sqrt(np.arange(1.0, phase_rad.size + 1.0)) * np.exp(1j * phase_rad))


class LevelCourse:
    """The same course block after block."""

    def __init__(self, std: float, memory_samples: float, rng: np.random.Generator) -> None:
        self._std, self._keep, self._rng = std, float(np.exp(-1.0 / memory_samples)), rng
        self._last: float | None = None

    def take(self, count: int) -> FloatArray:
        """Return the next values (count,), from 1 on."""
        drawn = self._rng.standard_normal(count)
        process = _process(drawn, self._keep, 0.0 if self._last is None else self._last, self._last is None)
        self._last = float(process[-1])
        return np.asarray(np.exp(self._std * process - 0.5 * self._std**2))


def periodic_course(angle_rad: FloatArray, teeth: int, table: FloatArray) -> FloatArray:
    """Return a table (k,) over one tooth pitch, read linearly at pinion angles (n,) and repeated."""
    return _read(angle_rad, teeth / (2.0 * np.pi), table)


def replayed(angle_rad: FloatArray, order: float, pattern: FloatArray) -> FloatArray:
    """Return a pattern (k,) over one revolution of a shaft of `order`, read linearly at pinion angles (n,)."""
    return _read(angle_rad, order / (2.0 * np.pi), pattern)


@entry(cache=True)
def _process(normals: FloatArray, keep: float, last: float, begins: bool) -> FloatArray:
    result = np.empty_like(normals)
    fresh = np.sqrt(1.0 - keep * keep)
    result[0] = normals[0] if begins else keep * last + fresh * normals[0]
    for i in range(1, normals.size):
        result[i] = keep * result[i - 1] + fresh * normals[i]
    return result


@entry(cache=True)
def _read(angle_rad: FloatArray, per_rad: float, table: FloatArray) -> FloatArray:
    result, size = np.empty_like(angle_rad), table.size
    for i in range(angle_rad.size):
        place = angle_rad[i] * per_rad
        place = (place - np.floor(place)) * size
        k = min(int(place), size - 1)
        share = place - k
        result[i] = table[k] * (1.0 - share) + table[(k + 1) % size] * share
    return result
