r"""Three-dimensional elasticity of a plane mesh extruded over the face: prisms, quadratic in plane and across the face.

The ends of the face are free, the bore is clamped along its whole length. Displacements are products of plane shape
functions (quadratic triangles) and shape functions across the face (quadratic elements, finer at the ends), so the
stiffness is a sum of Kronecker products of plane and face matrices. With M, S, G the face's mass, stiffness and
∫ψ_i ψ_j' dy, in-plane displacements p and the axial one w, derived from the energy λ/2 (div u)² + μ ε:ε:

    K_pp = A ⊗ M + μ M_p ⊗ S,   K_ww = μ L ⊗ M + (λ + 2 μ) M_w ⊗ S,   K_pw = λ D ⊗ G + μ E ⊗ G'

A is the plane-strain stiffness, L the Laplacian, D_ab = ∫ div φ_a φ_b, E_ab = ∫ φ_a·∇φ_b. K_pp and K_ww alone become
block diagonal in the eigenvectors of S v = s M v: one plane factorisation for each of them. That is the preconditioner
of conjugate gradients on the whole K (Korn's inequality bounds its condition number whatever the mesh).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg import eigh

from tests.reference.finite_elements.tooth_compliance_fem import factorised, free_dofs
from tests.reference.finite_elements.tooth_mesh import ToothMesh

Both = tuple[np.ndarray, np.ndarray]
"""In-plane (N, k, n) and axial (N, k, n) values of k load cases at the n nodes across the face."""
TOLERANCE = 1e-4
"""Of the energy norm; compliances are then good to its square."""
MOST_STEPS = 400
END_ELEMENT = 0.3
"""Length of the elements at the ends over that in the middle."""


@dataclass(frozen=True, slots=True)
class FaceLine:
    """Quadratic elements across the face: `y` (n,) nodes from 0 to b, and the matrices M, S, G (n, n)."""

    y: np.ndarray
    mass: np.ndarray
    stiffness: np.ndarray
    slope: np.ndarray

    def load(self, density: Any) -> np.ndarray:
        """Return ∫ψ_i q dy (n,) of a density q(y), three Gauss points an element."""
        out = np.zeros(self.y.size)
        for first in range(0, self.y.size - 2, 2):
            length = self.y[first + 2] - self.y[first]
            for at, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
                shapes = np.array([at * (at - 1) / 2, 1 - at * at, at * (at + 1) / 2])
                out[first : first + 3] += weight * length / 2 * shapes * density(self.y[first] + length * (at + 1) / 2)
        return out


def face_line(width: float, element: float) -> FaceLine:
    """Return the elements of a face of `width`, about `element` long in the middle (same unit)."""
    half = max(int(np.ceil(0.5 * width / element)), 4)
    steps = np.minimum(1.0, END_ELEMENT * 1.3 ** np.arange(half))
    steps = np.concatenate([steps, steps[::-1]])
    marks = width * np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    y = np.sort(np.concatenate([marks, (marks[1:] + marks[:-1]) / 2]))
    matrices = np.zeros((3, y.size, y.size))
    local = np.array([[4, 2, -1], [2, 16, 2], [-1, 2, 4]]) / 30
    local_stiffness = np.array([[7, -8, 1], [-8, 16, -8], [1, -8, 7]]) / 3
    local_slope = np.array([[-3, 4, -1], [-4, 0, 4], [1, -4, 3]]) / 6
    for i, length in enumerate(np.diff(marks)):
        at = np.ix_(range(2 * i, 2 * i + 3), range(2 * i, 2 * i + 3))
        for matrix, block in zip(matrices, (local * length, local_stiffness / length, local_slope), strict=True):
            matrix[at] += block
    return FaceLine(y, *matrices)


class ExtrudedBody:
    """One or more teeth on their ring, extruded over a face; lengths in modules, E = 1."""

    def __init__(self, mesh: ToothMesh, line: FaceLine, poisson_ratio: float = 0.3) -> None:
        from skfem import Basis, ElementTriP2, ElementVector, MeshTri
        from skfem.models.elasticity import linear_elasticity

        self.line = line
        triangles = MeshTri(mesh.points, mesh.triangles)
        self.plane = Basis(triangles, ElementVector(ElementTriP2()), intorder=4)
        self.axial = Basis(triangles, ElementTriP2(), intorder=4)
        lame, shear = poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)), 0.5 / (1 + poisson_ratio)
        self.free = free_dofs(self.plane, mesh.bore_radius)
        self.free_axial = free_dofs(self.axial, mesh.bore_radius)
        plane = linear_elasticity(lame, shear).assemble(self.plane).tocsr()
        self._assemble(plane, lame, shear)
        self._factorise()

    def _assemble(self, plane: sparse.csr_matrix, lame: float, shear: float) -> None:
        from skfem import BilinearForm
        from skfem.helpers import div, dot, grad

        p, w = self.free, self.free_axial
        self._a = plane[p][:, p]
        self._mp = shear * BilinearForm(lambda u, v, _: dot(u, v)).assemble(self.plane).tocsr()[p][:, p]
        self._l = shear * BilinearForm(lambda u, v, _: dot(grad(u), grad(v))).assemble(self.axial).tocsr()[w][:, w]
        mass = BilinearForm(lambda u, v, _: u * v).assemble(self.axial).tocsr()
        self._mw = (lame + 2 * shear) * mass[w][:, w]
        spread = BilinearForm(lambda u, v, _: div(v) * u).assemble(self.axial, self.plane).tocsr()
        slope = BilinearForm(lambda u, v, _: dot(v, grad(u))).assemble(self.axial, self.plane).tocsr()
        self._d, self._e = lame * spread[p][:, w], shear * slope[p][:, w]
        self._dt, self._et = self._d.T.tocsr(), self._e.T.tocsr()

    def _factorise(self) -> None:
        values, self._modes = eigh(self.line.stiffness, self.line.mass)
        self._factors = [
            (factorised(self._a + s * self._mp), factorised(self._l + s * self._mw)) for s in np.maximum(values, 0.0)
        ]

    def displacements(self, plane_loads: np.ndarray, face_loads: np.ndarray) -> np.ndarray:
        """Return in-plane displacements under loads that are products of plane and face vectors.

        Parameters
        ----------
        plane_loads : (N, k) array
            Load vectors on the plane's degrees of freedom.
        face_loads : (n, k) array
            Load vectors across the face.

        Returns
        -------
        (N, k, n) array

        Raises
        ------
        RuntimeError
            If the conjugate gradients do not converge.
        """
        push = plane_loads[self.free][:, :, None] * face_loads.T[None, :, :]
        out = np.zeros((self.plane.N, *push.shape[1:]))
        out[self.free] = self.solved((push, np.zeros((self.free_axial.size, *push.shape[1:]))))[0]
        return out

    def solved(self, right: Both) -> Both:
        """Return the displacements of the free degrees of freedom under loads on them, which are used up.

        Raises
        ------
        RuntimeError
            If the conjugate gradients do not converge.
        """
        x = (np.zeros_like(right[0]), np.zeros_like(right[1]))
        direction = self._precondition(right)
        before = first = _dot(right, direction)
        for _ in range(MOST_STEPS):
            answer = self._product(direction)
            step = (before / _dot(direction, answer))[None, :, None]
            for i in (0, 1):
                x[i][...] += step * direction[i]
                right[i][...] -= step * answer[i]
            rest = self._precondition(right)
            now = _dot(right, rest)
            if np.all(now < TOLERANCE**2 * first):
                return x
            ratio = (now / before)[None, :, None]
            direction = (rest[0] + ratio * direction[0], rest[1] + ratio * direction[1])
            before = now
        raise RuntimeError(f"the conjugate gradients did not converge within {MOST_STEPS} steps")

    def _product(self, x: Both) -> Both:
        p, w = x
        m, s, g = self.line.mass, self.line.stiffness, self.line.slope
        plane = times(self._a, p @ m) + times(self._mp, p @ s) + times(self._d, w @ g.T) + times(self._e, w @ g)
        axial = times(self._l, w @ m) + times(self._mw, w @ s) + times(self._dt, p @ g) + times(self._et, p @ g.T)
        return plane, axial

    def _precondition(self, right: Both) -> Both:
        plane, axial = (r @ self._modes for r in right)
        for j, factors in enumerate(self._factors):
            for part, factor in zip((plane, axial), factors, strict=True):
                part[:, :, j] = factor.solve(np.ascontiguousarray(part[:, :, j]))
        return plane @ self._modes.T, axial @ self._modes.T


def times(matrix: sparse.csr_matrix, x: np.ndarray) -> np.ndarray:
    """Return a plane matrix (a, b) times values (b, k, n)."""
    return np.asarray(matrix @ x.reshape(x.shape[0], -1)).reshape(matrix.shape[0], *x.shape[1:])


def _dot(a: Both, b: Both) -> np.ndarray:
    return np.asarray(sum(np.einsum("ikj,ikj->k", x, y) for x, y in zip(a, b, strict=True)))
