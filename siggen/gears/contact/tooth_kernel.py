r"""ToothKernel: how the teeth of a pair give way across the face, on equal slices.

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

from siggen.arrays import FloatArray
from siggen.compiled import entry

RIGID = 1e-9
"""b/l below which a tooth counts as rigid: T differs from 1/n by 1e-19."""


class ToothKernel(NamedTuple):
    """γ T, γ = C b/κ, on n slices (a named tuple, since compiled code takes no dataclass).

    `strength`, `decay` (n,): γ p and q; `diagonal` (n,): of γ T; `sum`: γ, the sum of a row.
    """

    strength: FloatArray
    decay: FloatArray
    diagonal: FloatArray
    sum: float


def unit_tooth(slices: int, face_width_m: float, length_m: float) -> ToothKernel:
    """Return T itself for n slices of a face b [m] and a length l [m], which may be infinite.

    Raises
    ------
    ValueError
        If the length is not positive.
    """
    if not length_m > 0.0:
        raise ValueError(f"tooth across the face: received a length of {length_m} m; allowed: above 0")
    return ToothKernel(*_free_ends(slices, face_width_m / (slices * length_m)), 1.0)


def tooth_kernel(unit: ToothKernel, compliance_m_per_n: float, face_width_m: float, kappa_per_pa: float) -> ToothKernel:
    """Return γ T of teeth whose compliance C [m/N] bends across a face b [m]; κ is what line loads are counted in."""
    gamma = compliance_m_per_n * face_width_m / kappa_per_pa
    return ToothKernel(gamma * unit.strength, unit.decay, gamma * unit.diagonal, gamma)


def tooth_matrix(kernel: ToothKernel) -> FloatArray:
    """Return the kernel as a full matrix (n, n), for checks."""
    matrix = np.diag(kernel.diagonal)
    for j in range(kernel.diagonal.size):
        matrix[j + 1 :, j] = matrix[j, j + 1 :] = kernel.strength[j + 1 :] * np.cumprod(kernel.decay[j + 1 :])
    return matrix


@entry(cache=True)
def _free_ends(count: int, cell: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return p, q and the diagonal (n,) for cells of the width w/l."""
    strength, decay, diagonal = np.zeros(count), np.ones(count), np.ones(count)
    cell = max(cell, RIGID / count)
    # mean of cosh over a cell over its middle's; two cells
    mean = (sinh(0.5 * cell) / (0.5 * cell)) ** 2 if cell < 100.0 else 0.0
    for i in range(count):
        # cosh(y/l) times 2 exp(-y/l), and from the other end
        end, other = 1.0 + exp(-cell * (2 * i + 1)), 1.0 + exp(-cell * (2 * (count - i) - 1))
        strength[i] = 0.5 * cell * mean * end * other / -expm1(-2.0 * cell * count)
        if i > 0:
            decay[i] = exp(-cell) * (1.0 + exp(-cell * (2 * i - 1))) / end
    # the diagonal is what the others lack to 1
    below, above = 0.0, 0.0
    for i in range(1, count):
        below = decay[i] * (below + 1.0)
        diagonal[i] -= strength[i] * below
        j = count - i
        above = decay[j] * (above + strength[j])
        diagonal[j - 1] -= above
    return strength, decay, diagonal
