r"""UnevenTeeth: a tooth that is softer in a part of the face, by a crack whose depth is not the same everywhere.

Derived. A sound tooth is slices on springs that hang together (`tooth_kernel`): per unit of its compliance C the
deflection t under line loads q solves (1 + L) t = q, 1 + L the inverse of T and L 1 = 0. A crack softens the springs,
the one of slice i from 1/C to 1/(C + Δ_i), and with them what slices hang together by, so that T keeps its length:

    (k L + 1 - φ_i) t = q,    φ_i = Δ_i/(C + Δ_i),    k = 1 - mean φ

An even crack is C + Δ times the T of the sound tooth. A tooth that is rigid across the face (l → ∞) has the mean
stiffness of its slices. Finite elements in three dimensions: `tests.reference.finite_elements.part_crack`.

Pinion and gear tooth are one kernel of this form. Under an even load it gives way as both together do in each slice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.contact.tooth_kernel import ToothKernel, tooth_matrix


class UnevenTeeth(NamedTuple):
    """Of pinion and gear tooth at positions (k,): C (2, k), and Δ (2, k, n) on the slices [m/N]."""

    sound_m_per_n: FloatArray
    added_m_per_n: FloatArray

    def at(self, chosen: np.ndarray) -> UnevenTeeth:
        """Return them at some of the positions."""
        return UnevenTeeth(self.sound_m_per_n[:, chosen], self.added_m_per_n[:, chosen])

    def kernel(self, unit: ToothKernel, i: int, face_width_m: float, kappa_per_pa: float) -> ToothKernel:
        """Return γ T of both teeth at position i; `unit` is that of sound teeth."""
        matrix = _softened(tooth_matrix(unit), self.sound_m_per_n[:, i], self.added_m_per_n[:, i])
        gamma = float(self.sound_m_per_n[:, i].sum()) * face_width_m / kappa_per_pa
        strength, decay = _generators(matrix)
        return ToothKernel(
            gamma * strength, decay, gamma * np.diagonal(matrix).copy(), gamma * float(matrix.sum(axis=1).mean())
        )


def _softened(unit: FloatArray, sound: FloatArray, added: FloatArray) -> FloatArray:
    """Return T (n, n) of two teeth over the sum of their C (2,), from that of sound ones and Δ (2, n)."""
    count, shares = len(unit), sound / sound.sum()
    deflection, hanging, softer = np.zeros(count), np.zeros(count), 0.0
    for share, own, more in zip(shares, sound, added, strict=True):
        if share == 0.0:
            continue
        lost = more / (own + more)
        kept = 1.0 - lost.mean()
        # with 1 + L = inverse of T, times T: no inverse is needed, and a rigid tooth has none
        alone = np.linalg.solve(kept * np.eye(count) + unit * (lost.mean() - lost), np.ones(count))
        deflection += share * alone
        hanging += share * (1.0 - (1.0 - lost) * alone) / kept
        softer += share / kept
    kept = 1.0 / softer
    springs = (1.0 - kept * hanging) / deflection
    found = np.linalg.solve(kept * np.eye(count) + unit * (springs - kept), unit)
    return 0.5 * (found + found.T)


def _generators(matrix: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return p and q (n,) of a matrix T_ij = p_i Π q_k, j < k <= i, from three diagonals."""
    beside, next_but_one = np.diagonal(matrix, -1), np.diagonal(matrix, -2)
    decay = np.ones(len(matrix))
    decay[1:-1] = next_but_one / beside[1:]
    strength = np.append(1.0, beside / decay[1:])
    return strength, decay
