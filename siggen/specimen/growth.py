"""Growth of damage over the states of one specimen: which teeth are hit, and where draws come from.

What a state adds is drawn by generators of its own, so the damage of a state does not depend on which others are
simulated. Where damage lies and how it is shaped is drawn once, for the state in which it began.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from siggen.config import Config
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.keys.teeth import TeethValue
from siggen.seeding import Stage, generator, named_generator, named_uniforms

MM = 1e-3


class OnTeeth(Protocol):
    """A section that hits teeth of a gear."""

    @property
    def gear(self) -> str: ...  # noqa: D102 - see the class

    @property
    def teeth(self) -> TeethValue: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class Growth:
    """A state of one specimen, and where its draws come from.

    What places a layout belongs to the state in which the damage of that gear began, so that it does not wander while
    it grows; what a state adds belongs to that state. `before` is the damage of the milder state.
    """

    config: Config
    specimen_id: int
    pair: GearPair
    state_id: int
    before: Damage = ()

    def began(self, gear: str, kind: type) -> int:
        """Return the first state of this growth that has such damage on the gear."""
        first, state_id = self.state_id, self.config.grown_from(self.state_id)
        while state_id is not None:
            older = self.config.states[state_id].damage
            if isinstance(older, kind) and getattr(older, "gear", None) == gear:
                first = state_id
            state_id = self.config.grown_from(state_id)
        return first

    def place(self, gear: str, kind: type) -> Callable[[str], float]:
        """Return path -> uniform of the first state of this growth that has such damage on the gear."""
        return named_uniforms(self.config.seed, Stage.DAMAGE, self.specimen_id, self.began(gear, kind))

    def shape(self, gear: str, kind: type, name: str) -> np.random.Generator:
        """Return the generator of one thing that keeps its shape from the first such state on."""
        return named_generator(self.config.seed, Stage.DAMAGE, self.specimen_id, self.began(gear, kind), name=name)

    def rng(self, name: str) -> np.random.Generator:
        """Return the generator of one thing that this state adds."""
        return named_generator(self.config.seed, Stage.DAMAGE, self.specimen_id, self.state_id, name=name)

    def teeth(self, model: OnTeeth) -> tuple[int, ...]:
        """Return the teeth that a damage model hits."""
        return damaged_teeth(self.config, self.specimen_id, self.pair.member(model.gear), model)


def damaged_teeth(config: Config, specimen_id: int, gear: SpurGear, model: OnTeeth) -> tuple[int, ...]:
    """Return the teeth that are hit: the listed ones, or neighbours from a tooth drawn once per specimen and gear."""
    if isinstance(model.teeth, tuple):
        return model.teeth
    if not isinstance(model.teeth, int):
        raise TypeError(f"a drawn number of teeth was expected, received {model.teeth}")
    draws = generator(config.seed, Stage.DAMAGED_TEETH, specimen_id).random(2)
    first = int(draws[("pinion", "gear").index(model.gear)] * gear.teeth)
    return tuple((first + i) % gear.teeth for i in range(model.teeth))
