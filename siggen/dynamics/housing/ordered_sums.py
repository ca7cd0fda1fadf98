"""Products of matrices summed in one order: the same bits for any number of threads, on any processor.

Four rows at a time, so that sums are not written back to memory for each.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit

AT_ONCE = 4


@entry(cache=True)
def squares(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return leftᵀ right (n, m) of rows (points, n) and (points, m)."""
    return _summed(_filled(left), _filled(right), False)


@entry(cache=True)
def own_squares(rows: FloatArray) -> FloatArray:
    """Return rowsᵀ rows (n, n)."""
    filled = _filled(rows)
    result = _summed(filled, filled, True)
    for i in range(result.shape[0]):
        for k in range(i):
            result[i, k] = result[k, i]
    return result


@njit(cache=True)
def _filled(rows: FloatArray) -> FloatArray:
    """Return the rows, and rows of zeros up to a multiple of four."""
    count = rows.shape[0]
    filled = np.zeros(((count + AT_ONCE - 1) // AT_ONCE * AT_ONCE, rows.shape[1]))
    filled[:count] = rows
    return filled


@njit(cache=True)
def _summed(left: FloatArray, right: FloatArray, half: bool) -> FloatArray:
    result = np.zeros((left.shape[1], right.shape[1]))
    for q in range(0, left.shape[0], AT_ONCE):
        for i in range(left.shape[1]):
            a, b, c, d = left[q, i], left[q + 1, i], left[q + 2, i], left[q + 3, i]
            for k in range(i if half else 0, right.shape[1]):
                result[i, k] += (a * right[q, k] + b * right[q + 1, k]) + (c * right[q + 2, k] + d * right[q + 3, k])
    return result
