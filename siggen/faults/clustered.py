"""A cluster of pits: scattered around a height."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import (
    DAMAGED_GEAR,
    MIDDLE_HEIGHT,
    READING,
    AnyGear,
    Height,
    HeightReading,
    Length,
    drawn_height_m,
    heights_m,
    length_m,
)
from siggen.faults.growth import Growth
from siggen.faults.single_pit import PitPlace, PitSize, drawn_pit, pit_place_problems
from siggen.gears.damage.heights import flank_heights
from siggen.gears.damage.layouts import clustered_centres
from siggen.gears.damage.part import Parts
from siggen.gears.damage.pit import FlankPit
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.section import Whole
from siggen.keys.teeth import DAMAGED_TEETH, Teeth
from siggen.names import PINION


class ClusteredPits(PitSize, Fault):
    """Pits scattered around a height."""

    words: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "pits"

    kind: Literal["clustered"] = "clustered"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    count: Annotated[Whole, Field(ge=1, le=10_000)] = Field(description="pits")
    centre_height_mm: Height = Field(default="pitch", description=MIDDLE_HEIGHT)
    height_reading: HeightReading = Field(default="axial", description=READING)
    spread_profile_mm: Length = Field(description="standard deviation of the heights; across the face pits lie evenly")

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'count' for no more pits than the milder state has on the same teeth."""
        if not isinstance(milder, ClusteredPits) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "count" if self.count <= milder.count else None

    def drawn(self, growth: Growth) -> Parts:
        """Return the pits that a state adds to its cluster, tooth by tooth."""
        return tuple(pit for tooth in growth.teeth(self) for pit in self._pits(growth, tooth))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with pits in the middle and at either end of the flank."""
        middle_m, keys = pair.face_width_m / 2, ("centre_height_mm", "spread_profile_mm", "depth_mm")
        for height_m in heights_m(pair, self.side, self.centre_height_mm, self.height_reading):
            yield from pit_place_problems(pair, PitPlace(self.side, height_m, middle_m, self, *keys))
        for height_m in flank_heights(pair.member(self.side)):
            remark = "a pit scattered to the end of the flank: "
            yield from pit_place_problems(pair, PitPlace(self.side, height_m, middle_m, self, *keys, remark))

    def _pits(self, growth: Growth, tooth: int) -> Iterator[FlankPit]:
        present = sum(one.gear == self.gear and one.tooth == tooth for one in growth.before)
        for index, centre in enumerate(self._centres_m(growth, tooth, max(self.count - present, 0))):
            rng = growth.rng(f"{self.gear}.{tooth}.pit{index}")
            yield drawn_pit(self, self.side, growth.pair, tooth, centre, rng)

    def _centres_m(self, growth: Growth, tooth: int, count: int) -> list[tuple[float, float]]:
        """Return centres [m] scattered around a height and over the face."""
        if count == 0:
            return []
        uniform, pair = growth.place(self.gear, ClusteredPits), growth.pair
        low, high = flank_heights(pair.member(self.side))
        heights, faces = clustered_centres(
            growth.rng(f"{self.gear}.{tooth}.centres"),
            count,
            drawn_height_m(self.centre_height_mm, self.height_reading, pair, self.side, uniform("centre_height_mm")),
            length_m(self, "spread_profile_mm", uniform),
            0.0,
            pair.face_width_m,
            height_low_m=low,
            height_high_m=high,
        )
        return list(zip(heights.tolist(), faces.tolist(), strict=True))
