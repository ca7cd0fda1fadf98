"""modal_sum: accelerances as sums over modes, in one order, so that they have the same bits on any processor.

A block of frequencies at a time: what a mode does there is computed once for all rows and stays in the cache.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.compiled import entry

BLOCK = 512


@entry(cache=True, error_model="numpy")
def modal_sum(
    residues: FloatArray, natural: FloatArray, damping_ratio: FloatArray, residual: FloatArray, omega: FloatArray
) -> ComplexArray:
    """Return Σ_r R_r (-ω²)/(ω_r² - ω² + 2 i ζ_r ω_r ω) - ω² R_oi (rows, k).

    Parameters
    ----------
    residues : (rows, modes) φ_r(o) φ_r(i)
    natural, damping_ratio : (modes,) ω_r [rad/s] and ζ_r
    residual : (rows,) R_oi [m/N]
    omega : (k,) ω [rad/s]
    """
    rows, count = residues.shape[0], omega.size
    total = np.empty((rows, count), dtype=np.complex128)
    real, imaginary = np.empty(BLOCK), np.empty(BLOCK)
    sums = np.empty((2, rows, BLOCK))
    for start in range(0, count, BLOCK):
        w = omega[start : start + BLOCK]
        sums[:] = 0.0
        for r in range(natural.size):
            square, double = natural[r] * natural[r], 2.0 * damping_ratio[r] * natural[r]
            for i in range(w.size):
                stiff, damped = square - w[i] * w[i], double * w[i]
                share = -w[i] * w[i] / (stiff * stiff + damped * damped)
                real[i], imaginary[i] = share * stiff, -share * damped
            for row in range(rows):
                residue = residues[row, r]
                for i in range(w.size):
                    sums[0, row, i] += residue * real[i]
                    sums[1, row, i] += residue * imaginary[i]
        for row in range(rows):
            for i in range(w.size):
                total[row, start + i] = complex(sums[0, row, i] - w[i] * w[i] * residual[row], sums[1, row, i])
    return total
