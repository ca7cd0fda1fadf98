"""What is impossible in a section `dynamics.shafts`: models without them, bearings inside the gear, thick shafts."""

from __future__ import annotations

from collections.abc import Iterator

from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import corners
from siggen.names import SHAFT_OF, Side


def shaft_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield the problems of shafts at the bounds of all numbers, for the gears that are possible."""
    dynamics = gearbox.config.dynamics
    if dynamics.shafts is None:
        return
    if dynamics.model != "casing":
        allowed = f"allowed: null with dynamics.model: {dynamics.model}, or dynamics.model: casing"
        yield Problem("dynamics.shafts", "a mapping", allowed)
    elif dynamics.mesh.law != "pairs":
        received = f"a mapping, with dynamics.mesh.law: {dynamics.mesh.law}"
        allowed = "allowed: null, or dynamics.mesh.law: pairs, whose contact feels a tilt"
        yield Problem("dynamics.shafts", received, allowed)
    else:
        for pair in gearbox.meshes[0].pairs:
            for side in Side:
                yield from _of_shaft(gearbox, side, pair)


def _of_shaft(gearbox: PossibleGearbox, side: Side, pair: GearPair) -> Iterator[Problem]:
    shafts = [*corners(gearbox.shaft(side, pair))]
    least_mm, shares = 1e3 * min(one.span_m for one in shafts), [one.gear_share for one in shafts]
    nearer_mm = least_mm * min(*shares, *(1.0 - share for share in shares))
    half_mm = 0.5e3 * pair.face_width_m
    if nearer_mm < half_mm:
        places = f"gear_position {min(shares):g} to {max(shares):g} a bearing {nearer_mm:g} mm from the middle"
        allowed = f"allowed: bearings beside the gear, at least {half_mm:g} mm from its middle (face_width_mm)"
        yield Problem(f"dynamics.shafts.{SHAFT_OF[side]}.bearing_span_mm", f"{least_mm:g}, with {places}", allowed)
    thickest_mm, root_mm = 1e3 * max(one.diameter_m for one in shafts), 2e3 * pair.member(side).root_radius_m
    if thickest_mm >= root_mm:
        allowed = f"allowed: less than the root diameter of its gear, {root_mm:.4g} mm"
        yield Problem(f"dynamics.shafts.{SHAFT_OF[side]}.diameter_mm", f"{thickest_mm:g}", allowed)
