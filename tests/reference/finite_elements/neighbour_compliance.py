"""Compliances of several loaded teeth of one gear by finite elements, own and cross ones."""

from __future__ import annotations

import numpy as np

from siggen.gears.gear_pair import SpurGear
from tests.reference.finite_elements.tooth_compliance_fem import (
    PlaneElasticity,
    displacements,
    interior_functionals,
    lines_of_action,
    nodal_functionals,
)
from tests.reference.finite_elements.tooth_mesh import tooth_mesh


def coupled_compliance(gear: SpurGear, load_roll: np.ndarray, size: float) -> np.ndarray:
    """Compliances between load positions on several teeth, times E L, plane stress, Poisson's ratio 0.3.

    The displacement of another tooth is read at its contact itself, where nothing is singular without its own load:
    that makes the cross compliances symmetric. The own one is read at the tooth's centre line, without the contact.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    load_roll : (t, k) array
        Roll angles [rad] of the load points of each tooth; tooth i is turned clockwise by i pitches.
    size : float
        Edge length on the teeth, in modules.

    Returns
    -------
    (t, k, t, k) array
        Entry (i, a, j, b): displacement of tooth i at its place a by a unit force at place b of tooth j.
    """
    mesh = tooth_mesh(gear, load_roll, size)
    crossing, way = lines_of_action(gear, load_roll)
    basis, displacement = displacements(mesh, way, PlaneElasticity())
    count, places = load_roll.shape
    shape = (count, places, count, places)
    ways = way.reshape(-1, 2)
    out = np.asarray(nodal_functionals(basis, mesh.load_points.reshape(-1, 2), ways) @ displacement).reshape(shape)
    own = np.asarray(interior_functionals(basis, crossing.reshape(-1, 2), ways) @ displacement).reshape(shape)
    for i in range(count):
        out[i, :, i] = own[i, :, i]
    return out
