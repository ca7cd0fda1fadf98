"""Product and solution of a symmetric matrix that is a diagonal plus sums of decaying terms of the distance.

A_ij = d_i for i = j, Σ_m s_m r_m^|i-j| + p_i Π_{j < k <= i} q_k for i > j: exponentials of the distance, and one term
whose strength p and decay q belong to the rows (free ends make them so, see `tooth_kernel`). Product and solution take
a number of steps proportional to the size: such a matrix is semiseparable, and its factors L D Lᵀ stay so
(Foreman-Mackey et al. 2017, Astron. J. 154, 220, section 5.1, for real exponentials). Rows that are not chosen are
left out; distances count through them.

The numbers of terms and of right sides are constants of the module: compiled loops over them are unrolled.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import njit

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


class RowMatrix(NamedTuple):
    """A matrix by its terms: decays and strengths of the exponentials (EXPONENTIALS,), of the rows (n,), its diagonal.

    `row_strength`, `row_decay` (n,): p and q of the term of the rows; `diagonal` (n,).
    """

    decay: FloatArray
    strength: FloatArray
    row_strength: FloatArray
    row_decay: FloatArray
    diagonal: FloatArray


@njit(cache=True, fastmath={"contract", "reassoc"})
def solve_rows(
    matrix: RowMatrix, rows: IntArray, count: int, right: FloatArray, steps: FloatArray, work: FloatArray
) -> bool:
    """Solve A x = b for the chosen rows, in place of `right`; False if A is not positive definite.

    Parameters
    ----------
    matrix : RowMatrix
    rows : (>= count,)
        The chosen rows, ascending.
    right : (n, SIDES)
        b at the chosen rows; x afterwards.
    steps : (n, TERMS)
        Room: decay from the row before.
    work : (n, TERMS + 1)
        Room: the factors, and the pivots' inverse.
    """
    decay, strength, row_strength, row_decay, diagonal = matrix
    # The sums of all rows before, of which `inner` is symmetric and kept below its diagonal; b and w are those of the
    # row before. Numbers are read once, since the compiler must take arrays to overlap.
    inner, run = np.zeros((TERMS, TERMS)), np.zeros((TERMS, SIDES))
    own, step, w = np.zeros(TERMS), np.zeros(TERMS), np.zeros(TERMS)
    product, b = np.zeros(TERMS), np.zeros(SIDES)
    own[:EXPONENTIALS] = strength
    last = 0.0
    for n in range(count):
        i = rows[n]
        pivot = diagonal[i]
        own[EXPONENTIALS] = row_strength[i]
        if n > 0:
            _steps(decay, row_decay, rows[n - 1], i, step)
            for m in range(TERMS):
                here, factor = step[m], w[m]
                steps[i, m] = here
                for k in range(m + 1):
                    inner[m, k] = here * step[k] * (inner[m, k] + last * factor * w[k])
                for side in range(SIDES):
                    run[m, side] = here * (run[m, side] + factor * b[side])
        product[:] = 0.0
        for m in range(TERMS):
            here = own[m]
            total = here * inner[m, m]
            for k in range(m):
                total += own[k] * inner[m, k]
                product[k] += here * inner[m, k]
            product[m] += total
        b[:] = right[i]
        for m in range(TERMS):
            pivot -= product[m] * own[m]
            for side in range(SIDES):
                b[side] -= own[m] * run[m, side]
        if pivot <= 0.0:
            return False
        last = pivot
        for m in range(TERMS):
            w[m] = (1.0 - product[m]) / pivot
            work[i, m] = w[m]
        work[i, TERMS] = 1.0 / pivot
        right[i] = b
    _substitute(own, row_strength, rows, count, right, steps, work)
    return True


@njit(cache=True, inline="always")
def _steps(decay: FloatArray, row_decay: FloatArray, before: int, i: int, step: FloatArray) -> None:
    """Write the decays (TERMS,) from row `before` to row i."""
    step[:EXPONENTIALS] = decay
    step[EXPONENTIALS] = row_decay[i]
    for k in range(before + 1, i):
        for m in range(EXPONENTIALS):
            step[m] *= decay[m]
        step[EXPONENTIALS] *= row_decay[k]


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
    run, x, ahead = np.zeros((TERMS, SIDES)), np.zeros(SIDES), np.zeros(SIDES)
    for n in range(count - 1, -1, -1):
        i = rows[n]
        for side in range(SIDES):
            x[side] = right[i, side] * work[i, TERMS]
        if n < count - 1:
            after = rows[n + 1]
            own[EXPONENTIALS] = row_strength[after]
            for m in range(TERMS):
                step, here, factor = steps[after, m], own[m], work[i, m]
                for side in range(SIDES):
                    moved = step * (run[m, side] + here * ahead[side])
                    run[m, side] = moved
                    x[side] -= factor * moved
        for side in range(SIDES):
            right[i, side] = ahead[side] = x[side]
