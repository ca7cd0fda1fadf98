"""lowest_modes: the lowest modes of K φ = ω² M φ, the same to the last bit for any number of numeric threads.

K = UᵀU (Cholesky). U^-T M U^-1 is made tridiagonal by reflections (Householder); its largest eigenvalues 1/ω² and their
vectors come by bisection and inverse iteration (reference: standard literature). Low modes are then exact to the
rounding of K alone. Library routines for the first two steps sum in an order that depends on threads and processor.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh_tridiagonal, eigvalsh_tridiagonal

from siggen.arrays import FloatArray
from siggen.compiled import njit


class LowestModes(NamedTuple):
    """Squared angular frequencies (m,) ascending [1/s²], shapes (n, m) with modal mass 1, and U (n, n), K = UᵀU."""

    omega_squared: FloatArray
    shapes: FloatArray
    root: FloatArray


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
    return LowestModes(1.0 / inverse, shapes * np.sign(largest), root)


LEAST = 3
"""Modes of a rigid body in one half."""


def _largest(diagonal: FloatArray, beside: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """Return the eigenvalues (m,) above `least`, descending, and their vectors (n, m)."""
    values = eigvalsh_tridiagonal(diagonal, beside, lapack_driver="sterf")
    count = max(LEAST, int((values > least).sum()))
    last = (diagonal.size - count, diagonal.size - 1)
    found, vectors = eigh_tridiagonal(diagonal, beside, select="i", select_range=last, lapack_driver="stebz")
    return found[::-1], np.ascontiguousarray(vectors[:, ::-1])


@njit(cache=True)
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


@njit(cache=True)
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


@njit(cache=True)
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


@njit(cache=True)
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


@njit(cache=True)
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
