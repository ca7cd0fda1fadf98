"""What is impossible in a section `dynamics.shafts`: models without them, bearings inside the gear, thick shafts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from siggen.config import Dynamics, Shaft
from siggen.errors import Problem
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import bounds


def shaft_problems(sections: Mapping[str, Any], pairs: Sequence[GearPair]) -> list[Problem]:
    """Return the problems of the section at the bounds of all numbers, for the gears that are possible."""
    dynamics: Dynamics | None = sections.get("dynamics")
    if dynamics is None or dynamics.shafts is None:
        return []
    if dynamics.model != "casing":
        allowed = f"allowed: null with dynamics.model: {dynamics.model}, or dynamics.model: casing"
        return [Problem("dynamics.shafts", "a mapping", allowed)]
    if dynamics.mesh.law != "pairs":
        received = f"a mapping, with dynamics.mesh.law: {dynamics.mesh.law}"
        allowed = "allowed: null, or dynamics.mesh.law: pairs, whose contact feels a tilt"
        return [Problem("dynamics.shafts", received, allowed)]
    found: list[Problem] = []
    for which in ("pinion", "gear"):
        section = getattr(dynamics.shafts, which)
        for pair in pairs:
            found += _of_shaft(section, which, pair)
    return found


def _of_shaft(section: Shaft, which: str, pair: GearPair) -> Iterator[Problem]:
    least_mm, (low, high) = bounds(section.bearing_span_mm)[0], bounds(section.gear_position)
    nearer_mm = least_mm * min(low, 1.0 - high)
    half_mm = 0.5e3 * pair.face_width_m
    if nearer_mm < half_mm:
        received = f"{least_mm:g}, with gear_position {low:g} to {high:g} a bearing {nearer_mm:g} mm from the middle"
        allowed = f"allowed: bearings beside the gear, at least {half_mm:g} mm from its middle (gears.face_width_mm)"
        yield Problem(f"dynamics.shafts.{which}.bearing_span_mm", received, allowed)
    thickest_mm, root_mm = bounds(section.diameter_mm)[1], 2e3 * pair.member(which).root_radius_m
    if thickest_mm >= root_mm:
        allowed = f"allowed: less than the root diameter of its gear, {root_mm:.4g} mm"
        yield Problem(f"dynamics.shafts.{which}.diameter_mm", f"{thickest_mm:g}", allowed)
