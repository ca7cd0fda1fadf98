"""A tooth with a crack in its root by plane finite elements: nodes doubled along it, open; lengths in modules.

The crack's line is edges of one mesh. Compliances with and without it come from this same mesh, so that what the mesh
errs by cancels; edges shrink towards the tip, where stresses grow without bound.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from siggen.gears.spur_gear import root_chord
from tests.reference.finite_elements.tooth_compliance_fem import (
    PlaneElasticity,
    displacements,
    interior_functionals,
    lines_of_action,
)
from tests.reference.finite_elements.tooth_mesh import ToothMesh, bore_polygon, flank, meshed, outline

if TYPE_CHECKING:
    from siggen.gears.gear_pair import SpurGear

TIP_SHARE = 0.1
"""Shortest edge, at the tip, over that of the tooth; at most a thirtieth of the crack."""
GROWTH = 1.35
CRACK_SIZE = 0.05


def crack_line(start: np.ndarray, tip: np.ndarray, size: float) -> np.ndarray:
    """Return nodes (k, 2) from start to tip whose distances shrink towards the tip."""
    length = float(np.hypot(*(tip - start)))
    steps = [min(TIP_SHARE * size, length / 30)]
    while sum(steps) < length:
        steps.append(min(GROWTH * steps[-1], size))
    along = np.concatenate([[0.0], np.cumsum(steps)]) / sum(steps)
    return tip + along[::-1, None] * (start - tip)


def split(points: np.ndarray, triangles: np.ndarray, line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of a mesh with the nodes of a straight line doubled, but for the last one.

    Raises
    ------
    ValueError
        If a point of the line is no node.
    """
    distance, node = cKDTree(points.T).query(line)
    if distance.max() > 1e-9:
        raise ValueError(f"the crack must follow edges; {distance.max():.2e} modules away")
    open_nodes = node[:-1]
    double = np.arange(points.shape[1])
    double[open_nodes] = points.shape[1] + np.arange(open_nodes.size)
    way, middle = line[-1] - line[0], points[:, triangles].mean(axis=1)
    beyond = way[0] * (middle[1] - line[0, 1]) - way[1] * (middle[0] - line[0, 0]) > 0.0
    apart = triangles.copy()
    apart[:, beyond] = double[triangles[:, beyond]]
    return np.hstack([points, points[:, open_nodes]]), apart


def crack_tip(gear: SpurGear, share: float, angle_rad: float) -> tuple[np.ndarray, np.ndarray]:
    """Return start and tip (2,) of a crack on the right side of the tooth, in modules."""
    chord = root_chord(gear)
    start = np.array([0.5 * chord.length_m, chord.height_m]) / gear.module_m
    way = np.array([np.sin(angle_rad), np.cos(angle_rad)])
    return start, start - share * chord.length_m / gear.module_m * way


def cracked_mesh(
    gear: SpurGear, roll: np.ndarray, share: float, angle_rad: float, size: float
) -> tuple[ToothMesh, ...]:
    """Return the mesh of one tooth on its ring, whole and with the crack."""
    outer, bore = outline(gear, size, np.atleast_2d(roll)), bore_polygon(gear, size)
    start, tip = crack_tip(gear, share, angle_rad)
    # The fillet's node next to the start moves there, along the fillet.
    outer[np.hypot(*(outer - start).T).argmin()] = start
    line = crack_line(start, tip, size)
    points, triangles = meshed((outer, bore), line)
    whole = ToothMesh(points, triangles, float(np.hypot(*bore[0])), flank(gear, roll)[None])
    apart = split(points, triangles, line)
    return whole, replace(whole, points=apart[0], triangles=apart[1])


def crack_compliance(
    gear: SpurGear,
    roll: np.ndarray,
    share: float,
    angle_rad: float,
    elasticity: PlaneElasticity | None = None,
    size: float = CRACK_SIZE,
) -> tuple[np.ndarray, np.ndarray]:
    """Compliance of the sound tooth and what a crack adds, times E L.

    Parameters
    ----------
    gear : SpurGear
    roll : (k,) array
        Roll angles of the loaded flank points [rad].
    share : float
        Depth of the crack over the chord of the root.
    angle_rad : float
        Between the crack and the tooth's centre line.
    elasticity : PlaneElasticity, optional
        Plane stress with Poisson's ratio 0.3 if left out.
    size : float
        Edge length on the tooth in modules.

    Returns
    -------
    ((k,) array, (k,) array)
    """
    crossing, way = lines_of_action(gear, np.atleast_2d(roll))
    found = []
    for mesh in cracked_mesh(gear, roll, share, angle_rad, size):
        basis, displacement = displacements(mesh, way, elasticity or PlaneElasticity())
        reading = interior_functionals(basis, crossing.reshape(-1, 2), way.reshape(-1, 2))
        found.append(np.diag(np.asarray(reading @ displacement)).copy())
    return found[0], found[1] - found[0]
