"""Pits and outlines that are listed one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from siggen.errors import Problem
from siggen.faults.fault import Fault, HitTeeth
from siggen.faults.flank_place import (
    FACE_CENTRE,
    FACE_WIDTH,
    MIDDLE_HEIGHT,
    MM,
    READING,
    AnyGear,
    Height,
    HeightReading,
    drawn_height_m,
    heights_m,
)
from siggen.faults.growth import Growth
from siggen.faults.listed_irregular import ListedIrregular
from siggen.faults.single_pit import PitPlace, PitSize, drawn_pit, largest_pit, pit_place_problems
from siggen.gears.damage.part import Parts
from siggen.gears.damage.pit import FlankPit
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import Number, Within, at, bounds
from siggen.keys.problems import refusal
from siggen.keys.scaling import Grows
from siggen.keys.section import Whole
from siggen.names import PINION, Side


class ListedPit(PitSize):
    """One pit at a given place."""

    gear: AnyGear = Field(default=PINION, description="damaged gear")
    tooth: Annotated[Whole, Field(ge=0)] = Field(default=0, description="index of the tooth, from 0")
    height_mm: Height = Field(default="pitch", description=MIDDLE_HEIGHT)
    face_mm: Annotated[Number, Within(least=0), Grows(FACE_WIDTH)] = Field(description=FACE_CENTRE)


class ListedPits(Fault):
    """Pits, and irregular spalls by their outlines, one by one."""

    words: ClassVar[tuple[str, ...]] = ("pitting", "spalling")
    nouns: ClassVar[str] = "pits and spalls"
    one_flank: ClassVar[bool] = True

    kind: Literal["list"] = "list"
    height_reading: HeightReading = Field(default="axial", description=READING)
    pits: tuple[ListedPit, ...] = Field(default=(), description="the pits")
    outlines: tuple[ListedIrregular, ...] = Field(default=(), description="irregular spalls by their very edges")

    @model_validator(mode="after")
    def _not_empty(self) -> ListedPits:
        if not (self.pits or self.outlines):
            raise refusal([Problem("pits", "no pits and no outlines", "allowed: at least 1 of either")])
        return self

    @classmethod
    def default_word(cls, read: Callable[[str], object]) -> str:
        """Return spalling for a list of outlines alone."""
        return "spalling" if read("outlines") and not read("pits") else "pitting"

    @property
    def own_words(self) -> tuple[str, ...]:
        """Whatever is listed may be called pitting, and with a spall spalling."""
        return self.words if self.outlines else ("pitting",)

    @property
    def hit_gear(self) -> str:
        """The gear of the first entry: all are in one mesh."""
        return self.hit_gears[0]

    @property
    def hit_gears(self) -> tuple[str, ...]:
        """Those of all entries."""
        return (*(one.gear for one in self.pits), *(one.gear for one in self.outlines))

    def with_gears(self, name: Callable[[str], str]) -> ListedPits:
        """Return the same on gears of other names."""
        lists = {
            key: tuple(one.model_copy(update={"gear": name(one.gear)}) for one in getattr(self, key))
            for key in ("pits", "outlines")
        }
        return self.model_copy(update=lists)

    def hit_teeth(self) -> HitTeeth:
        """Yield every listed tooth."""
        yield from ((f"pits.{number}.tooth", pit.gear, (pit.tooth,)) for number, pit in enumerate(self.pits))
        yield from ((f"outlines.{number}.tooth", one.gear, (one.tooth,)) for number, one in enumerate(self.outlines))

    @property
    def own_edge_radius(self) -> tuple[str, Number] | None:
        """Those of irregular spalls have one each, of which the largest is told."""
        if not self.outlines:
            return None
        number = max(range(len(self.outlines)), key=lambda i: self.outlines[i].edge_radius_mm)
        return f"outlines.{number}.edge_radius_mm", self.outlines[number].edge_radius_mm

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool] | None:  # noqa: ARG002
        """Return that outlines are no rectangles; None without."""
        return (False, False) if self.outlines else None

    def drawn(self, growth: Growth) -> Parts:
        """Return what is listed."""
        listed = (one.spall(growth.pair, self.height_reading) for one in self.outlines)
        return (*self._pits(growth), *listed)

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with each of them."""
        for index, pit in enumerate(self.pits):
            keys = (f"pits.{index}.height_mm", f"pits.{index}.face_mm", f"pits.{index}.depth_mm")
            for height_m in heights_m(pair, Side(pit.gear), pit.height_mm, self.height_reading):
                for face_mm in bounds(pit.face_mm):
                    yield from pit_place_problems(pair, PitPlace(Side(pit.gear), height_m, face_mm / 1e3, pit, *keys))
        for index, outline in enumerate(self.outlines):
            yield from outline.problems(pair, self.height_reading, f"outlines.{index}.")

    def widest(self, pair: GearPair) -> Damage:
        """Return all of them, as large as they may be."""
        # Teeth that there are not are refused by name elsewhere.
        pits = tuple(
            largest_pit(
                Side(pit.gear),
                pit.tooth,
                heights_m(pair, Side(pit.gear), pit.height_mm, self.height_reading)[0],
                bounds(pit.face_mm)[0] / 1e3,
                pit,
            )
            for pit in self.pits
            if pit.tooth < pair.member(Side(pit.gear)).teeth
        )
        outlined = (one for one in self.outlines if one.tooth < pair.member(Side(one.gear)).teeth)
        return (
            *pits,
            *(replace(one.spall(pair, self.height_reading), strip_depths_m=one.probe_depths_m) for one in outlined),
        )

    def _pits(self, growth: Growth) -> Iterator[FlankPit]:
        for index, pit in enumerate(self.pits):
            rng = growth.rng(f"list.pit{index}")
            height = drawn_height_m(pit.height_mm, self.height_reading, growth.pair, Side(pit.gear), rng.random())
            yield drawn_pit(
                pit, Side(pit.gear), growth.pair, pit.tooth, (height, MM * at(pit.face_mm, rng.random())), rng
            )
