"""What does not fit into a gearbox with further meshes: gears on a short shaft, and shafts that stand in one another.

Gears of one shaft stand at a third and two thirds between its bearings, so all three gaps hold what stands in them from
1.5 times both faces on. Shafts without a common mesh have no common plane of gears either, so one may end before the
other begins. They stand beside each other, or in one line: coaxial (reverted) gearboxes, whose centre distances are
equal and which fold by 180 degrees. Two axes a little apart are refused: neither do the shafts pass each other, nor
does one bore of the wall between them hold the bearings of both. Gears round an idler lie in one plane, so the tips of
those that do not mesh pass each other. All of it is derived.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, pairwise

import numpy as np

from siggen.arrays import FloatArray
from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import Number, bounds
from siggen.names import Side
from siggen.specimen.staged_structure import LEAST_SPAN

ON_ONE_AXIS_MM = 0.02
"""Axes as near as this are one: boxes are bored no closer (half of IT7 of 50 to 80 mm, ISO 286-1)."""
BETWEEN = 5
"""Values of a range at which axes are looked at, its bounds included."""


def stage_layout_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what does not fit, at the bounds of all numbers; nothing where pairs are refused for themselves."""
    stages, meshes = gearbox.config.stages, [mesh.pairs for mesh in gearbox.meshes]
    if not stages or gearbox.config.planetary is not None or any(mesh.problems for mesh in gearbox.meshes):
        return
    for index, (stage, pairs) in enumerate(zip(stages, pairwise(meshes), strict=True)):
        yield from _span(stage.span_mm, index, sum(max(pair.face_width_m for pair in own) for own in pairs))
    yield from _axes(gearbox, meshes)


def _span(span_mm: Number | str | None, index: int, faces_m: float) -> Iterator[Problem]:
    least_mm = 1e3 * LEAST_SPAN * faces_m
    if not isinstance(span_mm, str | None) and bounds(span_mm)[0] < least_mm:
        received = f"{bounds(span_mm)[0]:g} mm for faces of {1e3 * faces_m:g} mm together"
        allowed = (
            f"allowed: at least {least_mm:g} mm, {LEAST_SPAN:g} times both face_width_mm, since the gears "
            "stand at a third and at two thirds between the bearings; or null"
        )
        yield Problem(f"stages.{index}.span_mm", received, allowed)


def _axes(gearbox: PossibleGearbox, meshes: Sequence[Sequence[GearPair]]) -> Iterator[Problem]:
    """Yield the first shaft that stands in one in front of it, by the stage whose direction sets it."""
    stages, names = gearbox.config.stages, gearbox.config.names.shafts
    turned = [np.zeros(1), *(np.radians(_values(*bounds(stage.direction_deg))) for stage in stages)]
    distances = [_values(*_ends(pair.working_centre_distance_m for pair in pairs)) for pairs in meshes]
    tips = [[max(pair.member(role).tip_radius_m for pair in pairs) for role in Side] for pairs in meshes]
    driving, driven = ([max(pair.member(role).bore_radius_m for pair in pairs) for pairs in meshes] for role in Side)
    shafts = [driving[0], *map(min, driven, driving[1:]), driven[-1]]
    for first, last in combinations(range(len(shafts)), 2):
        if last < first + 2:
            continue
        apart_mm = 1e3 * _apart_m(distances[first:last], turned[first:last])
        in_plane = all(stage.idler for stage in stages[first : last - 1])
        together_mm = 1e3 * (tips[first][0] + tips[last - 1][1] if in_plane else shafts[first] + shafts[last])
        if (apart_mm.max() <= ON_ONE_AXIS_MM and not in_plane) or apart_mm.min() >= together_mm:
            continue
        received = (
            f"{stages[last - 2].direction_deg}, with which the axis of {names[last].word}_shaft stands "
            f"{apart_mm.min():.4g} mm from that of {names[first].word}_shaft"
        )
        allowed = f"allowed: a direction with at least {together_mm:.4g} mm, " + (
            "the tip radii of both gears, which lie in one plane with the idler"
            if in_plane
            else "the radii of both shafts (bore_radius_mm), or 0: 180 degrees and equal centre distances (coaxial)"
        )
        yield Problem(f"stages.{last - 2}.direction_deg", received, allowed)
        return


def _apart_m(distances: Sequence[FloatArray], turned: Sequence[FloatArray]) -> FloatArray:
    """Return how far two axes may be apart [m]: sums of centre distances along their directions."""
    place = np.zeros(1, dtype=np.complex128)
    for distance, direction in zip(distances, turned, strict=True):
        step = distance[:, None] * np.exp(1j * direction[None, :])
        place = (place[:, None] + step.reshape(1, -1)).ravel()
    return np.abs(place)


def _ends(values: Iterable[float]) -> tuple[float, float]:
    found = sorted(values)
    return found[0], found[-1]


def _values(low: float, high: float) -> FloatArray:
    return np.unique(np.linspace(low, high, BETWEEN))
