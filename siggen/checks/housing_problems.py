"""What is impossible in a `housing` of plates: gears or bearings that do not fit in, walls too thick for a plate.

Everything is checked at the bounds of all numbers, with the largest bearings that a gearbox may draw.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from siggen.config import Dynamics, PlateHousing, Shafts
from siggen.dynamics.housing.layout import Contents
from siggen.errors import Problem
from siggen.gearbox.housing_layout import (
    ABOVE_SHARE,
    CLEARANCE_M,
    IRON_WALL,
    STEEL_WALL,
    end_for_bearings_m,
    height_for_bearings_m,
    housing_contents,
    least_wall_m,
)
from siggen.gearbox.housing_numbers import PlateNumbers
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import Number, bounds

THICKEST = 0.25
"""Thickness of a wall over the least inner length of its box; a thicker one is no plate."""
LEAST_BEARING = 1.2
"""Outer diameter of a bearing over that of its shaft (rolling bearings have more)."""


class Least(NamedTuple):
    """The least inner length of a box [m] along one axis, and why."""

    given: str
    length_m: float
    reason: str


def housing_problems(sections: Mapping[str, Any], pairs: Sequence[GearPair]) -> list[Problem]:
    """Return the problems of the section at the bounds of all numbers, for the gears that are possible."""
    dynamics: Dynamics | None = sections.get("dynamics")
    housing = sections.get("housing")
    if dynamics is None or dynamics.model != "casing" or not isinstance(housing, PlateHousing):
        return []
    return [problem for pair in pairs for problem in _problems(housing, dynamics.shafts, pair)]


def _problems(housing: PlateHousing, shafts: Shafts | None, pair: GearPair) -> Iterator[Problem]:
    yield from _bearing_problems(shafts, pair)
    widest = None if shafts is None else _widest(shafts)
    numbers = PlateNumbers.model_construct(**dict(housing))
    numbers = numbers.model_copy(update={"bearing": bounds(numbers.bearing)[1]})
    contents, wall_m = housing_contents(numbers, widest, pair), _thickest_m(housing, pair)
    for least in _least(contents, wall_m):
        given: Number | None = getattr(housing, least.given)
        if given is not None and 1e-3 * bounds(given)[0] < least.length_m:
            allowed = f"allowed: at least {1e3 * least.length_m:.4g} mm: {least.reason}"
            yield Problem(f"housing.{least.given}", f"{bounds(given)[0]:g}", allowed)
    most_m = THICKEST * min(_inner_m(numbers, contents))
    if housing.wall_mm is not None and wall_m > most_m:
        allowed = f"allowed: at most {1e3 * most_m:.3g} mm, a quarter of the least inner length of the box"
        yield Problem("housing.wall_mm", f"{1e3 * wall_m:g}", allowed)


def _bearing_problems(shafts: Shafts | None, pair: GearPair) -> Iterator[Problem]:
    """Yield shafts whose bearings have no room beside each other in one wall."""
    if shafts is None:
        return
    diameters_mm = {which: bounds(getattr(shafts, which).diameter_mm)[1] for which in ("pinion", "gear")}
    most_mm = 2e3 * pair.working_centre_distance_m / LEAST_BEARING
    thicker = max(diameters_mm, key=lambda which: diameters_mm[which])
    if sum(diameters_mm.values()) > most_mm:
        received = f"{diameters_mm[thicker]:g}, with the other shaft {sum(diameters_mm.values()):g} mm together"
        allowed = f"allowed: at most {most_mm:.4g} mm together, so that both bearings fit into one wall of the housing"
        yield Problem(f"dynamics.shafts.{thicker}.diameter_mm", received, allowed)


def _widest(shafts: Shafts) -> Shafts:
    parts = {name: getattr(shafts, name) for name in ("pinion", "gear")}
    return shafts.model_copy(
        update={name: p.model_copy(update={"diameter_mm": bounds(p.diameter_mm)[1]}) for name, p in parts.items()}
    )


def _thickest_m(housing: PlateHousing, pair: GearPair) -> float:
    if housing.wall_mm is not None:
        return 1e-3 * bounds(housing.wall_mm)[1]
    share = IRON_WALL[1] if housing.material == "grey_iron" else STEEL_WALL[1]
    return share * least_wall_m(pair.working_centre_distance_m)


def _least(contents: Contents, wall_m: float) -> Iterator[Least]:
    """Yield the least inner lengths that hold gears and bearings, with some room to turn."""
    tips_m, tip_m = sum(contents.tip_radius_m), max(contents.tip_radius_m)
    end_m = max(CLEARANCE_M, end_for_bearings_m(contents, wall_m))
    yield Least("length_mm", contents.centre_distance_m + tips_m + 2.0 * end_m, "the gears, and bearings in the walls")
    lid = bounds(PlateNumbers.model_fields["lid"].default)[0]
    above_m = max(CLEARANCE_M, height_for_bearings_m(contents, wall_m, lid))
    yield Least("height_mm", 2.0 * tip_m + above_m / ABOVE_SHARE, "the larger gear, a third of the rest above it")
    yield Least("width_mm", contents.face_width_m + 2.0 * CLEARANCE_M, "the gears' faces (gears.face_width_mm)")


def _inner_m(numbers: PlateNumbers, contents: Contents) -> Iterator[float]:
    """Yield the least inner length and height that a gearbox may draw, and the width where it is given.

    A width that is not given may be as narrow as the shafts ask for, whatever the walls.
    """
    centre_m, tips_m = contents.centre_distance_m, contents.tip_radius_m
    end, above, sump = (bounds(n)[0] for n in (numbers.end, numbers.above, numbers.sump))
    own_m = (sum(tips_m) + (1.0 + 2.0 * end) * centre_m, 2.0 * max(tips_m) + (above + sump) * centre_m, math.inf)
    given = (numbers.length_mm, numbers.height_mm, numbers.width_mm)
    yield from (m if mm is None else 1e-3 * bounds(mm)[0] for m, mm in zip(own_m, given, strict=True))
