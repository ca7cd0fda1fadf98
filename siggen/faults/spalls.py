"""Spalls of a state: one on each damaged tooth."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import READING, HeightReading, size_that_adds_nothing
from siggen.faults.growth import Growth
from siggen.faults.single_spall import SIZE_KEYS, SpallSize, largest_spall, spall_on_tooth, spall_problems
from siggen.gears.damage.part import Parts
from siggen.gears.damage.spall import FlankSpall
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import draw
from siggen.keys.number import at, constant
from siggen.keys.teeth import DAMAGED_TEETH, STAGES, Stages, Teeth, refuse_stages, stage_of


class Spalls(SpallSize, Fault):
    """A spall on each damaged tooth."""

    words: ClassVar[tuple[str, ...]] = ("spalling",)
    outranked: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "spalls"

    kind: Literal["spall"] = "spall"
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    height_reading: HeightReading = Field(default="arc", description=READING)
    stages: Stages = Field(default=1.0, description=STAGES)

    @model_validator(mode="after")
    def _a_stage_for_each_tooth(self) -> Spalls:
        refuse_stages(self.stages, self.teeth)
        return self

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return the size that is smaller, for spalls in no direction larger than the milder ones at the same place."""
        return size_that_adds_nothing(self, milder, SIZE_KEYS)

    def drawn(self, growth: Growth) -> Parts:
        """Return a spall on each damaged tooth, with the draws of the first spall that it has grown from."""
        return tuple(self._on_tooth(growth, tooth, index) for index, tooth in enumerate(growth.teeth(self)))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with a spall by itself."""
        return spall_problems(pair, self, self.height_reading)

    def widest(self, pair: GearPair) -> Damage:
        """Return the largest spall."""
        return (largest_spall(pair, self, self.height_reading, 0),)

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether it is a rectangle, and whether it may go through the face."""
        return self.parallel(face_width_mm)

    def _on_tooth(self, growth: Growth, tooth: int, index: int) -> FlankSpall:
        uniform, name = growth.place(self.gear, Spalls), f"spall.{self.gear}.{tooth}"
        stage = at(stage_of(self.stages, index), uniform(f"{name}.stages"))
        return spall_on_tooth(growth.pair, draw(self, uniform, name)._at_stage(stage), self.height_reading, tooth)

    def _at_stage(self, stage: float) -> Spalls:
        """Return drawn sizes at a stage: lengths and depth shrink alike."""
        shrunk = {key: stage * constant(getattr(self, key)) for key in SIZE_KEYS}
        return self if stage == 1.0 else self.model_copy(update=shrunk)
