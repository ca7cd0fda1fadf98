"""MatrixExponential: e^A of a small matrix, the same to the last bit for any number of numeric threads.

Scaling and squaring with a Taylor series (reference: standard literature). Below norm 1/2 the first term left out is
below 1e-22. `scipy.linalg.expm` is not used: its last bits depend on how many threads the linear algebra library runs,
even for matrices of this size. The products are sums in the order of the columns.
"""

from __future__ import annotations

from math import ceil, log2

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit

LARGEST_NORM = 0.5
TERMS = 18


def matrix_exponential(matrix: FloatArray) -> FloatArray:
    """Return e^A (n, n) of a finite real matrix A (n, n), dimensionless.

    Raises
    ------
    ValueError
        If the matrix is not square or not finite.
    """
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not np.isfinite(matrix).all():
        raise ValueError(f"matrix: received shape {matrix.shape}; allowed are finite square matrices")
    norm = float(np.abs(matrix).sum(axis=0).max(initial=0.0))
    halvings = max(0, ceil(log2(norm / LARGEST_NORM))) if norm > 0.0 else 0
    small = matrix * 0.5**halvings
    identity = np.eye(len(matrix))
    result = identity
    for term in range(TERMS, 0, -1):
        result = identity + _product(small, result) / term
    for _ in range(halvings):
        result = _product(result, result)
    return result


@njit(cache=True)
def _product(left: FloatArray, right: FloatArray) -> FloatArray:
    result = np.zeros((left.shape[0], right.shape[1]))
    for i in range(left.shape[0]):
        for j in range(left.shape[1]):
            factor = left[i, j]
            for k in range(right.shape[1]):
                result[i, k] += factor * right[j, k]
    return result
