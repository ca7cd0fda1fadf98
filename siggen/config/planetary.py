"""Section `planetary`: the pair of `gears` as sun and planets of a set whose ring is held."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field

from siggen.config.dynamics import Dynamics, UnbalanceSection
from siggen.config.gears import GearsSection
from siggen.config.housing import PlateHousing
from siggen.errors import Problem
from siggen.gears.planetary import PlanetarySet, planetary_problems, typed_places
from siggen.keys.number import Number, Within, bounds
from siggen.keys.section import Real, Section, Whole
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText

ROLES = {"sun": "pinion", "planet": "gear"}
"""Name of a gear in a planetary set -> what it is in the pair of `gears`."""
RING = "ring"
"""The gear that is in no mesh of the pair of `gears`."""
NAMES = {role: name for name, role in ROLES.items()}
POSITIONS = AllowedText("a list of 3 to 5 angles in degrees, 0 first, ascending, below 360")

SUPPORTS = (
    "bearings of the sun's shaft (soft: it floats), of each planet with its pin, hold of the ring, bearings "
    "of the carrier"
)


class Planetary(Section):
    """A ring round sun and planets, their carrier, and what holds them.

    `gears.pinion` is the sun, which the motor drives; `gears.gear` is each planet; the carrier drives the load. The
    ring is shifted to mesh without backlash. Supports are alike in all directions; they stand on the ground, or with
    dynamics.model: casing in a `housing` (rigid or modal).
    """

    ring_teeth: Annotated[Whole, Field(ge=8, le=1000)] = Field(description="number of teeth of the ring")
    positions_deg: Annotated[tuple[Real, ...], Field(min_length=1, max_length=9), POSITIONS] = Field(
        default=(0.0, 120.0, 240.0),
        description="of planets on the carrier, as it turns; the nearest place where teeth fit counts",
    )
    pin_error_um: Annotated[Number, Within(least=0, most=200), Usual(0.1, 200)] = Field(
        default=0.0,
        description="standard deviation of the tangential place of each planet's pin, drawn per gearbox",
    )
    sun_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(100000, 1e09)] = Field(
        default=2e7, description=SUPPORTS
    )
    planet_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 1e10)] = Field(
        default=2e8, description=SUPPORTS
    )
    ring_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 2e10)] = Field(
        default=5e8, description=SUPPORTS
    )
    carrier_stiffness_n_per_m: Annotated[Number, Within(above=0), Usual(1e06, 1e10)] = Field(
        default=2e8, description=SUPPORTS
    )
    ring_mass_kg: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="null: steel, four modules thick behind the roots (assumed)"
    )


# What a planetary set cannot have, whether its teeth assemble, and damage on gears that a machine does not have.

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
