"""Products of matrices summed in one order: the same bits for any number of threads, on any processor.

Four rows at a time. Sums of four times eight numbers stay in registers from the first row to the last.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.lanes import LANES, Lanes, load, scalar_at, splat, store

AT_ONCE = 4


@entry(cache=True)
def squares(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return leftᵀ right (n, m) of rows (points, n) and (points, m)."""
    result = np.empty((_whole(left.shape[1]), _whole(right.shape[1])))
    _sum(_filled(left), _filled(right), False, result)
    return result[: left.shape[1], : right.shape[1]].copy()


@entry(cache=True)
def own_squares(rows: FloatArray) -> FloatArray:
    """Return rowsᵀ rows (n, n)."""
    filled, columns = _filled(rows), rows.shape[1]
    result = np.empty((filled.shape[1], filled.shape[1]))
    _sum(filled, filled, True, result)
    for i in range(columns):
        for k in range(i):
            result[i, k] = result[k, i]
    return result[:columns, :columns].copy()


@njit(cache=True)
def _whole(columns: int) -> int:
    """Return the columns of whole registers."""
    return columns + -columns % LANES


@njit(cache=True)
def _filled(rows: FloatArray) -> FloatArray:
    """Return the rows, and zeros up to a multiple of four rows and to whole registers."""
    count, columns = rows.shape
    filled = np.zeros((count + -count % AT_ONCE, _whole(columns)))
    filled[:count, :columns] = rows
    return filled


@njit(cache=True, _nrt=False, error_model="numpy")
def _sum(left: FloatArray, right: FloatArray, half: bool, result: FloatArray) -> None:
    """Write leftᵀ right, or (`half`) what of it lies above the diagonal."""
    wide = right.shape[1]
    for k in range(0, wide, LANES):
        for i in range(0, k + LANES if half else left.shape[1], AT_ONCE):
            sum_0, sum_1, sum_2, sum_3 = splat(0.0), splat(0.0), splat(0.0), splat(0.0)
            for q in range(0, left.shape[0], AT_ONCE):
                a, b, c, d = _load(right, q * wide + k)
                at = q * left.shape[1] + i
                sum_0 = sum_0 + _four(left, at, a, b, c, d)
                sum_1 = sum_1 + _four(left, at + 1, a, b, c, d)
                sum_2 = sum_2 + _four(left, at + 2, a, b, c, d)
                sum_3 = sum_3 + _four(left, at + 3, a, b, c, d)
            store(result, i * wide + k, sum_0)
            store(result, (i + 1) * wide + k, sum_1)
            store(result, (i + 2) * wide + k, sum_2)
            store(result, (i + 3) * wide + k, sum_3)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _load(rows: FloatArray, at: int) -> tuple[Lanes, Lanes, Lanes, Lanes]:
    """Return so many columns of four rows."""
    wide = rows.shape[1]
    return load(rows, at), load(rows, at + wide), load(rows, at + 2 * wide), load(rows, at + 3 * wide)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _four(left: FloatArray, at: int, a: Lanes, b: Lanes, c: Lanes, d: Lanes) -> Lanes:
    """Return one column of four rows times the rows beside them."""
    wide = left.shape[1]
    first = scalar_at(left, at) * a + scalar_at(left, at + wide) * b
    return first + (scalar_at(left, at + 2 * wide) * c + scalar_at(left, at + 3 * wide) * d)
