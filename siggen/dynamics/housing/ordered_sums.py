"""Products of matrices summed in the order of their rows: the same bits for any number of threads, on any processor."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit


@njit(cache=True)
def squares(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return leftᵀ right (n, m) of rows (points, n) and (points, m)."""
    result = np.zeros((left.shape[1], right.shape[1]))
    for q in range(left.shape[0]):
        for i in range(left.shape[1]):
            factor = left[q, i]
            for k in range(right.shape[1]):
                result[i, k] += factor * right[q, k]
    return result


@njit(cache=True)
def own_squares(rows: FloatArray) -> FloatArray:
    """Return rowsᵀ rows (n, n)."""
    n = rows.shape[1]
    result = np.zeros((n, n))
    for q in range(rows.shape[0]):
        for i in range(n):
            factor = rows[q, i]
            for k in range(i, n):
                result[i, k] += factor * rows[q, k]
    for i in range(n):
        for k in range(i):
            result[i, k] = result[k, i]
    return result
