r"""ToothKernel: how two teeth give way across the face, on equal slices.

Derived. A tooth bends and shears under a line load q(y), and a load at y' also deflects the tooth at y:

    t(y) = C b ∫ G(y, y') q(y') dy',   G = cosh(y_</l) cosh((b - y_>)/l)/(l sinh(b/l)),   y from one end of the face b

G is Green's function of t - l² t'' = C b q with free ends t' = 0: a tooth whose slices hang together by a moment that
resists twisting. ∫ G dy' = 1 at every y, so that an even load deflects the tooth evenly by C F, as if it were rigid
across the face; l → ∞ is the rigid tooth for every load. Averaged over the cells, T_ij = w G_ij has rows of sum 1
exactly and the same form, p_i Π q_k (`exponential_matrix`), so that a solution takes steps in proportion to n.
"""

from __future__ import annotations

from math import exp, expm1, sinh
from typing import NamedTuple

import numpy as np
from numba import njit

from siggen.arrays import FloatArray
from siggen.gears.contact.exponential_matrix import ROW_TERMS

RIGID = 1e-9
"""b/l below which a tooth counts as rigid: T differs from 1/n by 1e-19."""


class ToothKernel(NamedTuple):
    """γ_1 T_1 + γ_2 T_2, γ = C b/κ, on n slices (a named tuple, since compiled code takes no dataclass).

    `strength`, `decay` (n, ROW_TERMS): p and q of both teeth; `diagonal` (n,); `sum`: γ_1 + γ_2, the sum of a row.
    """

    strength: FloatArray
    decay: FloatArray
    diagonal: FloatArray
    sum: float


def tooth_kernel(
    slices: int, face_width_m: float, length_m: FloatArray, compliance_m_per_n: FloatArray, kappa_per_pa: float
) -> ToothKernel:
    """Return the kernel of both teeth at one position.

    Parameters
    ----------
    slices, face_width_m : n and b [m]
    length_m, compliance_m_per_n : (2,)
        l, which may be infinite, and C of the pinion's and the gear's tooth [m], [m/N].
    kappa_per_pa : float
        κ, which line loads are counted in.

    Raises
    ------
    ValueError
        If a length is not positive or a compliance is negative.
    """
    if not (np.all(length_m > 0.0) and np.all(compliance_m_per_n >= 0.0)):
        raise ValueError(
            f"tooth across the face: received lengths {length_m} m and compliances {compliance_m_per_n} m/N; "
            "allowed: lengths above 0, compliances from 0"
        )
    gamma = compliance_m_per_n * face_width_m / kappa_per_pa
    return ToothKernel(*_terms(slices, face_width_m / (slices * length_m), gamma), float(gamma.sum()))


def tooth_matrix(kernel: ToothKernel) -> FloatArray:
    """Return the kernel as a full matrix (n, n), for checks."""
    count = kernel.diagonal.size
    matrix = np.diag(kernel.diagonal)
    for j in range(count):
        below = kernel.strength[j + 1 :] * np.cumprod(kernel.decay[j + 1 :], axis=0)
        matrix[j + 1 :, j] = matrix[j, j + 1 :] = below.sum(axis=1)
    return matrix


@njit(cache=True)
def _terms(count: int, cells: FloatArray, gamma: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return p, q (n, ROW_TERMS) and the diagonal (n,) for cells of widths w/l."""
    strength, decay = np.zeros((count, ROW_TERMS)), np.ones((count, ROW_TERMS))
    diagonal, sums = np.zeros(count), np.zeros(count)
    for t in range(ROW_TERMS):
        cell = max(cells[t], RIGID / count)
        # mean of cosh over a cell over its middle's; two cells
        mean = (sinh(0.5 * cell) / (0.5 * cell)) ** 2 if cell < 100.0 else 0.0
        whole = 0.5 * gamma[t] * cell * mean / -expm1(-2.0 * cell * count)
        for i in range(count):
            # cosh(y/l) times 2 exp(-y/l), and from the other end
            end, other = 1.0 + exp(-cell * (2 * i + 1)), 1.0 + exp(-cell * (2 * (count - i) - 1))
            strength[i, t] = whole * end * other
            if i > 0:
                decay[i, t] = exp(-cell) * (1.0 + exp(-cell * (2 * i - 1))) / end
        # the diagonal is what the others lack to γ
        below, above = 0.0, 0.0
        sums[:] = 0.0
        for i in range(1, count):
            below = decay[i, t] * (below + 1.0)
            sums[i] += strength[i, t] * below
            j = count - i
            above = decay[j, t] * (above + strength[j, t])
            sums[j - 1] += above
        for i in range(count):
            diagonal[i] += gamma[t] - sums[i]
    return strength, decay, diagonal
