r"""Three-dimensional elasticity of a helical tooth on its ring: the extruded body, twisted about the gear's axis.

Derived. Along the face the section turns by τ = tan β/r per length. In coordinates and components that turn with it the
body is an extrusion again, and a derivative along the axis becomes D = ∂_s + T with

    T u = τ (J u - (J x)·∇ u) of in-plane components,   T w = -τ (J x)·∇ w of the axial one,   J (x, y) = (-y, x).

Energy λ/2 (div u + D w)² + μ ε:ε: with C = ∫φ_a·Tφ_b, Q = ∫Tφ_a·Tφ_b and M, S, G of the face as in `extruded_body`,
every S of K_pp and K_ww becomes S, C ⊗ G', C' ⊗ G and Q ⊗ M, every G of K_pw brings T once beside M. The body without
twist stays the preconditioner.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from tests.reference.finite_elements.extruded_body import Both, ExtrudedBody, FaceLine, times
from tests.reference.finite_elements.tooth_mesh import ToothMesh


class HelicalBody(ExtrudedBody):
    """A helical tooth on its ring; `twist` is τ in 1/module, lengths in modules, E = 1."""

    def __init__(self, mesh: ToothMesh, line: FaceLine, twist: float) -> None:
        self._twist = twist
        super().__init__(mesh, line)

    def _assemble(self, plane: sparse.csr_matrix, lame: float, shear: float) -> None:
        from skfem import BilinearForm
        from skfem.helpers import div, dot, grad

        super()._assemble(plane, lame, shear)
        p, w = self.free, self.free_axial

        def vector(u: Any, x: Any) -> Any:
            along = np.stack([-u[1], u[0]])
            return self._twist * (along + x[1] * u.grad[:, 0] - x[0] * u.grad[:, 1])

        def scalar(u: Any, x: Any) -> Any:
            return self._twist * (x[1] * u.grad[0] - x[0] * u.grad[1])

        def made(form: Any, *bases: Any) -> sparse.csr_matrix:
            return BilinearForm(form).assemble(*bases).tocsr()

        # skfem hands over the columns' function first, then the rows' one.
        both, along = self.plane, self.axial
        self._cp = shear * made(lambda u, v, at: dot(v, vector(u, at.x)), both)[p][:, p]
        self._qp = shear * made(lambda u, v, at: dot(vector(v, at.x), vector(u, at.x)), both)[p][:, p]
        self._cw = (lame + 2 * shear) * made(lambda u, v, at: v * scalar(u, at.x), along)[w][:, w]
        self._qw = (lame + 2 * shear) * made(lambda u, v, at: scalar(v, at.x) * scalar(u, at.x), along)[w][:, w]
        turned = lame * made(lambda u, v, at: div(v) * scalar(u, at.x), along, both)
        turned = turned + shear * made(lambda u, v, at: dot(vector(v, at.x), grad(u)), along, both)
        self._t = turned[p][:, w]

    def _product(self, x: Both) -> Both:
        plane, axial = super()._product(x)
        (p, w), m, g = x, self.line.mass, self.line.slope
        plane = plane + times(self._cp, p @ g) + times(self._cp.T, p @ g.T) + times(self._qp, p @ m)
        axial = axial + times(self._cw, w @ g) + times(self._cw.T, w @ g.T) + times(self._qw, w @ m)
        return plane + times(self._t, w @ m), axial + times(self._t.T, p @ m)
