"""An irregular spall: two skewed, wavy edges across the face, a rough or dished floor, rounded edges.

Derived. At every place w across the face the spall takes one stretch of the flank, from its lower to its upper edge.
Both are straight between stations, so the spall is a chain of strips that each have a depth of their own. A wavy edge
is a normal process with the covariance exp(-(d/L)²) over the distance d, as a sum of cosines, cut off at two standard
deviations and scaled to a mean square of 1: so edges never come nearer than the waviness allows.

A spall that has grown takes in the milder one: at each station the lower of both lower edges and the higher of both
upper ones. The milder one's stations are stations of the grown one, so it lies inside everywhere, not only there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.damage.heights import clipped_arcs_m
from siggen.gears.damage.on_flank import OnFlank, floor_problems
from siggen.gears.damage.outlines import Polygon
from siggen.gears.damage.part import Part, Refusal
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.names import Side

STRIPS = 64
"""Strips of a whole face; their ends stay where they are while a spall grows."""
COSINES = 32
"""Of a wavy edge: enough for a process that looks normal."""
CUT = 2.0
WAVE_LIMIT = CUT / 0.959_39
"""Largest value of a wave of mean square 1: the cut over the root mean square of what a cut at 2 leaves."""
NEAR = 1e-6
"""Stations nearer than this share of the face are one."""

Station = tuple[float, float, float]
"""Face coordinate, height of the lower and of the upper edge [m]."""


@dataclass(frozen=True, slots=True)
class Waves:
    """A wavy edge of mean square 1 over places across the face, drawn once; `turns` (n,) and `phases` (n,)."""

    turns: FloatArray
    phases: FloatArray

    def __call__(self, face_m: FloatArray, length_m: float) -> FloatArray:
        """Return the wave at places (k,) [m] for a correlation length [m]; at most `WAVE_LIMIT` either way."""
        angles = np.multiply.outer(face_m / length_m, self.turns) + self.phases
        found = np.sqrt(2.0 / self.turns.size) * np.cos(angles).sum(axis=-1)
        return np.asarray(np.clip(found, -CUT, CUT) * (WAVE_LIMIT / CUT))


def drawn_waves(rng: np.random.Generator) -> Waves:
    """Return a wavy edge; wave numbers are normal with the standard deviation √2/L."""
    return Waves(np.sqrt(2.0) * rng.standard_normal(COSINES), 2.0 * np.pi * rng.random(COSINES))


@dataclass(frozen=True, slots=True)
class IrregularSpall(OnFlank):
    """One irregular spall.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    stations_m : tuple of (face, lower height, upper height)
        Ascending across the face, at least two [m].
    strip_depths_m : tuple of float
        Depth between neighbouring stations, one less than stations [m].
    edge_radius_m : float
        Of its edges [m].
    floor : str
        'flat' or 'dish': half an elliptic cylinder over the height range of the whole outline.
    milder : IrregularSpall or None
        The one that it has grown from and holds. Near its rim a longer dish is shallower than a shorter one; there the
        deeper one counts.
    """

    gear: Side
    tooth: int
    stations_m: tuple[Station, ...]
    strip_depths_m: tuple[float, ...]
    edge_radius_m: float
    floor: str = "flat"
    # The stations tell spalls apart as a rule: a hash of the whole chain would cost more than what it looks up.
    milder: IrregularSpall | None = field(default=None, hash=False)

    @property
    def kind(self) -> str:
        """Kind of damage: a spall as any other."""
        return "spall"

    @property
    def depth_m(self) -> float:
        """Largest depth [m]."""
        return max(self.strip_depths_m)

    @property
    def outline(self) -> Polygon:
        """The lower edge across the face and the upper one back."""
        lower = [(low, face) for face, low, _ in self.stations_m]
        upper = [(high, face) for face, _, high in reversed(self.stations_m)]
        return Polygon(tuple(dict.fromkeys((*lower, *upper))))

    def rows(self) -> list[tuple[float, ...]]:
        """Return the rows of all strips, with those of the milder spall where a dish could be shallower than it."""
        held = self.milder.rows() if self.floor == "dish" and self.milder is not None else []
        return [*_strip_rows(self), *held]

    def profile_arc_m(self, gear: SpurGear) -> float:
        """Return the longest arc between both edges at one place across the face, clipped to the flank [m]."""
        return float(np.max(clipped_arcs_m(gear, *np.array(self.stations_m)[:, 1:].T)))

    def hides(self, other: Part) -> bool:
        """Return whether `other` is one that it has grown from, or lies inside one of its strips and nowhere deeper."""
        milder = self.milder
        while milder is not None:
            if milder == other:
                return True
            milder = milder.milder
        return OnFlank.hides(self, other)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield stations that do not ascend, edges that cross, and floor, depth or edge radius that are none.

        Between stations that ascend and edges that do not cross the outline cannot meet itself.
        """
        face, low, high = np.array(self.stations_m).T
        if not (np.isfinite(face).all() and np.all(np.diff(face) > 0.0) and face.size > 1):
            yield Refusal(
                "stations_m", f"stations at {(1e3 * face).tolist()} mm", "at least two, ascending across the face"
            )
        elif not np.all(low <= high):
            i = int(np.argmin(low <= high))
            received = f"a lower edge at {mm(low[i])} and an upper one at {mm(high[i])}, {mm(face[i])} across the"
            yield Refusal("stations_m", f"{received} face", "edges that do not cross")
        if len(self.strip_depths_m) != face.size - 1:
            received = f"{len(self.strip_depths_m)} depths of strips between {face.size} stations"
            yield Refusal("strip_depths_m", received, "one between neighbouring stations")
        if not (np.isfinite(self.edge_radius_m) and self.edge_radius_m >= 0.0):
            yield Refusal("edge_radius_m", f"edge radius {mm(self.edge_radius_m)}", "finite and at least 0")
        yield from floor_problems(self)

    def table_row(self) -> dict[str, object]:
        """Return place, size, outline and floor in mm, with the radius of the edges and the depth of every strip."""
        depths = [1e3 * depth for depth in self.strip_depths_m]
        return {**OnFlank.table_row(self), "edge_radius_mm": 1e3 * self.edge_radius_m, "strip_depth_mm": depths}


def _strip_rows(spall: IrregularSpall) -> tuple[tuple[float, ...], ...]:
    dish, span = spall.floor == "dish", spall.outline.height_range_m
    found: list[tuple[float, ...]] = []
    for (one, two), depth in zip(pairwise(spall.stations_m), spall.strip_depths_m, strict=True):
        corners = ((one[1], one[0]), (two[1], two[0]), (two[2], two[0]), (one[2], one[0]))
        strip = Polygon(tuple(dict.fromkeys(corners)))
        found += strip.rows(depth, dish, spall.edge_radius_m, span)
    return tuple(found)


def stations_across(
    face_width_m: float, left_m: float, right_m: float, milder: IrregularSpall | None = None
) -> FloatArray:
    """Return where the stations of a spall lie across the face (k,) [m]: the ends of strips, its own, the milder's."""
    if milder is not None:
        left_m, right_m = min(left_m, milder.stations_m[0][0]), max(right_m, milder.stations_m[-1][0])
    fixed = [left_m, right_m] + ([] if milder is None else [face for face, _, _ in milder.stations_m])
    ends = face_width_m * np.arange(STRIPS + 1) / STRIPS
    near = np.abs(np.subtract.outer(ends, fixed)).min(axis=1) < NEAR * face_width_m
    inside = (ends > left_m) & (ends < right_m) & ~near
    return np.unique(np.concatenate([ends[inside], fixed]))


def grown_spall(
    gear: Side,
    tooth: int,
    face_m: FloatArray,
    edges_m: tuple[FloatArray, FloatArray],
    strip_depths_m: FloatArray,
    edge_radius_m: float,
    floor: str,
    milder: IrregularSpall | None = None,
) -> IrregularSpall:
    """Return a spall with its own edges and depths, or the milder one's where those go beyond.

    Parameters
    ----------
    gear, tooth, edge_radius_m, floor, milder
        As in `IrregularSpall`.
    face_m : (k,)
        `stations_across` [m].
    edges_m : (k,), (k,)
        Heights x of the lower and the upper edge at the stations [m].
    strip_depths_m : (k - 1,)
        [m].
    """
    low, high = (np.array(edge) for edge in edges_m)
    depths = np.array(strip_depths_m)
    if milder is not None:
        face, lower, upper = np.array(milder.stations_m).T
        inside = (face_m >= face[0]) & (face_m <= face[-1])
        low[inside] = np.minimum(low, np.interp(face_m, face, lower))[inside]
        high[inside] = np.maximum(high, np.interp(face_m, face, upper))[inside]
        middle = 0.5 * (face_m[1:] + face_m[:-1])
        strip = np.clip(np.searchsorted(face, middle) - 1, 0, face.size - 2)
        older = np.where((middle > face[0]) & (middle < face[-1]), np.array(milder.strip_depths_m)[strip], 0.0)
        depths = np.maximum(depths, older)
    keep = _bends(low, high, depths)
    stations = tuple(zip(face_m[keep].tolist(), low[keep].tolist(), high[keep].tolist(), strict=True))
    return IrregularSpall(gear, tooth, stations, tuple(depths[keep[:-1]].tolist()), edge_radius_m, floor, milder)


def _bends(low: FloatArray, high: FloatArray, depths: FloatArray) -> np.ndarray:
    """Return the stations that matter (k,): not those at which both edges go on level and the depth stays."""
    keep = np.ones(low.size, np.bool_)
    for edge in (low, high):
        keep[1:-1] &= (edge[1:-1] == edge[:-2]) & (edge[1:-1] == edge[2:])
    keep[1:-1] = ~(keep[1:-1] & (depths[1:] == depths[:-1]))
    return keep
