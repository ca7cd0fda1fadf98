"""Modes of the structure with a constant mesh stiffness: natural frequencies and decay of what the mesh excites.

Equations: eigenvalues of the undamped pencil (K, M) and of the state matrix (reference: standard literature).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.structure import Structure, elastic_basis, free_rotations
from siggen.motion.equations import Equations, mesh_springs, state_matrix

EXCITED_SHARE = 1e-9
"""Modes whose residue in what is shown is below this share of the largest are not excited by the mesh."""


@dataclass(frozen=True, slots=True)
class MotionModes:
    """Undamped modes, ascending; rigid ones have frequency 0.

    `frequency_hz` (k,); `shapes` (k, n), mass-normalised, their largest entry positive; `mesh_share` (k,): share of the
    strain energy that is in the meshes, 0 for rigid modes.
    """

    frequency_hz: FloatArray
    shapes: FloatArray
    mesh_share: FloatArray


def natural_modes(structure: Structure, mesh_stiffness_n_per_m: float | Sequence[float]) -> MotionModes:
    """Return the modes of the structure with a constant stiffness [N/m] of the mesh, or of each of its meshes."""
    of_meshes = np.atleast_1d(np.asarray(mesh_stiffness_n_per_m, dtype=np.float64))
    stiffness = structure.stiffness + mesh_springs(structure, of_meshes)
    basis = elastic_basis(structure, stiffness)
    scaled = basis.T @ stiffness @ basis
    elastic, vectors = np.linalg.eigh(0.5 * (scaled + scaled.T))
    free = _orthonormal(free_rotations(structure, stiffness), structure.mass)
    values = np.concatenate([np.zeros(free.shape[1]), elastic])
    shapes = np.hstack([free, basis @ vectors]).T
    rigid = np.arange(values.size) < free.shape[1]
    largest = shapes[np.arange(len(shapes)), np.argmax(np.abs(shapes), axis=1)]
    shapes = shapes * np.sign(largest)[:, None]
    # Mass-normalised, so the strain energy of a mode is half its eigenvalue.
    mesh = sum(k * (shapes @ one.vector) ** 2 for k, one in zip(of_meshes, structure.meshes, strict=True))
    share = np.where(rigid, 0.0, mesh / np.where(rigid, 1.0, values))
    return MotionModes(np.sqrt(values) / (2.0 * np.pi), shapes, share)


def _orthonormal(vectors: FloatArray, mass: FloatArray) -> FloatArray:
    """Return vectors (n, r) of the same space that are orthonormal in M."""
    root = np.linalg.cholesky(mass)
    return np.linalg.solve(root.T, np.linalg.qr(root.T @ vectors)[0])


def slowest_decay_per_s(
    structure: Structure,
    equations: Equations,
    mesh_damping_n_s_per_m: FloatArray,
    *,
    at_meshes: bool = False,
) -> float:
    """Return the smallest decay rate [1/s] of the modes that the mesh excites and a bearing shows; 0 if undamped.

    `at_meshes`: those count too that approaches of meshes show alone.

    The residue of mode i in the displacement at a bearing, c · r_i l_i · B, tells whether it takes part.
    """
    stiffness = equations.reference_stiffness
    basis = elastic_basis(structure, structure.stiffness + mesh_springs(structure, stiffness))
    n, m = basis.shape
    # In this basis the mass is the identity, and no free rotation is left.
    matrix = np.zeros((2 * m, 2 * m))
    full = state_matrix(equations, stiffness, mesh_damping_n_s_per_m)[n:]
    matrix[:m, m:] = np.eye(m)
    matrix[m:, :m], matrix[m:, m:] = (basis.T @ structure.mass @ full[:, half] @ basis for half in _halves(n))
    values, right = np.linalg.eig(matrix)
    approaches = [mesh.vector for mesh in structure.meshes] if at_meshes else []
    motions = np.array([*structure.motions.values(), *approaches]) @ basis
    excited = np.zeros(len(values), dtype=bool)
    for mesh in structure.meshes:
        inputs = np.concatenate([np.zeros(m), basis.T @ mesh.vector])
        # Least squares, since equal modes may leave the matrix of eigenvectors without an inverse.
        participation = np.linalg.lstsq(right, inputs.astype(complex), rcond=None)[0]
        residue = np.abs(motions @ right[:m]).max(axis=0) * np.abs(participation)
        excited |= residue > EXCITED_SHARE * residue.max()
    return float(max(0.0, (-values.real[excited]).min()))


def _halves(n: int) -> tuple[slice, slice]:
    """Return where displacements and velocities stand in a state (2n,)."""
    return slice(0, n), slice(n, 2 * n)
