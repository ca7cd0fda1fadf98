"""Compliance of one tooth across the face: what a load at y' does at y, by the extruded body, in cosines of the face.

Load along the contact line on the flank, displacement along the line of action where that line crosses the tooth's
centre line, at every y. That is the reading of the plane elements (`tooth_compliance_fem`), and the datum of the
contact across the face (`siggen.mesh.line_kernel`, `reference.contact.face_contact`): what lies between the
surface and this depth belongs to the contact, in three dimensions as in the plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.gears.gear_pair import SpurGear
from tests.reference.finite_elements.extruded_body import ExtrudedBody, face_line
from tests.reference.finite_elements.tooth_compliance_fem import (
    interior_functionals,
    lines_of_action,
    nodal_functionals,
)
from tests.reference.finite_elements.tooth_mesh import tooth_mesh

MODES = 10
SIZE, ELEMENT = 0.15, 0.5
"""Edge length on the tooth and of the middle elements across the face, in modules; 0.2 % from the finest mesh tried."""


@dataclass(frozen=True, slots=True)
class FaceCompliance:
    """Compliance across the face at k load heights, times E b.

    `modes` (k, n, n): entry (i, j) is the mean over the face of cos(i π y/b) u(y) under the load cos(j π y/b)/b. It is
    symmetric but for what the reading at the centre line leaves (below 1 % of the uniform one).
    `width`: face width in modules.
    """

    modes: np.ndarray
    width: float

    @property
    def uniform(self) -> np.ndarray:
        """Mean deflection under a uniform load (k,): the plane compliance, between plane stress and plane strain."""
        return self.modes[:, 0, 0]

    def under(self, load: np.ndarray) -> np.ndarray:
        """Return the load-weighted mean deflection (k,) under a load given by its cosine moments (n,) (see below)."""
        return np.einsum("i,kij,j->k", load, self.modes, load)

    def matrix(self, y: np.ndarray) -> np.ndarray:
        """Return (k, m, m) the symmetric part between places y/b (m,), times E b, per total load."""
        shapes = np.cos(np.pi * np.arange(self.modes.shape[1])[:, None] * y) * norms(self.modes.shape[1])[:, None]
        full = np.einsum("im,kij,jl->kml", shapes, self.modes, shapes)
        return 0.5 * (full + full.transpose(0, 2, 1))


def norms(count: int) -> np.ndarray:
    """Return 1 / mean of cos² (n,): 1, 2, 2, ..."""
    return np.where(np.arange(count) == 0, 1.0, 2.0)


def load_on(first: float, last: float, count: int = MODES) -> np.ndarray:
    """Return the coefficients (n,) in cos(n π y/b)/b of a unit load, uniform from `first` to `last` (shares of b)."""
    n = np.pi * np.arange(1, count)
    mean = (np.sin(n * last) - np.sin(n * first)) / (n * (last - first))
    return np.concatenate([[1.0], 2.0 * mean])


def tilt_load(count: int = MODES) -> np.ndarray:
    """Return the coefficients (n,) of the load (2 y/b - 1)/b."""
    n = np.arange(1, count)
    return np.concatenate([[0.0], np.where(n % 2, -8.0 / (np.pi * n) ** 2, 0.0)])


def face_compliance(
    gear: SpurGear, roll: np.ndarray, width: float, size: float = SIZE, element: float = ELEMENT, modes: int = MODES
) -> FaceCompliance:
    """Return the compliance across the face of one tooth on its ring.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : (k,) array
        Roll angles of the loaded lines [rad].
    width : float
        Face width in modules.
    size, element : float
        Edge length on the tooth and across the face, in modules.
    modes : int
        Cosines across the face.
    """
    rolls = np.atleast_2d(roll)
    crossing, way = lines_of_action(gear, rolls)
    mesh = tooth_mesh(gear, rolls, size)
    body = ExtrudedBody(mesh, face_line(width, element))
    push = nodal_functionals(body.plane, mesh.load_points.reshape(-1, 2), way.reshape(-1, 2)).toarray().T
    read = interior_functionals(body.plane, crossing.reshape(-1, 2), way.reshape(-1, 2))
    loads = np.column_stack(
        [body.line.load(lambda y, n=n: np.cos(n * np.pi * y / width) / width) for n in range(modes)]
    )
    places = push.shape[1]
    answer = body.displacements(np.repeat(push, modes, axis=1), np.tile(loads, places))
    deflection = np.asarray(read @ answer.reshape(answer.shape[0], -1)).reshape(places, places, modes, -1)
    own = deflection[np.arange(places), np.arange(places)]
    return FaceCompliance(width * np.einsum("yi,kjy->kij", loads, own), width)
