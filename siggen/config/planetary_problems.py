"""What a planetary set cannot have, whether its teeth assemble, and damage on gears that a machine does not have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from siggen.config.dynamics import Dynamics, UnbalanceSection
from siggen.config.gears import GearsSection
from siggen.config.housing import PlateHousing
from siggen.config.planetary import RING, ROLES, Planetary
from siggen.errors import Problem
from siggen.gears.geometry.planetary import PlanetarySet, planetary_problems, typed_places
from siggen.keys.number import bounds

BESIDE = "in a planetary set"
KEYS = {"ring": "ring_teeth", "carrier": "positions_deg", "planets": "positions_deg"}
"""What a problem of teeth is about -> key of the section."""


def sets_problems(sections: Mapping[str, Any], _: Mapping[str, object]) -> Iterator[Problem]:
    """Yield what is wrong about a planetary set between the valid sections of a configuration."""
    section: Planetary | None = sections.get("planetary")
    if section is None:
        return
    if "gears" in sections:
        yield from _of_gears(sections["gears"], section)
    if "dynamics" in sections:
        yield from _of_dynamics(sections["dynamics"], sections.get("housing"))
    yield from _of_others(sections)
    yield from _of_states(sections)


def set_of(gears: GearsSection, section: Planetary) -> PlanetarySet:
    """Return the teeth of a set and the places of its planets."""
    sun, planet = gears.pinion.teeth, gears.gear.teeth
    return PlanetarySet(sun, planet, section.ring_teeth, typed_places(section.positions_deg, sun + section.ring_teeth))


def _of_gears(gears: GearsSection, section: Planetary) -> Iterator[Problem]:
    if gears.pairs:
        yield Problem("gears.pairs", f"{len(gears.pairs)} pairs", f"allowed: none {BESIDE}")
    if bounds(gears.helix_deg) != (0.0, 0.0):
        yield Problem("gears.helix_deg", str(gears.helix_deg), f"allowed: 0 {BESIDE}")
    for one in planetary_problems(set_of(gears, section)):
        key = KEYS.get(one.where, "positions_deg" if one.where.startswith("planet ") else "")
        path = f"planetary.{key}" if key else f"gears.{ROLES.get(one.where, one.where)}.teeth"
        yield Problem(path, f"{one.name}: {one.received}", one.allowed)


def _of_dynamics(dynamics: Dynamics, housing: object) -> Iterator[Problem]:
    if dynamics.model == "casing" and isinstance(housing, PlateHousing):
        allowed = f"allowed: rigid or modal {BESIDE}, since plates have seats for two shafts beside each other"
        yield Problem("housing.kind", "'plates' (by default)", f"{allowed}; or dynamics.model: 8dof")
    if dynamics.mesh.law != "pairs":
        yield Problem("dynamics.mesh.law", f"'{dynamics.mesh.law}'", f"allowed: pairs {BESIDE}")
    if dynamics.shafts is not None:
        yield Problem("dynamics.shafts", "a section", f"allowed: null {BESIDE}")
    if dynamics.unbalance != UnbalanceSection():
        yield Problem("dynamics.unbalance", "a section", f"allowed: none {BESIDE}")
    for which in ("pinion", "gear"):
        if getattr(dynamics, which) != type(dynamics).model_fields[which].default:
            allowed = f"allowed: none {BESIDE}; its supports stand in planetary, masses of sun and planets are discs'"
            yield Problem(f"dynamics.{which}", "a section", allowed)


def _of_others(sections: Mapping[str, Any]) -> Iterator[Problem]:
    if sections.get("internals") is not None:
        yield Problem("internals", "a section", f"allowed: null {BESIDE}")
    background = sections.get("background")
    if background is not None and background.second_stage is not None:
        yield Problem("background.second_stage", "a section", f"allowed: null {BESIDE}; auxiliary_drive has lines, too")
    for index, point in enumerate(sections.get("operating_points", ())):
        if bounds(point.torque_nm)[0] <= 0.0:
            yield Problem(f"operating_points.{index}.torque_nm", str(point.torque_nm), f"allowed: above 0 {BESIDE}")


def _of_states(sections: Mapping[str, Any]) -> Iterator[Problem]:
    for index, state in sections.get("states", {}).items():
        for where, one in state.placed(f"states.{index}"):
            if one.needs_pairs or one.needs_bearings:
                allowed = f"allowed {BESIDE}: pits, spalls and cracks of sun and planets"
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)
            elif getattr(one, "gear", "") == RING and not one.nouns:
                allowed = "allowed: pits and spalls of a ring, whose teeth have no law of cracks"
                yield Problem(f"{where}.kind", f"'{one.kind_word()}'", allowed)
