"""Triangle mesh of one or more hobbed teeth on their ring body, in units of the module.

The outline is exact at its nodes: involute, envelope of the rack-tip round (trochoid, Ma 2014), root circle, bore.
Every load point is a node. The other teeth are left out: their gaps are root circle.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from siggen.gears.gear_pair import SpurGear

# Edge lengths away from the tooth follow the edge length on it, so that halving `size` refines the whole mesh.
COARSEST_EDGE_PER_RADIUS = 2.5
GROWTH_PER_SIZE = 6.0
BORE_LAYERS_SIZE = 0.15
DEFAULT_SIZE = 0.04


@dataclass(frozen=True, slots=True)
class ToothMesh:
    """Straight-sided triangles; lengths in modules, gear centre at the origin, tooth 0 along +y.

    Attributes
    ----------
    points : (2, n) array
        Node coordinates.
    triangles : (3, e) int array
        Nodes of each triangle, counter-clockwise.
    bore_radius : float
        Radius of the clamped nodes of the bore.
    load_points : (t, k, 2) array
        Flank points of the t teeth that can be loaded; nodes of the mesh.
    """

    points: np.ndarray
    triangles: np.ndarray
    bore_radius: float
    load_points: np.ndarray = field(repr=False)


def fillet(gear: SpurGear, count: int) -> np.ndarray:
    """Right fillet from the root circle to the start of the involute, rack-cut.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    count : int
        Number of points, equally spaced along the fillet.

    Returns
    -------
    (count, 2) array
        Half thickness and height from the gear centre, in modules.
    """
    gamma = np.linspace(np.pi / 2, gear.involute_start_gamma_rad, 1001)
    curve = np.array([gear.trochoid_point_m(angle)[::-1] for angle in gamma]) / gear.module_m
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(curve, axis=0).T))])
    even = np.interp(np.linspace(0, arc[-1], count), arc, gamma)
    return np.array([gear.trochoid_point_m(angle)[::-1] for angle in even]) / gear.module_m


def flank(gear: SpurGear, roll: np.ndarray) -> np.ndarray:
    """Points of the right flank: half thickness and height from the gear centre, in modules.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : (k,) array
        Roll angles [rad].

    Returns
    -------
    (k, 2) array
    """
    return np.column_stack([gear.half_thickness_m(roll), gear.height_m(roll) + gear.base_height_m]) / gear.module_m


def _arc(radius: float, start: float, end: float, count: int) -> np.ndarray:
    angle = np.linspace(start, end, count)
    return radius * np.column_stack([np.sin(angle), np.cos(angle)])


def _half_tooth(gear: SpurGear, size: float, load_roll: np.ndarray) -> np.ndarray:
    """Right side of the tooth from the middle of the tip land to the foot of the fillet; loads are among the nodes."""
    start, tip = gear.involute_start_roll_rad, gear.tip_roll_rad
    length = gear.base_radius_m / gear.module_m * (tip**2 - start**2) / 2
    even = np.sqrt(np.linspace(tip**2, start**2, int(np.ceil(length / size)) + 1))
    inside = load_roll[(load_roll > start) & (load_roll < tip)]
    step = np.abs(even[:, None] - inside[None, :]).min(axis=1, initial=np.inf) * even * gear.base_radius_m
    keep = step > 0.4 * size * gear.module_m
    keep[[0, -1]] = True
    roll = np.sort(np.concatenate([even[keep], inside]))[::-1]
    side = flank(gear, roll)
    radius = np.hypot(*side[0])
    half_land = np.arctan2(*side[0])
    land = _arc(radius, 0.0, half_land, int(np.ceil(radius * half_land / size)) + 1)[:-1]
    root_length = np.hypot(*np.diff(fillet(gear, 100), axis=0).T).sum()
    return np.vstack([land, side, fillet(gear, int(np.ceil(root_length / size)) + 1)[::-1][1:]])


def _root_arc(radius: float, start: float, end: float, size: float) -> np.ndarray:
    """Inner nodes of the root circle between two teeth, growing away from both."""
    steps = [0.0]
    half = radius * (end - start) / 2
    largest, growth = COARSEST_EDGE_PER_RADIUS * size * radius, 1 + GROWTH_PER_SIZE * size
    while steps[-1] < half:
        steps.append(steps[-1] + min(size * growth ** len(steps), largest))
    one = np.array(steps) / steps[-1] * half / radius
    angle = np.concatenate([start + one[1:], end - one[-2:0:-1]])
    return radius * np.column_stack([np.sin(angle), np.cos(angle)])


def outline(gear: SpurGear, size: float, load_roll: np.ndarray) -> np.ndarray:
    """Return the closed outer boundary of the ring with its teeth.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    size : float
        Edge length on the teeth, in modules.
    load_roll : (t, k) array
        Roll angles of the load points of each tooth; tooth i is turned clockwise by i pitches.

    Returns
    -------
    (n, 2) array
        Nodes, clockwise from the middle of tooth 0's tip land.
    """
    pitch = 2 * np.pi / gear.teeth
    teeth = [_tooth(gear, size, roll, i * pitch) for i, roll in enumerate(load_roll)]
    radius = gear.root_radius_m / gear.module_m
    foot = np.arctan2(*fillet(gear, 2)[0])
    parts = []
    for i, tooth in enumerate(teeth):
        last = i == len(teeth) - 1
        end = 2 * np.pi - foot if last else (i + 1) * pitch - foot
        parts += [tooth, _root_arc(radius, i * pitch + foot, end, size)]
    return np.vstack(parts)


def _tooth(gear: SpurGear, size: float, load_roll: np.ndarray, turn: float) -> np.ndarray:
    right = _half_tooth(gear, size, load_roll)
    left = _half_tooth(gear, size, np.empty(0))[::-1] * [-1.0, 1.0]
    whole = np.vstack([left, right[1:]])
    return turned(whole, turn)


def turned(points: np.ndarray, turn: float) -> np.ndarray:
    """Points (..., 2) turned clockwise about the gear centre by `turn` [rad]."""
    c, s = np.cos(turn), np.sin(turn)
    return points @ np.array([[c, -s], [s, c]])


def tooth_mesh(gear: SpurGear, load_roll: np.ndarray, size: float = DEFAULT_SIZE) -> ToothMesh:
    """Mesh of the ring with as many teeth as `load_roll` has rows.

    Parameters
    ----------
    gear : SpurGear
        The gear; its number of teeth need not be whole, since one tooth stands on the ring.
    load_roll : (t, k) array
        Roll angles [rad] of the load points on the right flank of each tooth.
    size : float
        Edge length on tooth and fillet in modules; it grows towards bore and far side.

    Returns
    -------
    ToothMesh
    """
    bore = bore_polygon(gear, size)
    points, triangles = meshed((outline(gear, size, load_roll), bore))
    loads = np.stack([turned(flank(gear, r), i * 2 * np.pi / gear.teeth) for i, r in enumerate(load_roll)])
    return ToothMesh(points, triangles, float(np.hypot(*bore[0])), loads)


def meshed(loops: tuple[np.ndarray, ...], inside: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Mesh of a plane body.

    Parameters
    ----------
    loops : tuple of (n, 2) arrays
        Nodes of the closed boundaries, the outer one first.
    inside : (k, 2) array, optional
        Nodes of a line that edges follow; the first one is a node of the outer boundary.

    Returns
    -------
    ((2, n) array, (3, e) int array)
        Points, and nodes of each triangle.
    """
    import gmsh

    gmsh.initialize(["-noenv"], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.option.setNumber("Mesh.Algorithm", 5)
        _body(loops, inside)
        gmsh.model.mesh.generate(2)
        return _read()
    finally:
        gmsh.finalize()


def bore_polygon(gear: SpurGear, size: float) -> np.ndarray:
    """Polygon whose mean radius is the bore's: an inscribed one would hold the body on a smaller circle."""
    thickness = (gear.root_radius_m - gear.bore_radius_m) / gear.module_m
    radius = gear.bore_radius_m / gear.module_m
    step = min(thickness * size / BORE_LAYERS_SIZE, COARSEST_EDGE_PER_RADIUS * size * radius)
    edges = int(np.ceil(2 * np.pi * radius / step))
    return _arc(radius * (1 + (2 * np.pi / edges) ** 2 / 12), 0.0, 2 * np.pi, edges + 1)[:-1]


def _body(boundaries: tuple[np.ndarray, ...], inside: np.ndarray | None) -> None:
    import gmsh

    loops, first = [], []
    for nodes in boundaries:
        edge = np.hypot(*(np.roll(nodes, -1, axis=0) - nodes).T)
        tags = _points(nodes, np.maximum(edge, np.roll(edge, 1)))
        loops.append(gmsh.model.geo.addCurveLoop(_lines([*tags, tags[0]])))
        first = first or tags
    surface = gmsh.model.geo.addPlaneSurface(loops)
    drawn: list[int] = []
    if inside is not None:
        mouth = first[int(np.hypot(*(boundaries[0] - inside[0]).T).argmin())]
        edge = np.hypot(*np.diff(inside, axis=0).T)
        drawn = _lines([mouth, *_points(inside[1:], edge)])
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.embed(1, drawn, 2, surface)


def _points(nodes: np.ndarray, size: np.ndarray) -> list[int]:
    import gmsh

    return [gmsh.model.geo.addPoint(x, y, 0.0, h) for (x, y), h in zip(nodes, size, strict=True)]


def _lines(tags: list[int]) -> list[int]:
    import gmsh

    lines = [gmsh.model.geo.addLine(a, b) for a, b in pairwise(tags)]
    for line in lines:
        gmsh.model.geo.mesh.setTransfiniteCurve(line, 2)
    return lines


def _read() -> tuple[np.ndarray, np.ndarray]:
    import gmsh

    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    index[tags.astype(np.int64)] = np.arange(len(tags))
    _, _, nodes = gmsh.model.mesh.getElements(2)
    triangles = index[nodes[0].astype(np.int64)].reshape(-1, 3).T
    points = coordinates.reshape(-1, 3)[:, :2].T
    used = np.unique(triangles)
    renumber = np.zeros(points.shape[1], dtype=np.int64)
    renumber[used] = np.arange(len(used))
    return np.ascontiguousarray(points[:, used]), np.ascontiguousarray(renumber[triangles])
