"""SolidBox: modes and accelerance of a housing by three-dimensional finite elements, independent of plate theory."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from siggen.drivetrain.box import Bolt, Box
from tests.reference.housing.solid_element import element_matrices
from tests.reference.housing.solid_mesh import SolidMesh, solid_mesh

CHUNK = 2000
EDGE_M = 0.006
"""Nodes so far beyond a bolt's patch still belong to it: within a wall no line of the grid can follow its edge."""


class SolidBox(NamedTuple):
    """Mesh, squared angular frequencies (m,), shapes (3 n, m) with modal mass 1, and the solver of K u = f."""

    mesh: SolidMesh
    omega_squared: np.ndarray
    shapes: np.ndarray
    solve: object
    mass_kg: float

    @property
    def frequency_hz(self) -> np.ndarray:
        """Natural frequencies."""
        return np.sqrt(np.maximum(self.omega_squared, 0.0)) / (2.0 * np.pi)

    def accelerance(
        self, outputs: list[np.ndarray], inputs: list[np.ndarray], frequency_hz: np.ndarray, damping: float
    ) -> np.ndarray:
        """Return accelerances (outputs, inputs, k) with the residual of all higher modes."""
        omega, natural = 2.0 * np.pi * frequency_hz, np.sqrt(self.omega_squared)[:, None]
        shares = -(omega**2) / (natural**2 - omega**2 + 2j * damping * natural * omega)
        at_outputs, at_inputs = np.array(outputs) @ self.shapes, np.array(inputs) @ self.shapes
        static = np.array([np.array(outputs) @ self.solve(one) for one in inputs]).T
        residual = static - (at_outputs / self.omega_squared) @ at_inputs.T
        summed = np.einsum("om,im,mk->oik", at_outputs, at_inputs, shares)
        return summed - omega**2 * residual[:, :, None]


def solid_box(box: Box, element_m: float, modes: int, loose_share: float = 1.0) -> SolidBox:
    """Return the lowest modes of a box on its bolts; the last one behind has a share of its stiffness left."""
    mesh = solid_mesh(box, element_m)
    stiffness, mass = _assembled(mesh, box)
    ones = np.zeros(mass.shape[0])
    ones[::3] = 1.0
    weight = float(ones @ (mass @ ones))
    for bolt in box.bolts:
        for z in (bolt.z_m, box.size_m[2] - bolt.z_m):
            left = loose_share if bolt is box.bolts[-1] and z != bolt.z_m else 1.0
            stiffness = stiffness + left * _spring(mesh, box, bolt, z)
    factored = splu(
        stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    inverse = LinearOperator(stiffness.shape, matvec=factored.solve)
    values, shapes = eigsh(stiffness, modes, mass, sigma=0.0, OPinv=inverse, v0=np.ones(mass.shape[0]))
    order = np.argsort(values)
    return SolidBox(mesh, values[order], shapes[:, order], factored.solve, weight)


def _around(angle: np.ndarray) -> np.ndarray:
    """Return the share of the circle that belongs to each angle; equal angles share alike elsewhere."""
    places, inverse = np.unique(np.round(angle, 6), return_inverse=True)
    gaps = np.diff(np.concatenate([places[-1:] - 2.0 * np.pi, places, places[:1] + 2.0 * np.pi]))
    return (0.5 * (gaps[:-1] + gaps[1:]) / (2.0 * np.pi))[inverse]


def _through(depth: np.ndarray) -> np.ndarray:
    """Return the share of the thickness that belongs to each depth."""
    places, inverse = np.unique(np.round(depth, 6), return_inverse=True)
    gaps = np.diff(places)
    shares = np.zeros(places.size)
    shares[:-1] += 0.5 * gaps
    shares[1:] += 0.5 * gaps
    return (shares / shares.sum())[inverse]


def _balanced(weight: np.ndarray, x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Return weights near those given that add to 1 and whose middle is at x = z = 0."""
    rows = np.array([np.ones(x.size), x, z])
    missing = np.array([1.0, 0.0, 0.0]) - rows @ weight
    return weight + rows.T @ np.linalg.solve(rows @ rows.T, missing)


def _assembled(mesh: SolidMesh, box: Box) -> tuple[sparse.csc_matrix, sparse.csc_matrix]:
    size = 3 * len(mesh.nodes)
    stiffness, mass = sparse.csc_matrix((size, size)), sparse.csc_matrix((size, size))
    own = box.material
    for first in range(0, len(mesh.elements), CHUNK):
        elements = mesh.elements[first : first + CHUNK]
        k, m = element_matrices(mesh.nodes[elements], own.youngs_modulus_pa, own.poisson_ratio, own.density_kg_m3)
        numbers = (3 * elements[:, :, None] + np.arange(3)).reshape(len(elements), 24)
        rows, columns = np.repeat(numbers, 24, axis=1).ravel(), np.tile(numbers, (1, 24)).ravel()
        stiffness = stiffness + sparse.csc_matrix((k.ravel(), (rows, columns)), (size, size))
        mass = mass + sparse.csc_matrix((m.ravel(), (rows, columns)), (size, size))
    return stiffness, mass


def _spring(mesh: SolidMesh, box: Box, bolt: Bolt, z_m: float) -> sparse.csc_matrix:
    """Return a bolt's stiffness on the mean of its patch's nodes on both surfaces of the floor."""
    half, floor = 0.5 * bolt.patch_m + EDGE_M, 0.5 * box.thickness.floor_m + 1e-6
    away = np.abs(mesh.nodes - np.array([bolt.x_m, 0.0, z_m]))
    on = np.flatnonzero((away[:, 0] < half) & (away[:, 1] < floor) & (away[:, 2] < half))
    x, z = mesh.nodes[on, 0], mesh.nodes[on, 2]
    weight = _balanced(_through(x) * _through(z), x - bolt.x_m, z - z_m)
    size = 3 * len(mesh.nodes)
    total = sparse.csc_matrix((size, size))
    for axis, stiffness in enumerate(bolt.stiffness_n_per_m):
        row = sparse.csc_matrix((weight, (np.zeros(on.size, dtype=int), 3 * on + axis)), (1, size))
        total = total + stiffness * (row.T @ row)
    return total
