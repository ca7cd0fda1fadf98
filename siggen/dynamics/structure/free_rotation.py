"""Rotations that no spring opposes, and equilibrium without them.

Derived. Only rotations can be free: all shafts turning in the ratio of the base radii, and, without any mesh stiffness,
either shaft line by itself. They follow from the mesh vector, whatever the other springs are: an eigenvalue that is
small beside those of stiff bearings would not tell them from a soft coupling.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Structure

FREE_SHARE = 1e-13
"""Strain energy over the sum of its absolute terms below which a rotation deforms nothing: rounding leaves 1e-16; the
1 Hz spring that holds the load has 1e-6, or 1e-12 beside couplings a million times stiffer than steel shafts."""

UNBALANCED_SHARE = 1e-9
"""Share of a force's absolute work on a free rotation above which no equilibrium exists."""


def free_rotations(structure: Structure, stiffness: FloatArray) -> FloatArray:
    """Return the free rotations (n, r), r from 0 to the number of shaft lines, of a structure.

    `stiffness` (n, n) is that of the structure with its mesh.
    """
    lines = np.ascontiguousarray(structure.lines.T)
    energy = lines.T @ stiffness @ lines
    scale = np.abs(lines).T @ np.abs(stiffness) @ np.abs(lines)
    values, vectors = np.linalg.eigh(energy / max(scale.max(), np.finfo(float).tiny))
    return np.asarray(lines @ vectors[:, values < FREE_SHARE])


def static_solution(structure: Structure, stiffness: FloatArray, force: FloatArray) -> FloatArray:
    """Return the displacement (n,) under a balanced force (n,) without any free rotation in it (orthogonal in M).

    Parameters
    ----------
    structure : Structure
    stiffness : (n, n)
        Of the structure with its mesh.
    force : (n,)

    Raises
    ------
    ValueError
        If the force does work on a free rotation: then no equilibrium exists.
    """
    free = free_rotations(structure, stiffness)
    work = np.abs(free.T @ force)
    if (work > UNBALANCED_SHARE * (np.abs(free).T @ np.abs(force))).any():
        raise ValueError(
            f"static load: received an unbalanced force {force}; allowed are torques that balance the load"
        )
    # Rows and columns scaled to unit diagonal, so that springs of any stiffness are solved with the same accuracy.
    scale = 1.0 / np.sqrt(np.diag(stiffness))
    held = (structure.mass @ free) * scale[:, None]
    held /= np.sqrt((held**2).sum(axis=0))
    bordered = np.block([[stiffness * scale[:, None] * scale, held], [held.T, np.zeros((held.shape[1],) * 2)]])
    right = np.concatenate([force * scale, np.zeros(held.shape[1])])
    return np.linalg.solve(bordered, right)[: force.size] * scale


def elastic_basis(structure: Structure, stiffness: FloatArray) -> FloatArray:
    """Return a basis (n, n - r), orthonormal in M, of the motions that are orthogonal in M to the free rotations."""
    root = np.linalg.cholesky(structure.mass)
    free = root.T @ free_rotations(structure, stiffness)
    complete, _ = np.linalg.qr(free, mode="complete")
    return np.linalg.solve(root.T, complete[:, free.shape[1] :])
