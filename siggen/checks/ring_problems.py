"""Whether planets mesh with the ring that they were given."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from siggen.config import Planetary
from siggen.errors import Problem
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair, internal_problems, ring_round


def ring_problems(section: Planetary | None, pairs: Sequence[GearPair]) -> Iterator[Problem]:
    """Yield why planets of sound pairs of sun and planet do not mesh with the ring, each reason once."""
    if section is None:
        return
    for text in dict.fromkeys(text for pair in pairs for text in _texts(pair, section.ring_teeth)):
        yield Problem("planetary.ring_teeth", f"{section.ring_teeth}: {text[0]}", text[1])


def rings_round(section: Planetary, pairs: Sequence[GearPair]) -> list[InternalPair]:
    """Return the planets of pairs of sun and planet in their ring, of those that mesh with it."""
    found = []
    for pair in pairs:
        if not any(_texts(pair, section.ring_teeth)):
            found.append(ring_round(pair, section.ring_teeth))
    return found


def _texts(pair: GearPair, ring: int) -> Iterator[tuple[str, str]]:
    try:
        inner = ring_round(pair, ring)
    except ValueError:
        yield "no ring meshes with planets at this distance", "allowed: a ring nearer to z_sun + 2 z_planet"
        return
    for one in internal_problems(inner):
        yield f"{one.name}, {one.where}: {one.received}", one.allowed
