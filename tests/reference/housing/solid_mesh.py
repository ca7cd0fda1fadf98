"""Hexahedra of a housing's walls: an even grid, round bores and bosses by rings of elements, ribs outside."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from siggen.drivetrain.box import Axis, Box, Rib, Seat

ROOM = 1.25
"""Half the square that a seat's rings fill, over the boss's radius."""
LEAST_CELL = 0.15
"""Smallest cell over the element's size."""
SNAP_M = 0.004
"""A frame that ends so near to a plate ends at it."""


class SolidMesh(NamedTuple):
    """Nodes (n, 3) [m] and hexahedra (elements, 8)."""

    nodes: np.ndarray
    elements: np.ndarray


class Frame(NamedTuple):
    """The rectangle of a wall that a seat's rings fill: from and to along x and y [m]."""

    x: tuple[float, float]
    y: tuple[float, float]


def solid_mesh(box: Box, element_m: float) -> SolidMesh:
    """Return the walls of a box as hexahedra of about this size, one through the thickness; strips are left out."""
    around = frames(box)
    lines = _lines(box, element_m, around)
    blocks = [_walls(box, lines, around)]
    for name, seat in box.seats.items():
        blocks += _seat(box, seat, _perimeter(around[name], lines), element_m)
    blocks += [_rib(box, rib, lines) for rib in box.ribs]
    return _merged(np.concatenate(blocks))


def frames(box: Box) -> dict[str, Frame]:
    """Return the rectangle of every seat: beside each other, with common sides, not beyond the walls' inner edges.

    Raises
    ------
    ValueError
        If bosses meet or the shafts lie at different heights.
    """
    seats = sorted(box.seats.items(), key=lambda item: item[1].x_m)
    if len({seat.y_m for _, seat in seats}) > 1:
        raise ValueError("seats: received different heights; allowed is one")
    largest, level = max(seat.boss_radius_m for _, seat in seats), seats[0][1].y_m
    y = _snapped(box, Axis.Y, level - ROOM * largest), _snapped(box, Axis.Y, level + ROOM * largest)
    first, last = seats[0][1], seats[-1][1]
    ends = [_snapped(box, Axis.X, first.x_m - ROOM * first.boss_radius_m)]
    for (_, a), (_, b) in pairwise(seats):
        share = a.boss_radius_m / (a.boss_radius_m + b.boss_radius_m)
        ends.append(a.x_m + share * (b.x_m - a.x_m))
        if a.boss_radius_m + b.boss_radius_m >= b.x_m - a.x_m:
            raise ValueError("seats: received bosses that meet; allowed are bosses apart")
    ends.append(_snapped(box, Axis.X, last.x_m + ROOM * last.boss_radius_m))
    return {name: Frame((ends[n], ends[n + 1]), y) for n, (name, _) in enumerate(seats)}


def _snapped(box: Box, axis: Axis, place_m: float) -> float:
    """Return a place, or the inner surface of a plate that is beyond or near it."""
    low, high = (0.5 * thick for thick in _ends(box)[axis])
    least = SNAP_M
    if place_m < low + least:
        return low
    return box.size_m[axis] - high if place_m > box.size_m[axis] - high - least else place_m


def _ends(box: Box) -> tuple[tuple[float, float], ...]:
    wall = box.thickness
    return (wall.ends_m, wall.ends_m), (wall.floor_m, wall.lid_m), (wall.walls_m, wall.walls_m)


def _lines(box: Box, element_m: float, around: dict[str, Frame]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the coordinates of grid lines along x, y, z [m]; the first and last cells are the walls."""
    kept: list[list[float]] = [[], [], []]
    for frame in around.values():
        kept[0] += frame.x
        kept[1] += frame.y
    for rib in box.ribs:
        kept[0] += [rib.x_m - 0.5 * rib.width_m, rib.x_m + 0.5 * rib.width_m]
    for bolt in box.bolts:
        kept[0] += [bolt.x_m - 0.5 * bolt.patch_m, bolt.x_m + 0.5 * bolt.patch_m]
        for z in (bolt.z_m, box.size_m[2] - bolt.z_m):
            kept[2] += [z - 0.5 * bolt.patch_m, z + 0.5 * bolt.patch_m]
    x, y, z = (_line(box.size_m[axis], _ends(box)[axis], kept[axis], element_m) for axis in Axis)
    return x, y, z


def _line(length_m: float, ends_m: tuple[float, float], kept: list[float], element_m: float) -> np.ndarray:
    """Return places from one outer surface to the other. Of two that nearly meet the one named first is kept."""
    low, high = 0.5 * ends_m[0], length_m - 0.5 * ends_m[1]
    breaks = [low, high]
    for place in kept:
        if low < place < high and np.abs(np.array(breaks) - place).min() > LEAST_CELL * element_m:
            breaks.append(place)
    found = [-low]
    for start, stop in pairwise(sorted(breaks)):
        found += list(np.linspace(start, stop, max(1, round((stop - start) / element_m)) + 1)[:-1])
    return np.array([*found, high, length_m + 0.5 * ends_m[1]])


def _walls(box: Box, lines: tuple[np.ndarray, ...], around: dict[str, Frame]) -> np.ndarray:
    """Return corners (elements, 8, 3) of all grid cells in a wall but outside the seats' frames."""
    counts = [line.size - 1 for line in lines]
    i, j, k = (index.ravel() for index in np.meshgrid(*map(np.arange, counts), indexing="ij"))
    outer = [(index == 0) | (index == count - 1) for index, count in zip((i, j, k), counts, strict=True)]
    keep = outer[0] | outer[1] | outer[2]
    x, y = (0.5 * (line[:-1] + line[1:]) for line in lines[:2])
    for name in box.seats:
        frame = around[name]
        inside = (x[i] > frame.x[0]) & (x[i] < frame.x[1]) & (y[j] > frame.y[0]) & (y[j] < frame.y[1])
        keep &= ~(inside & outer[2])
    return _cells(lines, i[keep], j[keep], k[keep])


def _cells(lines: tuple[np.ndarray, ...], i: np.ndarray, j: np.ndarray, k: np.ndarray) -> np.ndarray:
    steps = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    corners = [np.stack([lines[0][i + a], lines[1][j + b], lines[2][k + c]], axis=-1) for a, b, c in steps]
    return np.stack(corners, axis=1)


def _perimeter(frame: Frame, lines: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return the grid points (n, 2) on a seat's frame, counterclockwise and without repetition."""
    x, y = (
        line[(line > low - 1e-9) & (line < high + 1e-9)] for line, (low, high) in zip(lines[:2], frame, strict=True)
    )
    bottom = np.stack([x[:-1], np.full(x.size - 1, y[0])], axis=1)
    right = np.stack([np.full(y.size - 1, x[-1]), y[:-1]], axis=1)
    top = np.stack([x[:0:-1], np.full(x.size - 1, y[-1])], axis=1)
    left = np.stack([np.full(y.size - 1, x[0]), y[:0:-1]], axis=1)
    return np.concatenate([bottom, right, top, left])


def _seat(box: Box, seat: Seat, square: np.ndarray, element_m: float) -> list[np.ndarray]:
    """Return the rings of a seat in both walls, those of the boss with their layers in front of and behind the wall."""
    centre = np.array([seat.x_m, seat.y_m])
    away = square - centre
    unit = away / np.linalg.norm(away, axis=1)[:, None]
    # Corners of the same area as the circle.
    angle = np.unwrap(np.arctan2(unit[:, 1], unit[:, 0]))
    steps = np.diff(np.append(angle, angle[0] + 2.0 * np.pi))
    round_off = np.sqrt(2.0 * np.pi / np.sin(steps).sum())
    boss, bore = (centre + round_off * radius * unit for radius in (seat.boss_radius_m, seat.bore_radius_m))
    outer = _rings(square, boss, max(1, round(0.2 * seat.boss_radius_m / element_m)))
    inner = _rings(boss, bore, max(1, round((seat.boss_radius_m - seat.bore_radius_m) / element_m)))
    wall, thick = 0.5 * box.thickness.walls_m, 0.5 * seat.boss_thickness_m
    blocks = []
    for middle in (0.0, box.size_m[2]):
        blocks += [_extruded(ring, middle - wall, middle + wall) for ring in (*outer, *inner)]
        blocks += [_extruded(ring, middle - thick, middle - wall) for ring in inner]
        blocks += [_extruded(ring, middle + wall, middle + thick) for ring in inner]
    return blocks


def _rings(outer: np.ndarray, inner: np.ndarray, count: int) -> list[np.ndarray]:
    """Return quadrilaterals (n, 4, 2) of so many rings between two closed curves."""
    curves = [outer + (inner - outer) * share for share in np.linspace(0.0, 1.0, count + 1)]
    rolled = [np.roll(curve, -1, axis=0) for curve in curves]
    return [np.stack([curves[n], rolled[n], rolled[n + 1], curves[n + 1]], axis=1) for n in range(count)]


def _extruded(quadrilaterals: np.ndarray, low: float, high: float) -> np.ndarray:
    layers = [np.concatenate([quadrilaterals, np.full((*quadrilaterals.shape[:2], 1), z)], axis=2) for z in (low, high)]
    return np.concatenate(layers, axis=1)


def _rib(box: Box, rib: Rib, lines: tuple[np.ndarray, ...]) -> np.ndarray:
    """Return a rib outside on both walls."""
    wall, width = 0.5 * box.thickness.walls_m, box.size_m[2]
    x, y = (0.5 * (line[:-1] + line[1:]) for line in lines[:2])
    i = np.flatnonzero(np.abs(x - rib.x_m) < 0.5 * rib.width_m + 1e-9)
    j = np.flatnonzero((y > rib.y_m[0]) & (y < rib.y_m[1]))
    i, j = (index.ravel() for index in np.meshgrid(i, j, indexing="ij"))
    levels = [-wall - rib.height_m, -wall - 0.5 * rib.height_m, -wall]
    blocks = []
    for z in (np.array(levels), width - np.array(levels)[::-1]):
        blocks += [_cells((lines[0], lines[1], z), i, j, np.full(i.size, k)) for k in (0, 1)]
    return np.concatenate(blocks)


def _merged(corners: np.ndarray) -> SolidMesh:
    """Return nodes and elements of hexahedra by their corners (elements, 8, 3); equal places are one node."""
    flat = corners.reshape(-1, 3)
    _, first, inverse = np.unique(
        np.round(flat / 1e-6).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    return SolidMesh(flat[first], inverse.reshape(-1, 8))
