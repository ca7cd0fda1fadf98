"""Modes of the structure with a constant mesh stiffness: natural frequencies and decay of what the mesh excites.

Equations: eigenvalues of the undamped pencil (K, M) and of the state matrix (reference: standard literature).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from siggen.dynamics.equations import Equations, state_matrix
from siggen.dynamics.structure import Structure

FloatArray = NDArray[np.float64]

EXCITED_SHARE = 1e-9
"""Modes whose residue in the bearing displacement is below this share of the largest are not excited by the mesh."""


@dataclass(frozen=True, slots=True)
class Modes:
    """Undamped modes, ascending; rigid ones have frequency 0.

    `frequency_hz` (k,); `shapes` (k, n), mass-normalised, their largest entry positive; `mesh_share` (k,): share of the
    strain energy that is in the mesh, 0 for rigid modes.
    """

    frequency_hz: FloatArray
    shapes: FloatArray
    mesh_share: FloatArray


def natural_modes(structure: Structure, mesh_stiffness_n_per_m: float) -> Modes:
    """Return the modes of the structure with a constant mesh stiffness [N/m]."""
    p = structure.mesh_vector
    root = np.linalg.cholesky(structure.mass)
    stiffness = structure.stiffness + mesh_stiffness_n_per_m * p[:, None] * p[None, :]
    scaled = np.linalg.solve(root, np.linalg.solve(root, stiffness).T)
    values, vectors = np.linalg.eigh(0.5 * (scaled + scaled.T))
    rigid = values < 1e-12 * values[-1]
    values = np.where(rigid, 0.0, values)
    shapes = np.linalg.solve(root.T, vectors).T
    largest = shapes[np.arange(len(shapes)), np.argmax(np.abs(shapes), axis=1)]
    shapes = shapes * np.sign(largest)[:, None]
    # Mass-normalised, so the strain energy of a mode is half its eigenvalue.
    mesh = mesh_stiffness_n_per_m * (shapes @ p) ** 2
    share = np.where(rigid, 0.0, mesh / np.where(rigid, 1.0, values))
    return Modes(np.sqrt(values) / (2.0 * np.pi), shapes, share)


def natural_frequencies_hz(structure: Structure, mesh_stiffness_n_per_m: float) -> FloatArray:
    """Return the undamped natural frequencies (n,) [Hz], ascending, at a constant mesh stiffness; rigid ones are 0."""
    return natural_modes(structure, mesh_stiffness_n_per_m).frequency_hz


def slowest_decay_per_s(structure: Structure, equations: Equations, mesh_damping_n_s_per_m: float) -> float:
    """Return the smallest decay rate [1/s] of the modes that the mesh excites and a bearing shows; 0 if undamped.

    The residue of mode i in the displacement at a bearing, c · r_i l_i · B, tells whether it takes part.
    """
    n = equations.mesh_vector.size
    values, right = np.linalg.eig(state_matrix(equations, equations.reference_stiffness, mesh_damping_n_s_per_m))
    scale = np.abs(values).max()
    moving = np.abs(values) > 1e-6 * scale
    motions = np.array(list(structure.motions.values()))
    inputs = np.concatenate([np.zeros(n), equations.mesh_input])
    # Least squares instead of an inverse: the rigid mode leaves the matrix of eigenvectors without one.
    participation = np.linalg.lstsq(right, inputs.astype(complex), rcond=None)[0]
    seen = np.abs(motions @ right[:n]).max(axis=0)
    residue = np.where(moving, seen * np.abs(participation), 0.0)
    excited = residue > EXCITED_SHARE * residue.max()
    return float(max(0.0, (-values.real[excited]).min()))
