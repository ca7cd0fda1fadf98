"""Product and solution of a symmetric matrix that is a diagonal plus sums of decaying terms of the distance.

A_ij = d_i for i = j, Σ_m s_m r_m^|i-j| + p_i Π_{j < k <= i} q_k for i > j: exponentials of the distance, and one term
whose strength p and decay q belong to the rows (free ends make them so, see `tooth_kernel`). Product and solution take
a number of steps proportional to the size: such a matrix is semiseparable, and its factors L D Lᵀ stay so
(Foreman-Mackey et al. 2017, Astron. J. 154, 220, section 5.1, for real exponentials). Rows that are not chosen are
left out; distances count through them.

The numbers of terms and of right sides are constants of the module: compiled loops over them are unrolled.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from siggen.arrays import FloatArray, IntArray

EXPONENTIALS = 5
TERMS = EXPONENTIALS + 1
"""With the term whose strength and decay belong to the rows, the last one."""
SIDES = 5


@njit(cache=True, fastmath={"contract", "reassoc"})
def products(
    decay: FloatArray,
    strength: FloatArray,
    slope: FloatArray,
    vector: FloatArray,
    out: FloatArray,
    slope_out: FloatArray,
) -> None:
    """Write the off-diagonal products of the exponentials with `strength` and with `slope` (m,) as s, (n,) each."""
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
def add_row_products(row_strength: FloatArray, row_decay: FloatArray, vector: FloatArray, out: FloatArray) -> None:
    """Add the off-diagonal products of the term of the rows, p and q (n,), to `out` (n,)."""
    count = vector.size
    run = 0.0
    for i in range(1, count):
        run = row_decay[i] * (run + vector[i - 1])
        out[i] += row_strength[i] * run
    run = 0.0
    for i in range(count - 2, -1, -1):
        run = row_decay[i + 1] * (run + row_strength[i + 1] * vector[i + 1])
        out[i] += run


@njit(cache=True, fastmath={"contract", "reassoc"})
def solve_rows(
    decay: FloatArray,
    strength: FloatArray,
    row_strength: FloatArray,
    row_decay: FloatArray,
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
    row_strength, row_decay : (n,)
    diagonal : (n,)
    rows : (>= count,)
        The chosen rows, ascending.
    right : (n, SIDES)
        b at the chosen rows; x afterwards.
    steps : (n, TERMS)
        Room: decay from the row before.
    work : (n, TERMS + 1)
        Room: the factors.
    """
    inner = np.zeros((TERMS, TERMS))
    run = np.zeros((TERMS, SIDES))
    own = np.zeros(TERMS)
    for m in range(EXPONENTIALS):
        own[m] = strength[m]
    for n in range(count):
        i = rows[n]
        pivot = diagonal[i]
        own[EXPONENTIALS] = row_strength[i]
        if n > 0:
            _carry_on(decay, row_decay, rows[n - 1], i, right, steps, work, inner, run)
        for m in range(TERMS):
            product = 0.0
            for k in range(TERMS):
                product += own[k] * inner[k, m]
            work[i, m] = 1.0 - product
            pivot -= product * own[m]
            for side in range(SIDES):
                right[i, side] -= own[m] * run[m, side]
        if pivot <= 0.0:
            return False
        work[i, TERMS] = pivot
        for m in range(TERMS):
            work[i, m] /= pivot
    _substitute(own, row_strength, rows, count, right, steps, work)
    return True


@njit(cache=True, fastmath={"contract", "reassoc"})
def _substitute(
    own: FloatArray,
    row_strength: FloatArray,
    rows: IntArray,
    count: int,
    right: FloatArray,
    steps: FloatArray,
    work: FloatArray,
) -> None:
    """Go back from the last row to the first; `own` (TERMS,) holds the strengths of the exponentials."""
    run = np.zeros((TERMS, SIDES))
    for n in range(count - 1, -1, -1):
        i = rows[n]
        for side in range(SIDES):
            right[i, side] /= work[i, TERMS]
        if n < count - 1:
            after = rows[n + 1]
            own[EXPONENTIALS] = row_strength[after]
            for m in range(TERMS):
                for side in range(SIDES):
                    run[m, side] = steps[after, m] * (run[m, side] + own[m] * right[after, side])
                    right[i, side] -= work[i, m] * run[m, side]


@njit(cache=True, fastmath={"contract", "reassoc"})
def _carry_on(
    decay: FloatArray,
    row_decay: FloatArray,
    before: int,
    i: int,
    right: FloatArray,
    steps: FloatArray,
    work: FloatArray,
    inner: FloatArray,
    run: FloatArray,
) -> None:
    """Carry the sums of all rows before from row `before` on to row i."""
    last = work[before, TERMS]
    for m in range(EXPONENTIALS):
        steps[i, m] = decay[m]
        for _ in range(i - before - 1):
            steps[i, m] *= decay[m]
    steps[i, EXPONENTIALS] = row_decay[i]
    for k in range(before + 1, i):
        steps[i, EXPONENTIALS] *= row_decay[k]
    for m in range(TERMS):
        for k in range(TERMS):
            inner[m, k] = steps[i, m] * steps[i, k] * (inner[m, k] + last * work[before, m] * work[before, k])
        for side in range(SIDES):
            run[m, side] = steps[i, m] * (run[m, side] + work[before, m] * right[before, side])
