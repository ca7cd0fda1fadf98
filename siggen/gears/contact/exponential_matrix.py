"""Product and solution of a matrix that is a diagonal plus a sum of decaying exponentials of the distance.

A_ij = d_i for i = j, Σ_m s_m r_m^|i-j| otherwise. Both take a number of steps proportional to the size: such a matrix
is semiseparable, and its factors L D Lᵀ stay so (Foreman-Mackey et al. 2017, Astron. J. 154, 220, section 5.1, for real
exponentials). Rows that are not chosen are left out; distances count through them.

The numbers of exponentials and of right sides are constants of the module: compiled loops over them are unrolled.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

EXPONENTIALS = 5
SIDES = 4


@njit(cache=True, fastmath={"contract", "reassoc"})
def products(
    decay: FloatArray,
    strength: FloatArray,
    slope: FloatArray,
    vector: FloatArray,
    out: FloatArray,
    slope_out: FloatArray,
) -> None:
    """Write the off-diagonal products with `strength` and with `slope` (m,) in place of s, (n,) each."""
    count = vector.size
    run = np.zeros(EXPONENTIALS)
    out[0] = 0.0
    slope_out[0] = 0.0
    for i in range(1, count):
        product, rise = 0.0, 0.0
        for m in range(EXPONENTIALS):
            run[m] = decay[m] * (run[m] + vector[i - 1])
            product += strength[m] * run[m]
            rise += slope[m] * run[m]
        out[i] = product
        slope_out[i] = rise
    run[:] = 0.0
    for i in range(count - 2, -1, -1):
        product, rise = 0.0, 0.0
        for m in range(EXPONENTIALS):
            run[m] = decay[m] * (run[m] + vector[i + 1])
            product += strength[m] * run[m]
            rise += slope[m] * run[m]
        out[i] += product
        slope_out[i] += rise


@njit(cache=True, fastmath={"contract", "reassoc"})
def solve_rows(
    decay: FloatArray,
    strength: FloatArray,
    diagonal: FloatArray,
    rows: IntArray,
    count: int,
    right: FloatArray,
    steps: FloatArray,
    work: FloatArray,
) -> bool:
    """Solve A x = b for the chosen rows, in place of `right`; False if A is not positive definite.

    Parameters
    ----------
    decay, strength : (EXPONENTIALS,)
    diagonal : (n,)
    rows : (>= count,)
        The chosen rows, ascending.
    right : (n, SIDES)
        b at the chosen rows; x afterwards.
    steps : (n, EXPONENTIALS)
        Room: decay from the row before.
    work : (n, EXPONENTIALS + 1)
        Room: the factors.
    """
    inner = np.zeros((EXPONENTIALS, EXPONENTIALS))
    run = np.zeros((EXPONENTIALS, SIDES))
    for n in range(count):
        i = rows[n]
        pivot = diagonal[i]
        if n > 0:
            _carry_on(decay, rows[n - 1], i, right, steps, work, inner, run)
        for m in range(EXPONENTIALS):
            product = 0.0
            for k in range(EXPONENTIALS):
                product += strength[k] * inner[k, m]
            work[i, m] = 1.0 - product
            pivot -= product * strength[m]
            for side in range(SIDES):
                right[i, side] -= strength[m] * run[m, side]
        if pivot <= 0.0:
            return False
        work[i, EXPONENTIALS] = pivot
        for m in range(EXPONENTIALS):
            work[i, m] /= pivot
    run[:] = 0.0
    for n in range(count - 1, -1, -1):
        i = rows[n]
        for side in range(SIDES):
            right[i, side] /= work[i, EXPONENTIALS]
        if n < count - 1:
            after = rows[n + 1]
            for m in range(EXPONENTIALS):
                for side in range(SIDES):
                    run[m, side] = steps[after, m] * (run[m, side] + strength[m] * right[after, side])
                    right[i, side] -= work[i, m] * run[m, side]
    return True


@njit(cache=True, fastmath={"contract", "reassoc"})
def _carry_on(
    decay: FloatArray,
    before: int,
    i: int,
    right: FloatArray,
    steps: FloatArray,
    work: FloatArray,
    inner: FloatArray,
    run: FloatArray,
) -> None:
    """Carry the sums of all rows before from row `before` on to row i."""
    last = work[before, EXPONENTIALS]
    for m in range(EXPONENTIALS):
        steps[i, m] = decay[m]
        for _ in range(i - before - 1):
            steps[i, m] *= decay[m]
    for m in range(EXPONENTIALS):
        for k in range(EXPONENTIALS):
            inner[m, k] = steps[i, m] * steps[i, k] * (inner[m, k] + last * work[before, m] * work[before, k])
        for side in range(SIDES):
            run[m, side] = steps[i, m] * (run[m, side] + work[before, m] * right[before, side])
