"""lowest_modes: the lowest modes of K φ = ω² M φ, the same to the last bit on any processor.

K = UᵀU (Cholesky). U^-T M U^-1 is made tridiagonal by reflections (Householder); its largest eigenvalues 1/ω² and their
vectors come by inverse iteration (reference: standard literature). Low modes are then exact to the rounding of K alone.
Library routines for these steps sum in an order that depends on threads and processor; those of the eigenvalues alone
do not.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvalsh_tridiagonal

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.lanes import LANES, Lanes, load, scalar_at, splat, store


class LowestModes(NamedTuple):
    """ω² (m,) ascending [1/s²], shapes (n, m) with modal mass 1, U (n, n) of K = UᵀU, and M (n, n)."""

    omega_squared: FloatArray
    shapes: FloatArray
    root: FloatArray
    mass: FloatArray


def lowest_modes(stiffness: FloatArray, mass: FloatArray, highest_omega: float) -> LowestModes:
    """Return all modes up to an angular frequency [rad/s], at least three.

    The largest entry of a shape is positive.

    Raises
    ------
    ValueError
        If the stiffness is not positive definite: the body is free to move.
    """
    root = upper_root(stiffness)
    if not np.isfinite(root).all():
        raise ValueError("stiffness: received a body that is free to move; allowed are bodies that bolts hold")
    half = solve_lower(root, mass)
    reduced = solve_lower(root, np.ascontiguousarray(half.T))
    diagonal, beside, reflections, scales = tridiagonal(0.5 * (reduced + reduced.T))
    inverse, vectors = _largest(diagonal, beside, highest_omega**-2)
    reflect(reflections, scales, vectors)
    shapes = solve_upper(root, vectors) / np.sqrt(inverse)
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
    return LowestModes(1.0 / inverse, shapes * np.sign(largest), root, mass)


LEAST = 3
"""Modes of a rigid body in one half."""


def _largest(diagonal: FloatArray, beside: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """Return the eigenvalues (m,) above `least`, descending, and their vectors (n, m)."""
    values = eigvalsh_tridiagonal(diagonal, beside, lapack_driver="sterf")[::-1]
    count = max(LEAST, int((values > least).sum()))
    found = np.ascontiguousarray(values[:count])
    return found, np.ascontiguousarray(tridiagonal_vectors(diagonal, beside, found).T)


@entry(cache=True)
def upper_root(matrix: FloatArray) -> FloatArray:
    """Return U (n, n), upper triangular with UᵀU the matrix; NaN where it is not positive definite."""
    n = matrix.shape[0]
    root = np.zeros((n, n))
    for i in range(n):
        for k in range(i, n):
            root[i, k] = matrix[i, k]
    for j in range(n):
        pivot = np.sqrt(root[j, j]) if root[j, j] > 0.0 else np.nan
        for k in range(j, n):
            root[j, k] /= pivot
        for i in range(j + 1, n):
            factor = root[j, i]
            for k in range(i, n):
                root[i, k] -= factor * root[j, k]
    return root


@entry(cache=True)
def solve_lower(root: FloatArray, right: FloatArray) -> FloatArray:
    """Return U^-T right (n, m)."""
    n, m = right.shape
    result = right.copy()
    for j in range(n):
        for k in range(m):
            result[j, k] /= root[j, j]
        for i in range(j + 1, n):
            factor = root[j, i]
            for k in range(m):
                result[i, k] -= factor * result[j, k]
    return result


@entry(cache=True)
def solve_upper(root: FloatArray, right: FloatArray) -> FloatArray:
    """Return U^-1 right (n, m)."""
    n, m = right.shape
    result = right.copy()
    for j in range(n - 1, -1, -1):
        for i in range(j + 1, n):
            factor = root[j, i]
            for k in range(m):
                result[j, k] -= factor * result[i, k]
        for k in range(m):
            result[j, k] /= root[j, j]
    return result


@entry(cache=True)
def tridiagonal(matrix: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return diagonal (n,) and neighbours (n - 1,) of a symmetric matrix, with the reflections that made them so.

    Reflection j is 1 - s_j v_j v_jᵀ with v_j row j (n, n) and s_j in scales (n,).
    """
    a = matrix.copy()
    n = a.shape[0]
    diagonal, beside, scales = np.zeros(n), np.zeros(n - 1), np.zeros(n)
    vectors = np.zeros((n, n))
    before, moved, product = np.zeros(n), np.zeros(n), np.zeros(n)
    for j in range(n - 1):
        # The last reflection's change, a -= before movedᵀ + moved beforeᵀ, is due on all rows from j on.
        for k in range(j, n):
            a[j, k] -= before[j] * moved[k] + moved[j] * before[k]
        diagonal[j] = a[j, j]
        length = 0.0
        for k in range(j + 1, n):
            length += a[j, k] * a[j, k]
        length = np.sqrt(length)
        v = vectors[j]
        if length > 0.0 and j < n - 2:
            beside[j] = -length if a[j, j + 1] > 0.0 else length
            scales[j] = 1.0 / (length * length - a[j, j + 1] * beside[j])
            for k in range(j + 1, n):
                v[k] = a[j, k]
            v[j + 1] -= beside[j]
        else:
            beside[j] = a[j, j + 1]
        for k in range(j + 1, n):
            product[k] = 0.0
        for i in range(j + 1, n):
            first, second, third = before[i], moved[i], scales[j] * v[i]
            for k in range(j + 1, n):
                a[i, k] -= first * moved[k] + second * before[k]
                product[k] += third * a[i, k]
        inner = 0.0
        for k in range(j + 1, n):
            inner += product[k] * v[k]
        inner *= 0.5 * scales[j]
        for k in range(j + 1, n):
            before[k] = v[k]
            moved[k] = product[k] - inner * v[k]
    diagonal[n - 1] = a[n - 1, n - 1]
    return diagonal, beside, vectors, scales


NEAR = 1e-6
"""Eigenvalues nearer than this share of the largest get vectors that are made orthogonal."""
PASSES = 3


@entry(cache=True)
def tridiagonal_vectors(diagonal: FloatArray, beside: FloatArray, values: FloatArray) -> FloatArray:
    """Return unit vectors (m, n) of a symmetric tridiagonal matrix to its eigenvalues (m,), in descending order."""
    n, count = diagonal.size, values.size
    vectors = np.zeros((count, n))
    tiny = 2.3e-16 * abs(values[0])
    for r in range(count):
        x = vectors[r]
        for i in range(n):
            x[i] = 1.0 + 0.5 * ((i * 7 + 3) % 11) / 11.0
        for _ in range(PASSES):
            _inverse_step(diagonal, beside, values[r], tiny, x)
            for other in range(r - 1, -1, -1):
                if values[other] - values[r] > NEAR * abs(values[0]):
                    break
                inner = 0.0
                for i in range(n):
                    inner += x[i] * vectors[other, i]
                for i in range(n):
                    x[i] -= inner * vectors[other, i]
            length = 0.0
            for i in range(n):
                length += x[i] * x[i]
            length = np.sqrt(length)
            for i in range(n):
                x[i] /= length
    return vectors


@njit(cache=True)
def _inverse_step(diagonal: FloatArray, beside: FloatArray, value: float, tiny: float, x: FloatArray) -> None:
    """Solve (T - value) y = x in place, scaled; rows are exchanged where the one below has the larger entry."""
    n = x.size
    pivot, first, second = np.zeros(n), np.zeros(n), np.zeros(n)
    a, b = diagonal[0] - value, beside[0]
    for i in range(n - 1):
        below, right = beside[i], diagonal[i + 1] - value
        after = beside[i + 1] if i < n - 2 else 0.0
        if abs(below) > abs(a):
            pivot[i], first[i], second[i] = below, right, after
            factor = a / below
            x[i], x[i + 1] = x[i + 1], x[i] - factor * x[i + 1]
            a, b = b - factor * right, -factor * after
        else:
            pivot[i], first[i] = a if abs(a) > tiny else tiny, b
            factor = below / pivot[i]
            x[i + 1] -= factor * x[i]
            a, b = right - factor * b, after
    pivot[n - 1] = a if abs(a) > tiny else tiny
    largest = 0.0
    for i in range(n - 1, -1, -1):
        if i < n - 1:
            x[i] -= first[i] * x[i + 1]
        if i < n - 2:
            x[i] -= second[i] * x[i + 2]
        x[i] /= pivot[i]
        largest = max(largest, abs(x[i]))
    for i in range(n):
        x[i] /= largest


@entry(cache=True)
def reflect(reflections: FloatArray, scales: FloatArray, vectors: FloatArray) -> None:
    """Take vectors (n, m) of the tridiagonal matrix back to those of the symmetric one, in place."""
    n, m = vectors.shape
    inner = np.zeros(m)
    for j in range(n - 2, -1, -1):
        v = reflections[j]
        inner[:] = 0.0
        for i in range(j + 1, n):
            for k in range(m):
                inner[k] += v[i] * vectors[i, k]
        for i in range(j + 1, n):
            factor = scales[j] * v[i]
            for k in range(m):
                vectors[i, k] -= factor * inner[k]


# Products of matrices summed in one order: the same bits for any number of threads, on any processor.
#
# Four rows at a time. Sums of four times eight numbers stay in registers from the first row to the last.

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
    for i in range(count):
        for k in range(columns):
            filled[i, k] = rows[i, k]
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
