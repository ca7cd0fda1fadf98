"""What does not fit into a gearbox with further meshes: gears on a short shaft, and shafts that stand in one another.

Gears of one shaft stand at a third and two thirds between its bearings, so all three gaps hold what stands in them from
1.5 times both faces on. Shafts without a common mesh have no common plane of gears either, so one may end before the
other begins. They stand beside each other, or in one line: coaxial (reverted) gearboxes, whose centre distances are
equal and which fold by 180 degrees. Two axes a little apart are refused: neither do the shafts pass each other, nor
does one bore of the wall between them hold the bearings of both. Gears round an idler lie in one plane, so the tips of
those that do not mesh pass each other. All of it is derived.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations, pairwise
from typing import Any, NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.checks.mesh_sections import stage_sections
from siggen.config import Gears, Stage
from siggen.config.gears import Pair
from siggen.config.short_form import names_in
from siggen.errors import Problem
from siggen.gearbox.pair import gear_pair
from siggen.gears.geometry.gear_pair import geometry_problems
from siggen.keys.drawing import corners
from siggen.keys.number import Number, bounds
from siggen.names import Names
from siggen.specimen.staged_structure import LEAST_SPAN

ON_ONE_AXIS_MM = 0.02
"""Axes as near as this are one: boxes are bored no closer (half of IT7 of 50 to 80 mm, ISO 286-1)."""
BETWEEN = 5
"""Values of a range at which axes are looked at, its bounds included."""


def stage_layout_problems(sections: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield what does not fit, at the bounds of all numbers; nothing where pairs are refused for themselves."""
    gears: Gears | None = sections.get("gears")
    stages: tuple[Stage, ...] = sections.get("stages", ())
    if gears is None or gears.pairs or not stages:
        return
    every: list[Pair] = [gears, *(own["gears"] for _, own in stage_sections(sections))]
    for index, (stage, (before, own)) in enumerate(zip(stages, pairwise(every), strict=True)):
        yield from _span(stage, index, _widest_mm(before) + _widest_mm(own))
    distances = [_centre_distances_mm(pair) for pair in every]
    if all(one.size for one in distances):
        names = names_in(sections["machine"], planetary=False)
        yield from _axes(names, every, stages, distances)


def _span(stage: Stage, index: int, faces_mm: float) -> Iterator[Problem]:
    if not isinstance(stage.span_mm, str | None) and bounds(stage.span_mm)[0] < LEAST_SPAN * faces_mm:
        received = f"{bounds(stage.span_mm)[0]:g} mm for faces of {faces_mm:g} mm together"
        allowed = (
            f"allowed: at least {LEAST_SPAN * faces_mm:g} mm, {LEAST_SPAN:g} times both face_width_mm, since the gears "
            "stand at a third and at two thirds between the bearings; or null"
        )
        yield Problem(f"stages.{index}.span_mm", received, allowed)


class _Shaft(NamedTuple):
    """A shaft: what it is called, and the largest radius of what is in its gears' bores [mm]."""

    name: str
    radius_mm: float


def _axes(names: Names, every: list[Pair], stages: tuple[Stage, ...], distances: list[FloatArray]) -> Iterator[Problem]:
    """Yield the first shaft that stands in one in front of it, by the stage whose direction sets it."""
    shafts, tips = _shafts(names, every), _tips_mm(every)
    turned = [np.zeros(1), *(np.radians(_values(stage.direction_deg)) for stage in stages)]
    for first, last in combinations(range(len(shafts)), 2):
        if last < first + 2:
            continue
        apart = _apart_mm(distances[first:last], turned[first:last])
        in_plane = all(stage.idler for stage in stages[first : last - 1])
        ends_mm = (tips[first][0], tips[last - 1][1]) if in_plane else (shafts[first][1], shafts[last][1])
        together_mm = sum(ends_mm)
        if (apart.max() <= ON_ONE_AXIS_MM and not in_plane) or apart.min() >= together_mm:
            continue
        received = (
            f"{stages[last - 2].direction_deg}, with which the axis of {shafts[last].name} stands {apart.min():.4g} mm "
            f"from that of {shafts[first].name}"
        )
        allowed = f"allowed: a direction with at least {together_mm:.4g} mm, " + (
            "the tip radii of both gears, which lie in one plane with the idler"
            if in_plane
            else "the radii of both shafts (bore_radius_mm), or 0: 180 degrees and equal centre distances (coaxial)"
        )
        yield Problem(f"stages.{last - 2}.direction_deg", received, allowed)
        return


def _shafts(names: Names, every: list[Pair]) -> list[_Shaft]:
    called = [f"{shaft.word}_shaft" for shaft in names.shafts]
    driven = [_bore_mm(pair, "gear") for pair in every]
    driving = [_bore_mm(pair, "pinion") for pair in every]
    common = [min(pair) for pair in zip(driven, driving[1:], strict=False)]
    return [_Shaft(*one) for one in zip(called, (driving[0], *common, driven[-1]), strict=True)]


def _tips_mm(every: list[Pair]) -> list[tuple[float, float]]:
    """Return the largest tip radii of the driving and the driven gear of every mesh [mm]."""
    found = []
    for pair in every:
        built = [gear_pair(corner) for corner in corners(pair)]
        driving, driven = ([one.member(which).tip_radius_m for one in built] for which in ("pinion", "gear"))
        found.append((1e3 * max(driving), 1e3 * max(driven)))
    return found


def _apart_mm(distances: list[FloatArray], turned: list[FloatArray]) -> FloatArray:
    """Return how far two axes may be apart [mm]: sums of centre distances along their directions."""
    place = np.zeros(1, dtype=np.complex128)
    for distance, direction in zip(distances, turned, strict=True):
        step = distance[:, None] * np.exp(1j * direction[None, :])
        place = (place[:, None] + step.reshape(1, -1)).ravel()
    return np.abs(place)


def _values(number: Number) -> FloatArray:
    return np.unique(np.linspace(*bounds(number), BETWEEN))


def _centre_distances_mm(pair: Pair) -> FloatArray:
    """Return the centre distances of the corners of a section; none where teeth do not mesh."""
    pairs = [gear_pair(corner) for corner in corners(pair)]
    if any(geometry_problems(one) for one in pairs):
        return np.empty(0)
    found = [1e3 * one.working_centre_distance_m for one in pairs]
    return np.unique(np.linspace(min(found), max(found), BETWEEN))


def _widest_mm(pair: Pair) -> float:
    return bounds(pair.face_width_mm)[1]


def _bore_mm(pair: Pair, which: str) -> float:
    return bounds(getattr(pair, which).bore_radius_mm)[1]
