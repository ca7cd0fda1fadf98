"""Outlines of a pit that only grows: two edges across the face, each at fixed stations, that never come back.

Derived. Half the length along the profile at a place across the face is that of an ellipse whose both axes grow with
one size. So the lower edge only falls and the upper one only rises at every station, and a larger outline holds every
smaller one; waves are factors of a station, and change nothing of that. The length along the profile goes towards the
part of the flank below the pitch line, after which a spall spreads across the face.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.irregular import drawn_waves
from siggen.life.flank import Flank

FIRST_STATION, STATION_RATIO = 0.01, 1.3
"""Distance of the first station from the middle over the face width, and of each next one over the one before."""
WAVE_RMS = 0.1
"""Of an edge, over its distance from the middle; assumed, as for irregular spalls."""
WAVE_SHARE = 0.1
"""Distance across the face, over its width, in which waves forget; assumed."""
ASPECT = (0.8, 1.6)
"""Length across the face over that along the profile of a young pit; assumed."""
EDGE_RADIUS_M = (2e-5, 2e-4)
"""Radius of the edges [m]; assumed, as for irregular spalls."""
DEPTH_SHARE = 0.05
"""Depth over the root of profile length x face length; assumed."""
NEAR = 1e-9
"""Stations nearer than this share of the face are one."""
UNION_PLACES = 257
"""Across the face at which the union of outlines is measured."""


class Edges(NamedTuple):
    """Places across the face, arcs of the lower and of the upper edge, each (k,) [m]."""

    face_m: FloatArray
    low_m: FloatArray
    high_m: FloatArray


@dataclass(frozen=True, slots=True)
class PitShape:
    """What a pit keeps while it grows.

    Attributes
    ----------
    arc_m, middle_m : float
        Where it began: arc, and place across the face [m].
    below_m, above_m : float
        How far it may reach along the profile [m].
    aspect : float
        See `ASPECT`.
    edge_radius_m : float
    stations_m : (n,)
        Across the face, ascending; both ends of the face are the outermost [m].
    low, high : (n,)
        Waves of either edge as factors of its distance from the middle.
    """

    arc_m: float
    middle_m: float
    below_m: float
    above_m: float
    aspect: float
    edge_radius_m: float
    stations_m: FloatArray
    low: FloatArray
    high: FloatArray

    @property
    def largest_m(self) -> float:
        """A size at which it has gone through the face, and as far along the profile as it may [m]."""
        most, width = self.below_m + self.above_m, float(self.stations_m[-1])
        return max(6.0 * most, 3.0 * float(np.sqrt(width * most / self.aspect)))

    def lengths_m(self, size_m: float) -> tuple[float, float]:
        """Return the lengths along the profile and across the face, off the face too, at a size [m]."""
        most = self.below_m + self.above_m
        along = -most * float(np.expm1(-size_m / most))
        return along, self.aspect * size_m * size_m / along

    def depth_m(self, size_m: float) -> float:
        """Return the depth at a size [m]; across the face no more counts than there is."""
        along, across = self.lengths_m(size_m)
        return DEPTH_SHARE * float(np.sqrt(along * min(across, float(self.stations_m[-1]))))

    def edges(self, size_m: float) -> Edges:
        """Return the edges at a size."""
        along, across = self.lengths_m(size_m)
        half, width = 0.5 * across, float(self.stations_m[-1])
        left, right = self.middle_m - half, self.middle_m + half
        inside = (self.stations_m > left + NEAR * width) & (self.stations_m < right - NEAR * width)
        face = self.stations_m[inside]
        share = along / (self.below_m + self.above_m) * np.sqrt(1.0 - ((face - self.middle_m) / half) ** 2)
        low = self.arc_m - self.below_m * np.minimum(share * self.low[inside], 1.0)
        high = self.arc_m + self.above_m * np.minimum(share * self.high[inside], 1.0)
        # an end that lies on that of the face within NEAR takes its place
        first = [max(left, 0.0)] if left >= -NEAR * width else []
        last = [min(right, width)] if right <= width + NEAR * width else []
        ends = [self.arc_m] * len(first), [self.arc_m] * len(last)
        return Edges(
            np.concatenate([first, face, last]),
            np.concatenate([ends[0], low, ends[1]]),
            np.concatenate([ends[0], high, ends[1]]),
        )


def drawn_shape(flank: Flank, exponent: float, named: Callable[[str], np.random.Generator]) -> PitShape:
    """Return where a pit begins and how it will spread; `named` gives generators by what they draw."""
    place, aspect, radius, across = named("place").random(4).tolist()
    width, arc = flank.face_m, flank.start_m(exponent, place)
    middle = width * across
    offsets = width * FIRST_STATION * STATION_RATIO ** np.arange(18)
    stations = np.concatenate([[0.0, middle, width], middle - offsets, middle + offsets])
    stations = np.unique(stations[(stations >= 0.0) & (stations <= width)])
    waves = [drawn_waves(named(edge))(stations, WAVE_SHARE * width) for edge in ("low", "high")]
    # Neither edge may begin at the middle itself: what is left of the reach beyond it would not grow.
    reach = flank.pitch_arc_m - flank.active_arc_m
    below = min(max(arc - flank.active_arc_m, 0.1 * reach), arc)
    above = max(flank.pitch_arc_m - arc, 0.1 * reach)
    return PitShape(
        arc,
        middle,
        below,
        above,
        ASPECT[0] * (ASPECT[1] / ASPECT[0]) ** aspect,
        EDGE_RADIUS_M[0] * (EDGE_RADIUS_M[1] / EDGE_RADIUS_M[0]) ** radius,
        stations,
        1.0 + WAVE_RMS * waves[0],
        1.0 + WAVE_RMS * waves[1],
    )


def area_m2(edges: Edges) -> float:
    """Return the area inside one outline [m²]."""
    return float(np.trapezoid(edges.high_m - edges.low_m, edges.face_m))


def union_m2(outlines: Sequence[Edges], width_m: float) -> float:
    """Return the area inside any of several outlines on a face [m²]."""
    if len(outlines) == 1:
        return area_m2(outlines[0])
    face = np.unique(np.concatenate([np.linspace(0.0, width_m, UNION_PLACES), *(one.face_m for one in outlines)]))
    return float(np.trapezoid(covered_m(outlines, face), face))


def covered_m(outlines: Sequence[Edges], face_m: FloatArray) -> FloatArray:
    """Return how much of the profile outlines take together at places across the face (k,) [m]."""
    low = np.array([np.interp(face_m, one.face_m, one.low_m, np.inf, np.inf) for one in outlines])
    high = np.array([np.interp(face_m, one.face_m, one.high_m, -np.inf, -np.inf) for one in outlines])
    order = np.argsort(low, axis=0)
    low, high = np.take_along_axis(low, order, axis=0), np.take_along_axis(high, order, axis=0)
    taken = np.zeros(face_m.size)
    reached = np.full(face_m.size, -np.inf)
    for one, two in zip(low, high, strict=True):
        taken += np.maximum(np.where(two > reached, two - np.maximum(one, reached), 0.0), 0.0)
        reached = np.maximum(reached, two)
    return taken


def through(outlines: Sequence[Edges], middles_m: Sequence[float], width_m: float) -> bool:
    """Return whether at some height no land is left across the face; a pit by itself gets there at its middle first."""
    face = np.linspace(0.0, width_m, UNION_PLACES)
    low = np.array([np.interp(face, one.face_m, one.low_m, np.inf, np.inf) for one in outlines])
    high = np.array([np.interp(face, one.face_m, one.high_m, -np.inf, -np.inf) for one in outlines])
    heights = np.concatenate([middles_m, np.linspace(low.min(), high.max(), 33)])[:, np.newaxis, np.newaxis]
    return bool(np.any(np.all(np.any((low <= heights) & (heights <= high), axis=1), axis=1)))


def sizes_m(shapes: Sequence[PitShape], areas_m2: Sequence[float], width_m: float) -> list[float]:
    """Return the sizes at which the pits of a tooth, the oldest first, take these areas together [m].

    Each pit takes as much as the union of those before it lacks of the sum, so areas count once where outlines overlap.
    Sizes only grow where areas do: what an older pit takes of a younger one, the younger one takes elsewhere.
    """
    found: list[float] = []
    outlines: list[Edges] = []
    wanted = 0.0
    for shape, area in zip(shapes, areas_m2, strict=True):
        wanted += area
        size = _size_m(shape, outlines, wanted, width_m)
        found.append(size)
        outlines.append(shape.edges(size))
    return found


def _size_m(shape: PitShape, outlines: list[Edges], wanted_m2: float, width_m: float) -> float:
    from scipy.optimize import brentq

    def missing(size_m: float) -> float:
        return union_m2([*outlines, shape.edges(size_m)], width_m) - wanted_m2

    least, most = 1e-6, shape.largest_m
    if missing(most) <= 0.0:
        return most
    if missing(least) >= 0.0:
        return least
    return float(brentq(missing, least, most, xtol=1e-12, rtol=1e-12))
