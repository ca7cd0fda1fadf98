"""Edges of damage that are rounder than the contact across the face holds for.

Derived: the law of a rounded edge (`siggen.gears.contact.edge_law`) lets the sink fall with a growing distance inside
the gap only while r/(R + r) is at most 1/8, so r at most R/7. R is taken at the pitch point. Beyond, contacts of some
gearboxes are not solved.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import bounds

LARGEST_SHARE = 1.0 / 7.0
"""Radius of an edge over the relative radius of curvature at the pitch point."""


def edge_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield edge radii that are too large at the bounds of all numbers, for the gears that are possible."""
    if gearbox.config.dynamics.mesh.law != "pairs":
        return
    for mesh in gearbox.meshes:
        most_mm = 1e3 * LARGEST_SHARE * min(map(_pitch_radius_m, mesh.pairs), default=inf)
        given = {path: damage.own_edge_radius for path, damage in mesh.damages}
        radii = {f"{path}.{own[0]}": own[1] for path, own in given.items() if own is not None}
        if len(radii) < len(given):
            radii["dynamics.mesh.pit_edge_radius_mm"] = gearbox.config.dynamics.mesh.pit_edge_radius_mm
        for path, radius in radii.items():
            if bounds(radius)[1] > most_mm:
                allowed = f"allowed: at most {most_mm:.3g}, a seventh of the flanks' relative radius at the pitch point"
                yield Problem(path, str(radius), allowed)


def _pitch_radius_m(pair: GearPair) -> float:
    position, line = pair.pitch_point_m, pair.line_of_action_m
    return position * (line - position) / line
