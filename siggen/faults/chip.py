"""Chipped and broken teeth: how much of a tooth is gone from its tip down, over how much of the face."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf
from typing import Annotated, ClassVar, Literal

import pyarrow as pa
from pydantic import Field

from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import DAMAGED_GEAR, MM, MODULE, AnyGear
from siggen.faults.growth import Growth
from siggen.gears.damage.chip import WholeChip, corner_reach_pitches, keeps_contact, tooth_height_m
from siggen.gears.damage.part import Parts
from siggen.gears.damage.part_chip import PartChip, lost_outline
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import CORNER_REACH_PITCHES
from siggen.keys.column import MILLIMETRE, Column
from siggen.keys.drawing import draw
from siggen.keys.number import Number, Within, bounds, number_text
from siggen.keys.scaling import Grows
from siggen.keys.teeth import DAMAGED_TEETH, Teeth, most_teeth
from siggen.keys.usual import Usual
from siggen.names import EITHER, PINION, Side

WHOLE = "whole"
HEIGHT = Column(
    "chip_height_mm", pa.float64(), MILLIMETRE, "height lost from a tooth's tip; 0 for other damage, or all"
)
WIDTH = Column(
    "chip_width_mm",
    pa.float64(),
    MILLIMETRE,
    "over which width of the face, from its end at 0, it is lost; 0 for other damage, or all",
)


class ChippedTeeth(Fault):
    """Teeth without their tips over the face or a part of it, or teeth that are gone."""

    words: ClassVar[tuple[str, ...]] = ("chip", "broken_tooth")
    outranked: ClassVar[tuple[str, ...]] = ("pitting", "spalling")
    acts: ClassVar[str] = (
        "Chipped teeth end at a lower tip, so their pairs leave the mesh early; where a tooth is gone, the corners of "
        "its neighbours carry, and flanks part and strike."
    )
    columns: ClassVar[tuple[Column, ...]] = (HEIGHT, WIDTH)
    needs_pairs: ClassVar[bool] = True

    kind: Literal["chip"] = "chip"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    height_mm: Annotated[Number | Literal["whole"], Within(above=0, words=(WHOLE,)), Usual(0.05, 30), Grows(MODULE)] = (
        Field(description="height lost from the tip down, along the radius; whole: the tooth is gone")
    )
    face_share: Annotated[Number | None, Within(above=0, most=1, words=(None,)), Usual(0.01, 1)] = Field(
        default=None, description="share of the face that has lost it, from one end; null: the whole face"
    )

    @classmethod
    def default_word(cls, read: Callable[[str], object]) -> str:
        """Return broken_tooth for teeth that are gone."""
        return "broken_tooth" if read("height_mm") == WHOLE else "chip"

    @property
    def own_words(self) -> tuple[str, ...]:
        """Teeth that are gone are broken; of others one may say so."""
        return ("broken_tooth",) if self.height_mm == WHOLE else self.words

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'height_mm' for no more lost than the milder state has lost on the same teeth."""
        if not isinstance(milder, ChippedTeeth) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        less = _heights_m(self)[1] <= _heights_m(milder)[0] and _shares(self)[1] <= _shares(milder)[0]
        return "height_mm" if less else None

    def drawn(self, growth: Growth) -> Parts:
        """Return what is lost of each damaged tooth, all of them alike."""
        own = draw(self, growth.place(self.gear, ChippedTeeth), f"chip.{self.gear}")
        return tuple(own._on_tooth(growth.pair, tooth) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield more than a tooth, and neighbours of which none meets its mate: no corner would carry between them."""
        deepest_m, most_m = _heights_m(self)[1], tooth_height_m(pair.member(self.side))
        if not isinstance(self.height_mm, str) and deepest_m > most_m:
            allowed = f"allowed: up to {1e3 * most_m:.6g}, the height of the tooth; or {WHOLE}"
            yield Problem("height_mm", number_text(self.height_mm), allowed)
        elif (
            self._may_take_the_face
            and not keeps_contact(pair, self.side, deepest_m)
            and _has_neighbours(most_teeth(self.teeth), pair.member(self.side).teeth)
        ):
            allowed = (
                "allowed: teeth that are no neighbours, or heights that leave some of the flank that meets the mate"
            )
            yield Problem("teeth", str(self.teeth), allowed)

    def reach_pitches(self, pair: GearPair) -> float:
        """Return how far beside the path of contact corners carry where most is lost."""
        if not self._may_take_the_face:
            return CORNER_REACH_PITCHES
        gears = Side if self.gear == EITHER else (self.side,)
        return max(corner_reach_pitches(pair, side, _heights_m(self)[1]) for side in gears)

    @property
    def _may_take_the_face(self) -> bool:
        """Whether the same height may be lost over the whole face."""
        return _shares(self)[1] >= 1.0

    def _on_tooth(self, pair: GearPair, tooth: int) -> WholeChip | PartChip:
        """Return the chip of drawn numbers on a tooth."""
        share, whole = _shares(self)[0], isinstance(self.height_mm, str)
        if self._may_take_the_face:
            return WholeChip(self.side, tooth, _heights_m(self)[0])
        gear, width_m = pair.member(self.side), share * pair.face_width_m
        height_m = tooth_height_m(gear) if whole else _heights_m(self)[0]
        outline = lost_outline(gear, height_m, width_m)
        return PartChip(self.side, tooth, height_m, width_m, outline, whole)


def _shares(section: ChippedTeeth) -> tuple[float, float]:
    """Return the least and the largest share of the face."""
    return (1.0, 1.0) if section.face_share is None else bounds(section.face_share)


def _heights_m(section: ChippedTeeth) -> tuple[float, float]:
    """Return the least and the largest height that is lost [m]."""
    if isinstance(section.height_mm, str):
        return inf, inf
    low, high = bounds(section.height_mm)
    return MM * low, MM * high


def _has_neighbours(teeth: int | tuple[int, ...], count: int) -> bool:
    """Return whether neighbouring teeth of a gear are hit."""
    if isinstance(teeth, int):
        return teeth > 1
    return any((tooth + 1) % count in teeth for tooth in teeth)
