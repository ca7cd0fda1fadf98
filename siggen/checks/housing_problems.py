"""What is impossible in a `housing` of plates: gears or bearings that do not fit in, walls too thick for a plate.

Everything is checked at the bounds of all numbers, with the largest bearings that a gearbox may draw.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from siggen.drivetrain.box import Contents
from siggen.errors import Problem
from siggen.gearbox.housing import (
    ABOVE_SHARE,
    CLEARANCE_M,
    PlateNumbers,
    end_for_bearings_m,
    height_for_bearings_m,
    specimen_layout,
)
from siggen.gearbox.possible import PossibleGearbox
from siggen.gears.gear_pair import GearPair
from siggen.keys.number import HIGH, LOW, Number, bounds, constant
from siggen.names import SHAFT_OF, Side

THICKEST = 0.25
"""Thickness of a wall over the least inner length of its box; a thicker one is no plate."""
LEAST_BEARING = 1.2
"""Outer diameter of a bearing over that of its shaft (rolling bearings have more)."""


class Least(NamedTuple):
    """The least inner length of a box [m] along one axis, and why."""

    given: str
    length_m: float
    reason: str


def housing_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the problems of the section at the bounds of all numbers, for the gears that are possible."""
    least, most = gearbox.plates(lambda _: LOW), gearbox.plates(lambda _: HIGH)
    if least is None or most is None:
        return
    for pair in gearbox.meshes[0].pairs:
        shafts = gearbox.shafts(lambda _: HIGH)
        contents, proportions, _ = specimen_layout(most, shafts, pair)
        if shafts is not None:
            yield from _bearing_problems({role: constant(shafts.of(role).diameter_mm) for role in Side}, pair)
        yield from _problems(least, most, contents, proportions.wall_m)


def _problems(least: PlateNumbers, most: PlateNumbers, contents: Contents, wall_m: float) -> Iterator[Problem]:
    for one in _least(contents, wall_m):
        given: Number | None = getattr(least, one.given)
        if given is not None and 1e-3 * constant(given) < one.length_m:
            allowed = f"allowed: at least {1e3 * one.length_m:.4g} mm: {one.reason}"
            yield Problem(f"housing.{one.given}", f"{given:g}", allowed)
    most_m = THICKEST * min(_inner_m(least, contents))
    if most.wall_mm is not None and wall_m > most_m:
        allowed = f"allowed: at most {1e3 * most_m:.3g} mm, a quarter of the least inner length of the box"
        yield Problem("housing.wall_mm", f"{1e3 * wall_m:g}", allowed)


def _bearing_problems(diameters_mm: Mapping[str, float], pair: GearPair) -> Iterator[Problem]:
    """Yield shafts whose bearings have no room beside each other in one wall."""
    most_mm = 2e3 * pair.working_centre_distance_m / LEAST_BEARING
    thicker = max(Side, key=lambda role: diameters_mm[role])
    if sum(diameters_mm.values()) > most_mm:
        received = f"{diameters_mm[thicker]:g}, with the other shaft {sum(diameters_mm.values()):g} mm together"
        allowed = f"allowed: at most {most_mm:.4g} mm together, so that both bearings fit into one wall of the housing"
        yield Problem(f"dynamics.shafts.{SHAFT_OF[thicker]}.diameter_mm", received, allowed)


def _least(contents: Contents, wall_m: float) -> Iterator[Least]:
    """Yield the least inner lengths that hold gears and bearings, with some room to turn."""
    tips_m, tip_m = sum(contents.tip_radius_m), max(contents.tip_radius_m)
    end_m = max(CLEARANCE_M, end_for_bearings_m(contents, wall_m))
    yield Least("length_mm", contents.centre_distance_m + tips_m + 2.0 * end_m, "the gears, and bearings in the walls")
    lid = bounds(PlateNumbers.model_fields["lid"].default)[0]
    above_m = max(CLEARANCE_M, height_for_bearings_m(contents, wall_m, lid))
    yield Least("height_mm", 2.0 * tip_m + above_m / ABOVE_SHARE, "the larger gear, a third of the rest above it")
    yield Least("width_mm", contents.face_width_m + 2.0 * CLEARANCE_M, "the gears' faces (face_width_mm)")


def _inner_m(numbers: PlateNumbers, contents: Contents) -> Iterator[float]:
    """Yield the least inner length and height that a gearbox may draw, and the width where it is given.

    A width that is not given may be as narrow as the shafts ask for, whatever the walls.
    """
    centre_m, tips_m = contents.centre_distance_m, contents.tip_radius_m
    end, above, sump = map(constant, (numbers.end, numbers.above, numbers.sump))
    own_m = (sum(tips_m) + (1.0 + 2.0 * end) * centre_m, 2.0 * max(tips_m) + (above + sump) * centre_m, math.inf)
    given = (numbers.length_mm, numbers.height_mm, numbers.width_mm)
    yield from (m if mm is None else 1e-3 * constant(mm) for m, mm in zip(own_m, given, strict=True))
