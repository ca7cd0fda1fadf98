"""MatrixExponential: e^A of a small matrix, the same to the last bit for any number of numeric threads.

Scaling and squaring with a Taylor series of degree 16 in blocks of four powers, which takes six products (Paterson and
Stockmeyer 1973). Below norm 1/2 the first term left out is below 1e-19. `scipy.linalg.expm` is not used: its last bits
depend on how many threads the linear algebra library runs, even for matrices of this size. The products are sums in
the order of the columns.
"""

from __future__ import annotations

from math import ceil, factorial, log2

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry

LARGEST_NORM = 0.5
BLOCKS = (12, 8, 4, 0)
"""Lowest powers of the blocks, the highest one first; one term stands above them."""


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
    small = np.ascontiguousarray(matrix * 0.5**halvings)
    square = _product(small, small)
    powers = (np.eye(len(matrix)), small, square, _product(square, small))
    fourth = _product(square, square)
    result = np.zeros_like(small)
    for lowest in BLOCKS:
        block = sum(power / factorial(lowest + k) for k, power in enumerate(powers))
        ahead = fourth / factorial(lowest + 4) if lowest == BLOCKS[0] else _product(result, fourth)
        result = ahead + block
    for _ in range(halvings):
        result = _product(result, result)
    return result


@entry(cache=True)
def _product(left: FloatArray, right: FloatArray) -> FloatArray:
    result = np.zeros((left.shape[0], right.shape[1]))
    for i in range(left.shape[0]):
        for j in range(left.shape[1]):
            factor = left[i, j]
            for k in range(right.shape[1]):
                result[i, k] += factor * right[j, k]
    return result
