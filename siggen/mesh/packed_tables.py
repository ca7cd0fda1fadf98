"""PackedTables: many arrays of numbers and of whole numbers in one array each, for the compiled time loop.

A compiled function counts references of every array that it takes out of a tuple, which costs more than the arithmetic
of a tooth pair; of two arrays there is nothing to count. Where an array begins is a whole number like the others.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from siggen.arrays import FloatArray, IntArray


class PackedTables:
    """Collects arrays; `numbers` and `index` are then read-only.

    Parameters
    ----------
    header : int
        Length of the head of the whole numbers, which `head` fills: counts, and where arrays begin.
    """

    def __init__(self, header: int) -> None:
        self._floats: list[FloatArray] = []
        self._wholes: list[IntArray] = [np.zeros(header, dtype=np.int64)]
        self._filled = [0, header]

    def head(self, place: int, value: int) -> None:
        """Write a whole number at a place of the head."""
        self._wholes[0][place] = value

    def add(self, place: int, values: ArrayLike) -> None:
        """Append numbers in row order and write into the head where they begin."""
        self._append(self._floats, 0, place, np.asarray(values, dtype=np.float64))

    def add_index(self, place: int, values: ArrayLike) -> None:
        """Append whole numbers in row order and write into the head where they begin."""
        self._append(self._wholes, 1, place, np.asarray(values, dtype=np.int64))

    @property
    def numbers(self) -> FloatArray:
        """All numbers (k,)."""
        return _joined(self._floats, np.float64)

    @property
    def index(self) -> IntArray:
        """The head and all whole numbers (k,)."""
        return _joined(self._wholes, np.int64)

    def _append(self, parts: list[Any], which: int, place: int, values: NDArray[Any]) -> None:
        self.head(place, self._filled[which])
        parts.append(values.ravel())
        self._filled[which] += values.size


def _joined(parts: list[Any], dtype: type) -> NDArray[Any]:
    # One element at least: an empty array has no address that compiled code could be handed.
    joined = np.concatenate([*parts, np.zeros(1, dtype=dtype)])
    joined.setflags(write=False)
    return joined
