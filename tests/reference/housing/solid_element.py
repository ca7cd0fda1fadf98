"""Stiffness and mass of hexahedra with eight nodes and incompatible modes, which bend without locking.

Taylor, Beresford and Wilson (1976), from memory: nine internal modes 1 - ξ_i² whose gradients take the Jacobian of the
element's centre, so that distorted elements pass the patch test; they are condensed (reference: standard literature).
"""

from __future__ import annotations

import numpy as np

CORNERS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], dtype=float
)
POINTS = CORNERS / np.sqrt(3.0)


def element_matrices(
    corners_m: np.ndarray, youngs_modulus_pa: float, poisson_ratio: float, density_kg_m3: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and consistent mass (elements, 24, 24) of hexahedra with corners (elements, 8, 3)."""
    elastic = _elastic(youngs_modulus_pa, poisson_ratio)
    count = len(corners_m)
    uu, ua, aa = np.zeros((count, 24, 24)), np.zeros((count, 24, 9)), np.zeros((count, 9, 9))
    mass = np.zeros((count, 8, 8))
    centre = _slopes(np.zeros(3)) @ corners_m
    centre_inverse, centre_det = np.linalg.inv(centre), np.linalg.det(centre)
    for point in POINTS:
        jacobian = _slopes(point) @ corners_m
        det = np.linalg.det(jacobian)
        strain = _strain(np.linalg.inv(jacobian) @ _slopes(point))
        inner = np.diag(-2.0 * point)
        incompatible = _strain((centre_det / det)[:, None, None] * (centre_inverse @ inner))
        stress, inner_stress = elastic @ strain, elastic @ incompatible
        weight = det[:, None, None]
        uu += weight * (strain.transpose(0, 2, 1) @ stress)
        ua += weight * (strain.transpose(0, 2, 1) @ inner_stress)
        aa += weight * (incompatible.transpose(0, 2, 1) @ inner_stress)
        shape = np.prod(0.5 * (1.0 + CORNERS * point), axis=1)
        mass += density_kg_m3 * weight * np.outer(shape, shape)
    stiffness = uu - ua @ np.linalg.solve(aa, ua.transpose(0, 2, 1))
    return stiffness, np.einsum("eij,cd->eicjd", mass, np.eye(3)).reshape(count, 24, 24)


def _slopes(point: np.ndarray) -> np.ndarray:
    """Return derivatives (3, 8) of the shape functions at a point of the parent cube."""
    factors = 0.5 * (1.0 + CORNERS * point)
    rows = [0.5 * CORNERS[:, i] * np.prod(np.delete(factors, i, axis=1), axis=1) for i in range(3)]
    return np.array(rows)


def _strain(gradients: np.ndarray) -> np.ndarray:
    """Return strain (elements, 6, 3 n) of displacements whose shape functions have gradients (elements, 3, n)."""
    count, _, n = gradients.shape
    gx, gy, gz = gradients[:, 0], gradients[:, 1], gradients[:, 2]
    found = np.zeros((count, 6, n, 3))
    for row, axis, slope in ((0, 0, gx), (1, 1, gy), (2, 2, gz), (3, 0, gy), (3, 1, gx), (4, 1, gz), (4, 2, gy)):
        found[:, row, :, axis] = slope
    found[:, 5, :, 0], found[:, 5, :, 2] = gz, gx
    return found.reshape(count, 6, 3 * n)


def _elastic(youngs_modulus_pa: float, ratio: float) -> np.ndarray:
    shear = youngs_modulus_pa / (2.0 * (1.0 + ratio))
    lame = youngs_modulus_pa * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio))
    found = np.diag([2.0 * shear] * 3 + [shear] * 3)
    found[:3, :3] += lame
    return found
