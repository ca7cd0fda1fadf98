"""A crack in a part of the face by three-dimensional finite elements: one tooth on its ring, extruded.

The plane mesh has the crack's nodes twice. Across the face a pair of them is tied where the crack has not come: loads
on both add, and both move alike. The preconditioner is that of the body which is split through the whole face, between
averages of the pairs; few more steps are needed than without ties.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from siggen.gears.spur_gear import SpurGear
from tests.reference.finite_elements.cracked_tooth import crack_tip, cracked_mesh
from tests.reference.finite_elements.extruded_body import Both, ExtrudedBody, FaceLine, face_line
from tests.reference.finite_elements.face_compliance import MODES, FaceCompliance
from tests.reference.finite_elements.tooth_compliance_fem import (
    interior_functionals,
    lines_of_action,
    nodal_functionals,
)
from tests.reference.finite_elements.tooth_mesh import ToothMesh

Depth = Callable[[np.ndarray], np.ndarray]
"""Depth share of the crack at places y/b across the face."""
SIZE, ELEMENT = 0.15, 0.4
"""Edge length on the tooth and across the face, in modules."""


class PartCrackedBody(ExtrudedBody):
    """The extruded body of a split mesh whose crack is closed and tied where `tied(points, y)` says so."""

    def __init__(self, mesh: ToothMesh, line: FaceLine, tied: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> None:
        super().__init__(mesh, line)
        self._pairs = [self._tied(basis, free, tied) for basis, free in
                       ((self.plane, self.free), (self.axial, self._free_axial))]  # fmt: skip

    def _tied(self, basis: Any, free: np.ndarray, tied: Callable[..., np.ndarray]) -> tuple[np.ndarray, ...]:
        """Return first and second of every pair of degrees of freedom (k,) and where they are tied (k, n)."""
        place = basis.doflocs[:, free].T
        kind = _components(basis)[free]
        at = np.column_stack([place, 10.0 * place.max() * kind])
        pairs = cKDTree(at).query_pairs(1e-9, output_type="ndarray")
        return pairs[:, 0], pairs[:, 1], tied(place[pairs[:, 0]], self.line.y)

    def _copied(self, x: Both) -> Both:
        for part, (first, second, tied) in zip(x, self._pairs, strict=True):
            part[second] = np.where(tied[:, None], part[first], part[second])
        return x

    def _added(self, x: Both) -> Both:
        for part, (first, second, tied) in zip(x, self._pairs, strict=True):
            part[first] += tied[:, None] * part[second]
            part[second] *= ~tied[:, None]
        return x

    def _product(self, x: Both) -> Both:
        return self._added(super()._product(self._copied((x[0].copy(), x[1].copy()))))

    def _precondition(self, right: Both) -> Both:
        halves = (right[0].copy(), right[1].copy())
        for part, (first, second, tied) in zip(halves, self._pairs, strict=True):
            part[first] *= 1.0 - 0.5 * tied[:, None]
            part[second] = np.where(tied[:, None], part[first], part[second])
        answer = super()._precondition(halves)
        for part, (first, second, tied) in zip(answer, self._pairs, strict=True):
            mean = 0.5 * (part[first] + part[second])
            part[first] = np.where(tied[:, None], mean, part[first])
            part[second] *= ~tied[:, None]
        return answer

    def displacements(self, plane_loads: np.ndarray, face_loads: np.ndarray) -> np.ndarray:
        """Return what the extruded body returns; both nodes of a tied pair have its displacement."""
        out = super().displacements(plane_loads, face_loads)
        first, second, tied = self._pairs[0]
        a, b = self.free[first], self.free[second]
        out[b] = np.where(tied[:, None], out[a], out[b])
        return out


def _components(basis: Any) -> np.ndarray:
    """Return which component (N,) a degree of freedom is."""
    kind = np.zeros(basis.N, dtype=np.int64)
    for dofs in (basis.dofs.nodal_dofs, basis.dofs.facet_dofs):
        for row in range(len(dofs)):
            kind[dofs[row]] = row
    return kind


def part_crack(
    gear: SpurGear,
    roll: np.ndarray,
    width: float,
    deepest: float,
    angle_rad: float,
    depth: Depth | None,
    size: float = SIZE,
    element: float = ELEMENT,
    modes: int = MODES,
) -> FaceCompliance:
    """Return the compliance across the face of one tooth with a crack; without `depth` of the sound tooth.

    Parameters
    ----------
    gear : SpurGear
    roll : (k,) array
        Roll angles of the loaded lines [rad].
    width : float
        Face width in modules.
    deepest : float
        Largest depth over the chord of the root; that of the mesh.
    angle_rad : float
        Between the crack and the tooth's centre line.
    depth : callable or None
        Depth over the chord at places y/b, at most `deepest`.
    """
    crossing, way = lines_of_action(gear, np.atleast_2d(roll))
    _, mesh = cracked_mesh(gear, roll, deepest, angle_rad, size)
    start, tip = crack_tip(gear, deepest, angle_rad)
    line = face_line(width, element)

    def tied(points: np.ndarray, y: np.ndarray) -> np.ndarray:
        along = np.hypot(*(points - start).T) / np.hypot(*(tip - start)) * deepest
        return along[:, None] >= (np.zeros_like(y) if depth is None else depth(y / width)) - 1e-9

    body = PartCrackedBody(mesh, line, tied)
    push = nodal_functionals(body.plane, mesh.load_points.reshape(-1, 2), way.reshape(-1, 2)).toarray().T
    read = interior_functionals(body.plane, crossing.reshape(-1, 2), way.reshape(-1, 2))
    loads = np.column_stack([line.load(lambda y, n=n: np.cos(n * np.pi * y / width) / width) for n in range(modes)])
    places = push.shape[1]
    answer = body.displacements(np.repeat(push, modes, axis=1), np.tile(loads, places))
    deflection = np.asarray(read @ answer.reshape(answer.shape[0], -1)).reshape(places, places, modes, -1)
    own = deflection[np.arange(places), np.arange(places)]
    return FaceCompliance(width * np.einsum("yi,kjy->kij", loads, own), width)
