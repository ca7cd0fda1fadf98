"""Product and solution of a matrix that is a diagonal plus a sum of decaying exponentials of the distance.

A_ij = d_i for i = j, Σ_m s_m r_m^|i-j| otherwise. Both take a number of steps proportional to the size: such a matrix
is semiseparable, and its factors L D Lᵀ stay so (Foreman-Mackey et al. 2017, Astron. J. 154, 220, section 5.1, for real
exponentials). Rows that are not chosen are left out; distances count through them.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


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
    count, terms = vector.size, decay.size
    out[:] = 0.0
    slope_out[:] = 0.0
    for m in range(terms):
        r, s, ds = decay[m], strength[m], slope[m]
        carried = 0.0
        for i in range(1, count):
            carried = r * (carried + vector[i - 1])
            out[i] += s * carried
            slope_out[i] += ds * carried
        carried = 0.0
        for i in range(count - 2, -1, -1):
            carried = r * (carried + vector[i + 1])
            out[i] += s * carried
            slope_out[i] += ds * carried


@njit(cache=True, fastmath={"contract", "reassoc"})
def solve_rows(  # noqa: PLR0912 - compiled: one sweep up and one down, nothing to call inside
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
    decay, strength : (m,)
    diagonal : (n,)
    rows : (>= count,)
        The chosen rows, ascending.
    right : (n, k)
        b at the chosen rows; x afterwards.
    steps : (n, m)
        Room: decay from the row before.
    work : (n, m + 1)
        Room: the factors.
    """
    terms, sides = decay.size, right.shape[1]
    inner = np.zeros((terms, terms))
    run = np.zeros((terms, sides))
    for n in range(count):
        i = rows[n]
        pivot = diagonal[i]
        if n > 0:
            before = rows[n - 1]
            apart = i - before
            last = work[before, terms]
            for m in range(terms):
                r = decay[m]
                steps[i, m] = r if apart == 1 else r**apart
            for m in range(terms):
                for k in range(m + 1):
                    value = steps[i, m] * steps[i, k] * (inner[m, k] + last * work[before, m] * work[before, k])
                    inner[m, k] = value
                    inner[k, m] = value
                for side in range(sides):
                    run[m, side] = steps[i, m] * (run[m, side] + work[before, m] * right[before, side])
            for m in range(terms):
                product = 0.0
                for k in range(terms):
                    product += strength[k] * inner[k, m]
                work[i, m] = 1.0 - product
                pivot -= product * strength[m]
                for side in range(sides):
                    right[i, side] -= strength[m] * run[m, side]
        else:
            for m in range(terms):
                work[i, m] = 1.0
        if pivot <= 0.0:
            return False
        work[i, terms] = pivot
        for m in range(terms):
            work[i, m] /= pivot
    run[:] = 0.0
    for n in range(count - 1, -1, -1):
        i = rows[n]
        for side in range(sides):
            right[i, side] /= work[i, terms]
        if n < count - 1:
            after = rows[n + 1]
            for m in range(terms):
                for side in range(sides):
                    run[m, side] = steps[after, m] * (run[m, side] + strength[m] * right[after, side])
                    right[i, side] -= work[i, m] * run[m, side]
    return True
