"""A damage in whose place nothing is missing: it passes wherever a damage passes, and acts on nothing.

A tooth with one has kinds of pairs of its own in every table, computed as those of a damaged tooth are. What tells it
from a sound tooth in a record is a leak of the simulation, not physics.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.part import Part, Refusal, ToothDamage
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear

SHAM = "sham"


@dataclass(frozen=True, slots=True)
class Sham:
    """A damage of one tooth with nothing removed; `of` is the damage whose place it has."""

    of: ToothDamage
    outline: None = None
    depth_m: float = 0.0

    @property
    def gear(self) -> str:
        """Gear of the damage."""
        return self.of.gear

    @property
    def tooth(self) -> int:
        """Tooth of the damage."""
        return self.of.tooth

    @property
    def kind(self) -> str:
        """Kind of damage: none of those that are."""
        return SHAM

    def sham(self) -> Sham:
        """Return itself: there is no less."""
        return self

    def rows(self) -> list[tuple[float, ...]]:
        """Return no rows: it takes nothing."""
        return []

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> FloatArray:
        """Return no compliance, of the shape that the damage has one."""
        return np.zeros(np.shape(self.of.tooth_compliance_m_per_n(pair, roll_rad, sound_m_per_n)))

    def profile_arc_m(self, gear: SpurGear) -> float:  # noqa: ARG002 - as a damage is asked
        """Return no length."""
        return 0.0

    def hides(self, other: Part) -> bool:
        """Return whether the damage would hide that of another one."""
        return isinstance(other, Sham) and self.of.hides(other.of)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield what is impossible about the damage."""
        yield from self.of.own_problems()

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        """Yield what is impossible about the damage on a pair."""
        yield from self.of.place_problems(pair)

    def table_row(self) -> dict[str, object]:
        """Return gear and tooth; a sham has no sizes."""
        return {"gear": self.gear, "tooth": self.tooth, "kind": self.kind, "shape": "none", "depth_law": "none"}
