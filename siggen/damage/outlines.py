"""Outlines of damage on a flank, in the plane of height and face: ellipses, rectangles, Vs and any simple polygon.

Derived. Every outline becomes primitives that cover one interval of the face at each height: an ellipse is one, a
polygon is cut at the heights of its vertices into trapezoids with straight sides. Their union is exact because no
outline is approximated by another.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import isfinite
from typing import TypeAlias

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.row_columns import UNSTATED
from siggen.errors import counted, mm


@dataclass(frozen=True, slots=True)
class Ellipse:
    """Ellipse with centre (height, face) and semi-axes across the face and along the height [m]."""

    height_m: float
    face_m: float
    semi_axis_face_m: float
    semi_axis_profile_m: float

    @property
    def shape(self) -> str:
        """Name of the outline."""
        return "ellipse"

    @property
    def height_range_m(self) -> tuple[float, float]:
        """Lowest and highest point [m]."""
        return self.height_m - self.semi_axis_profile_m, self.height_m + self.semi_axis_profile_m

    @property
    def face_range_m(self) -> tuple[float, float]:
        """First and last point across the face [m]."""
        return self.face_m - self.semi_axis_face_m, self.face_m + self.semi_axis_face_m

    @property
    def semi_axes_m(self) -> tuple[float, float]:
        """Semi-axes across the face and along the height [m]."""
        return self.semi_axis_face_m, self.semi_axis_profile_m

    @property
    def corners_m(self) -> tuple[tuple[float, float], ...]:
        """No corners."""
        return ()

    def drawn_m(self, points: int = 181) -> FloatArray:
        """Return a polygon on the outline (points, 2), height and face [m]; the first corner is not repeated."""
        turn = 2.0 * np.pi * np.arange(points) / points
        face = self.face_m + self.semi_axis_face_m * np.cos(turn)
        height = self.height_m + self.semi_axis_profile_m * np.sin(turn)
        return np.stack([height, face], axis=1)

    def problems(self) -> Iterator[tuple[str, str, str]]:
        """Yield (name, received, allowed) of everything that makes this no ellipse."""
        for name in ("height_m", "face_m"):
            if not isfinite(getattr(self, name)):
                yield name, f"{name} {getattr(self, name)!r}", "finite"
        for name in ("semi_axis_face_m", "semi_axis_profile_m"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0.0):
                yield name, f"{name.removesuffix('_m')} {mm(value)}", "finite and above 0"

    def rows(self, depth_m: float, dish: bool) -> list[tuple[float, ...]]:
        """Return the one row of an ellipse; columns: `siggen.damage.row_columns`."""
        low, high = self.height_range_m
        box = (self.height_m, self.face_m, self.semi_axis_face_m, self.semi_axis_profile_m)
        return [(*box, depth_m, float(dish), 0.0, low, high, 0.0, 0.0, 0.0, 0.0, UNSTATED)]


@dataclass(frozen=True, slots=True)
class Polygon:
    """Simple polygon, convex or not.

    Parameters
    ----------
    vertices_m : tuple of (height, face)
        Corners in order, either way round; the last is joined to the first [m].
    shape : str
        Name of the outline: 'rectangle' or 'polygon'; geometry follows from the vertices alone.
    """

    vertices_m: tuple[tuple[float, float], ...]
    shape: str = "polygon"

    @property
    def height_m(self) -> float:
        """Middle of the height range [m]."""
        return 0.5 * sum(self.height_range_m)

    @property
    def face_m(self) -> float:
        """Middle of the range across the face [m]."""
        return 0.5 * sum(self.face_range_m)

    @property
    def height_range_m(self) -> tuple[float, float]:
        """Lowest and highest point [m]."""
        heights = [height for height, _ in self.vertices_m]
        return min(heights), max(heights)

    @property
    def face_range_m(self) -> tuple[float, float]:
        """First and last point across the face [m]."""
        faces = [face for _, face in self.vertices_m]
        return min(faces), max(faces)

    @property
    def semi_axes_m(self) -> tuple[float, float]:
        """Half the ranges across the face and along the height [m]."""
        (low, high), (left, right) = self.height_range_m, self.face_range_m
        return 0.5 * (right - left), 0.5 * (high - low)

    @property
    def corners_m(self) -> tuple[tuple[float, float], ...]:
        """The corners as (height, face), in order [m]."""
        return self.vertices_m

    def drawn_m(self, points: int = 181) -> FloatArray:  # noqa: ARG002 - as an ellipse is asked
        """Return the corners (n, 2), height and face, however many points are asked for [m]."""
        return np.array(self.vertices_m)

    def problems(self) -> Iterator[tuple[str, str, str]]:
        """Yield (name, received, allowed) of what makes this no simple polygon."""
        if len(self.vertices_m) < 3:
            yield "vertices_m", counted(len(self.vertices_m), "vertex", "vertices"), "at least 3"
        elif not np.all(np.isfinite(self.vertices_m)):
            bad = next(i for i, corner in enumerate(self.vertices_m) if not np.all(np.isfinite(corner)))
            yield "vertices_m", f"vertex {bad} {self.vertices_m[bad]!r}", "finite coordinates"
        else:
            crossing = _meeting_edges(np.array(self.vertices_m, dtype=np.float64))
            if crossing is not None:
                received = f"a polygon whose edges {crossing[0]} and {crossing[1]} meet (edge i starts at vertex i)"
                yield "vertices_m", received, "a simple polygon: edges of some length that meet at their ends only"

    def rows(
        self,
        depth_m: float,
        dish: bool,
        edge_radius_m: float = UNSTATED,
        height_range_m: tuple[float, float] | None = None,
    ) -> list[tuple[float, ...]]:
        """Return one row per trapezoid. A dish refers to the height range of the whole polygon unless one is given."""
        low, high = self.height_range_m if height_range_m is None else height_range_m
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        return [(*_trapezoid_row(t, middle, half, depth_m, dish), edge_radius_m) for t in trapezoids(self)]


Outline: TypeAlias = Ellipse | Polygon


def rectangle(height_range_m: tuple[float, float], face_range_m: tuple[float, float]) -> Polygon:
    """Return the rectangle between two heights and two places across the face."""
    (low, high), (left, right) = height_range_m, face_range_m
    return Polygon(((low, left), (low, right), (high, right), (high, left)), "rectangle")


def _trapezoid_row(sides: tuple[float, ...], middle: float, half: float, depth: float, dish: bool) -> tuple[float, ...]:
    low, high, left_low, right_low, left_high, right_high = sides
    left, right = min(left_low, left_high), max(right_low, right_high)
    box = (middle, 0.5 * (left + right), 0.5 * (right - left), half)
    return (*box, depth, float(dish), 1.0, low, high, left_low, right_low, left_high, right_high)


def trapezoids(polygon: Polygon) -> tuple[tuple[float, ...], ...]:
    """Return a polygon without problems as trapezoids (low, high, left and right at low, left and right at high)."""
    corners = [(float(height), float(face)) for height, face in polygon.vertices_m]
    edges = [(a, b) if b[0] > a[0] else (b, a) for a, b in pairwise((*corners, corners[0]))]
    levels, out = sorted({height for height, _ in corners}), []
    for low, high in pairwise(levels):
        crossing = (edge for edge in edges if edge[0][0] <= low and edge[1][0] >= high)
        sides = sorted(((_face_at(*edge, low), _face_at(*edge, high)) for edge in crossing), key=sum)
        for left, right in zip(sides[::2], sides[1::2], strict=True):
            out.append((low, high, left[0], right[0], left[1], right[1]))
    return tuple(out)


def _face_at(start: tuple[float, float], stop: tuple[float, float], level: float) -> float:
    """Return where an edge from one corner to a higher one passes a height [m]; its ends exactly."""
    share = (level - start[0]) / (stop[0] - start[0])
    return stop[1] if share == 1.0 else start[1] + share * (stop[1] - start[1])


def _meeting_edges(corners: FloatArray) -> tuple[int, int] | None:
    """Return two edges that meet where they must not, or an edge without length twice; None for a simple polygon."""
    count = len(corners)
    after = np.roll(corners, -1, axis=0)
    edge = after - corners
    for i in range(count):
        follower = (i + 1) % count
        if not np.any(edge[i]):
            return i, i
        turn = edge[i, 0] * edge[follower, 1] - edge[i, 1] * edge[follower, 0]
        if turn == 0.0 and float(edge[i] @ edge[follower]) < 0.0:
            return i, follower
        for j in range(i + 2, count - (i == 0)):
            if _meet(corners[i], after[i], corners[j], after[j]):
                return i, j
    return None


def _meet(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> bool:
    """Whether the closed segments ab and cd share a point."""
    if np.any(np.maximum(a, b) < np.minimum(c, d)) or np.any(np.maximum(c, d) < np.minimum(a, b)):
        return False
    return _side(a, b, c) * _side(a, b, d) <= 0.0 and _side(c, d, a) * _side(c, d, b) <= 0.0


def _side(a: FloatArray, b: FloatArray, p: FloatArray) -> float:
    return float(np.sign((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])))
