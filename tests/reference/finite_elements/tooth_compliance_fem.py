"""Tooth compliance by plane finite elements: quadratic triangles, bore clamped, contact part left out.

Unit force along the line of action on the flank; the displacement along the line of action is read where that line
crosses the tooth's centre line (the convention of the tooth compliance models, so no local contact is in it).
One factorisation serves all load positions: c_ij = g_i' K^-1 f_j with load vectors f and reading vectors g.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu
from scipy.spatial import cKDTree

from tests.reference.finite_elements.tooth_mesh import DEFAULT_SIZE, ToothMesh, tooth_mesh, turned

if TYPE_CHECKING:
    from siggen.gears.gear_pair import SpurGear


@dataclass(frozen=True, slots=True)
class PlaneElasticity:
    """Isotropic plane elasticity; compliances are given for E L = 1."""

    poisson_ratio: float = 0.3
    plane_strain: bool = False

    def lame(self) -> tuple[float, float]:
        """First and second Lamé parameter of the plane problem for E = 1."""
        nu = self.poisson_ratio
        shear = 1 / (2 * (1 + nu))
        return (nu / ((1 + nu) * (1 - 2 * nu)) if self.plane_strain else nu / (1 - nu**2)), shear


def compliance_matrix(gear: SpurGear, load_roll: np.ndarray, elasticity: PlaneElasticity, size: float) -> np.ndarray:
    """Compliances between all load positions of all teeth on the ring, times E L.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    load_roll : (t, k) array
        Roll angles [rad] of the load points of each of the t teeth; tooth i is turned clockwise by i pitches.
    elasticity : PlaneElasticity
        Plane stress or plane strain.
    size : float
        Edge length on the tooth, in modules.

    Returns
    -------
    (t k, t k) array
        Entry (i, j): displacement read for position i due to a unit force at position j, dimensionless.
    """
    crossing, way = lines_of_action(gear, load_roll)
    basis, displacement = displacements(tooth_mesh(gear, load_roll, size), way, elasticity)
    return np.asarray(interior_functionals(basis, crossing.reshape(-1, 2), way.reshape(-1, 2)) @ displacement)


def tooth_compliance(
    gear: SpurGear, roll: np.ndarray, elasticity: PlaneElasticity | None = None, size: float = DEFAULT_SIZE
) -> np.ndarray:
    """Compliance of one tooth on its ring times E L, without contact.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : (k,) array
        Roll angles of the loaded flank points [rad].
    elasticity : PlaneElasticity, optional
        Plane stress with Poisson's ratio 0.3 if left out.
    size : float
        Edge length on the tooth, in modules.

    Returns
    -------
    (k,) array
        Dimensionless; divide by E L for m/N.
    """
    matrix = compliance_matrix(gear, np.atleast_2d(roll), elasticity or PlaneElasticity(), size)
    return np.diag(matrix).copy()


def lines_of_action(gear: SpurGear, load_roll: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Crossings of the lines of action with the centre lines, and force directions.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    load_roll : (t, k) array
        Roll angles [rad]; tooth i is turned clockwise by i pitches.

    Returns
    -------
    ((t, k, 2) array, (t, k, 2) array)
        Points in modules, unit vectors.
    """
    angle = load_roll - gear.base_half_angle_rad
    crossing = np.stack([np.zeros_like(angle), gear.base_radius_m / gear.module_m / np.cos(angle)], axis=-1)
    direction = -np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    turns = 2 * np.pi / gear.teeth * np.arange(len(load_roll))
    crossing, direction = (
        np.stack([turned(a, t) for a, t in zip(v, turns, strict=True)]) for v in (crossing, direction)
    )
    return crossing, direction


def displacements(mesh: ToothMesh, way: np.ndarray, elasticity: PlaneElasticity) -> tuple[Any, np.ndarray]:
    """Displacements under a unit force at each load point of a mesh, one factorisation for all.

    Parameters
    ----------
    mesh : ToothMesh
        Mesh with t teeth of k load points.
    way : (t, k, 2) array
        Directions of the forces.
    elasticity : PlaneElasticity
        Plane stress or plane strain.

    Returns
    -------
    (basis, (n, t k) array)
        scikit-fem basis and its degrees of freedom, in modules times force / (E L module).

    Raises
    ------
    ValueError
        If a load point is no node of the mesh.
    """
    basis = plane_basis(mesh)
    load = nodal_functionals(basis, mesh.load_points.reshape(-1, 2), way.reshape(-1, 2))
    return basis, solve(basis, mesh.bore_radius, load.toarray().T, elasticity)


def solve(basis: Any, bore_radius: float, loads: np.ndarray, elasticity: PlaneElasticity) -> np.ndarray:
    """Return the displacements (n, k) under load vectors (n, k) on the basis' degrees of freedom, bore clamped."""
    free = free_dofs(basis, bore_radius)
    out = np.zeros(loads.shape)
    factor = factorised(_stiffness(basis, elasticity)[free][:, free])
    out[free] = factor.solve(np.ascontiguousarray(loads[free]))
    return out


def factorised(matrix: sparse.csr_matrix) -> SuperLU:
    """Return the factors of a symmetric positive definite matrix: no pivoting, and an order that keeps fill small."""
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def plane_basis(mesh: ToothMesh) -> Any:
    """Return the scikit-fem basis of quadratic triangles of a mesh."""
    from skfem import Basis, ElementTriP2, ElementVector, MeshTri

    return Basis(MeshTri(mesh.points, mesh.triangles), ElementVector(ElementTriP2()), intorder=2)


def _stiffness(basis: Any, elasticity: PlaneElasticity) -> sparse.csr_matrix:
    from skfem.models.elasticity import linear_elasticity

    return linear_elasticity(*elasticity.lame()).assemble(basis).tocsr()


def free_dofs(basis: Any, bore_radius: float) -> np.ndarray:
    """Return the degrees of freedom off the clamped bore."""
    mesh = basis.mesh
    boundary = mesh.boundary_facets()
    radius = np.hypot(*mesh.p)[mesh.facets[:, boundary]]
    clamped = basis.get_dofs(boundary[np.all(np.isclose(radius, bore_radius, rtol=1e-9), axis=0)])
    return basis.complement_dofs(clamped)


def nodal_functionals(basis: Any, points: np.ndarray, ways: np.ndarray) -> sparse.csr_matrix:
    """Rows that give the displacement at mesh nodes along `ways`."""
    distance, node = cKDTree(basis.mesh.p.T).query(points)
    if distance.max() > 1e-9:
        raise ValueError(f"load points must be nodes of the mesh; the farthest is {distance.max():.2e} modules away")
    rows = np.repeat(np.arange(len(points)), 2)
    columns = basis.nodal_dofs[:, node].T.ravel()
    return sparse.csr_matrix((ways.ravel(), (rows, columns)), shape=(len(points), basis.N))


def interior_functionals(basis: Any, points: np.ndarray, ways: np.ndarray) -> sparse.csr_matrix:
    """Rows that give the displacement at interior points along `ways`."""
    probes = basis.probes(points.T).tocsr()
    count = len(points)
    along = [sparse.diags(ways[:, i]) @ probes[i * count : (i + 1) * count] for i in (0, 1)]
    return (along[0] + along[1]).tocsr()
