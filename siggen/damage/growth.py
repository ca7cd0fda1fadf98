"""Growth of damage over the states of one specimen: which teeth are hit, and where draws come from.

What a state adds is drawn by generators of its own, so the damage of a state does not depend on which others are
simulated. Where damage lies and how it is shaped is drawn once, for the state in which it began.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from siggen.damage.flank_wear import LoadAtRest
from siggen.damage.part import Parts
from siggen.gears.gear_pair import GearPair
from siggen.keys.teeth import TeethValue
from siggen.names import Side
from siggen.seeding import Stream, generator, named_generator, named_uniforms


class OnTeeth(Protocol):
    """A section that hits teeth of a gear."""

    @property
    def gear(self) -> str: ...  # noqa: D102 - see the class

    @property
    def teeth(self) -> TeethValue: ...  # noqa: D102


def _no_load(force_n: float) -> LoadAtRest:
    """Stand for gears whose load nobody asks for."""
    raise TypeError(f"load_at_rest: received {force_n} N for gears without tables; allowed: a Growth that has them")


@dataclass(frozen=True, slots=True)
class Growth:
    """A state of one specimen, and where its draws come from.

    What places a layout belongs to the state in which the damage of that gear began, so that it does not wander while
    it grows; what a state adds belongs to that state.

    Attributes
    ----------
    seed, specimen_id, state_id : int
    pair : GearPair
        The drawn gears of the specimen.
    milder : tuple of (int, section)
        States that this one has grown from, with the section of their damage, the nearest first.
    before : Parts
        Damage of the nearest of them.
    load_at_rest : callable
        Force of all pairs [N] -> how these gears, without errors, share it.
    """

    seed: int
    specimen_id: int
    state_id: int
    pair: GearPair
    milder: tuple[tuple[int, object], ...] = ()
    before: Parts = ()
    load_at_rest: Callable[[float], LoadAtRest] = _no_load

    def began(self, gear: str, kind: type) -> int:
        """Return the first state of this growth that has such damage on the gear."""
        found = [n for n, older in self.milder if isinstance(older, kind) and getattr(older, "gear", None) == gear]
        return found[-1] if found else self.state_id

    def place_of(self, kind: type) -> Callable[[str], float]:
        """Return path -> uniform of the first state of this growth that has such damage, which is of both gears."""
        found = [number for number, older in self.milder if isinstance(older, kind)]
        return named_uniforms(self.seed, Stream.DAMAGE, self.specimen_id, found[-1] if found else self.state_id)

    def place(self, gear: str, kind: type) -> Callable[[str], float]:
        """Return path -> uniform of the first state of this growth that has such damage on the gear."""
        return named_uniforms(self.seed, Stream.DAMAGE, self.specimen_id, self.began(gear, kind))

    def shape(self, gear: str, kind: type, name: str) -> np.random.Generator:
        """Return the generator of one thing that keeps its shape from the first such state on."""
        return named_generator(self.seed, Stream.DAMAGE, self.specimen_id, self.began(gear, kind), name=name)

    def rng(self, name: str) -> np.random.Generator:
        """Return the generator of one thing that this state adds."""
        return named_generator(self.seed, Stream.DAMAGE, self.specimen_id, self.state_id, name=name)

    def uniforms(self) -> Callable[[str], float]:
        """Return path -> uniform of this state alone."""
        return named_uniforms(self.seed, Stream.DAMAGE, self.specimen_id, self.state_id)

    def teeth(self, section: OnTeeth) -> tuple[int, ...]:
        """Return the teeth that are hit: the listed ones, or neighbours from a tooth drawn once per gearbox and gear.

        Raises
        ------
        TypeError
            If the number of teeth is still a distribution.
        """
        if isinstance(section.teeth, tuple):
            return section.teeth
        if not isinstance(section.teeth, int):
            raise TypeError(f"a drawn number of teeth was expected, received {section.teeth}")
        draws = generator(self.seed, Stream.DAMAGED_TEETH, self.specimen_id).random(2)
        side = Side(section.gear)
        count = self.pair.member(side).teeth
        first = int(draws[side.number] * count)
        return tuple((first + i) % count for i in range(section.teeth))
