"""Spalls: what a user writes of them, and what they take from a flank.

A spall: an ellipse, a rectangle or any polygon on the flank. Derived.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Literal

from pydantic import Field

from siggen.damage.fault import Fault
from siggen.damage.flank_damage import damage_problems
from siggen.damage.flank_place import (
    ARC,
    DAMAGED_GEAR,
    DEPTH,
    FACE_CENTRE,
    FLOOR,
    LENGTHS,
    MIDDLE_HEIGHT,
    MM,
    PROBE_M,
    AnyGear,
    FloorShape,
    Height,
    Length,
    LengthAcross,
    PlaceOnFace,
    axial_m,
    height_m_of,
    read_m,
    size_that_adds_nothing,
)
from siggen.damage.growth import Growth
from siggen.damage.on_flank import FLOORS, OnFlank
from siggen.damage.outlines import Outline, rectangle
from siggen.damage.part import Damage, Parts
from siggen.errors import Problem
from siggen.gears.gear_pair import GearPair
from siggen.keys.drawing import corners, draw
from siggen.keys.number import LOW, bounds, constant
from siggen.keys.section import Section
from siggen.keys.teeth import DAMAGED_TEETH, Teeth
from siggen.names import PINION, Side


@dataclass(frozen=True, slots=True)
class FlankSpall(OnFlank):
    """One spall of any outline.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    outline : Ellipse or Polygon
        On the flank's plane of height and face.
    depth_m : float
        Depth normal to the tooth's centre plane [m]; of a dish at its deepest.
    floor : str
        'flat'; 'dish': an ellipse's is half an ellipsoid, a polygon's is half an elliptic cylinder with its axis
        across the face, depth sqrt(1 - u^2) with u = -1 and 1 at the polygon's lowest and highest point: like the
        flank that rolls over it, such a floor is curved along the profile and straight across the face.
    """

    gear: Side
    tooth: int
    outline: Outline
    depth_m: float
    floor: str = "flat"

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "spall"

    @property
    def floors(self) -> tuple[str, ...]:
        """Floors that a spall can have."""
        return FLOORS


# One spall: outline, place, lengths and depth as a user writes them, and the spall on the flank of a drawn gear.


class SpallSize(Section):
    """Outline, place and depth of one spall."""

    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    centre_height_mm: Height = Field(default="pitch", description=MIDDLE_HEIGHT)
    face_centre_mm: PlaceOnFace = Field(default=None, description=FACE_CENTRE)
    face_length_mm: LengthAcross = Field(description=LENGTHS)
    profile_length_mm: Length = Field(description=LENGTHS)
    depth_mm: Length = Field(description=DEPTH)
    floor: FloorShape = Field(default="flat", description=FLOOR)

    def parallel(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether its edges are parallel to the axis, and whether it may then go through the face."""
        return True, bounds(self.face_length_mm)[1] >= face_width_mm


SIZE_KEYS = ("face_length_mm", "profile_length_mm", "depth_mm")
SPALL_KEYS = {
    "height_m": "centre_height_mm",
    "face_m": "face_centre_mm",
    "depth_m": "depth_mm",
}
"""Key of the configuration that a problem of a spall is about."""


def spall_on_tooth(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> FlankSpall:
    """Return a drawn spall on one tooth.

    Parameters
    ----------
    pair : GearPair
    size : SpallSize
        Without distributions.
    reading : str
        How its heights and its profile length are measured: 'axial' or 'arc'.
    tooth : int

    Raises
    ------
    TypeError
        If a number is still a distribution.
    """
    return FlankSpall(Side(size.gear), tooth, _outline(pair, size, reading), MM * constant(size.depth_mm), size.floor)


def _outline(pair: GearPair, size: SpallSize, reading: str) -> Outline:
    gear = pair.member(Side(size.gear))
    centre = size.centre_height_mm
    middle = height_m_of(pair, Side(size.gear), centre if isinstance(centre, str) else constant(centre), reading)
    along = read_m(gear, middle, reading)
    half = 0.5 * MM * constant(size.profile_length_mm)
    heights = axial_m(gear, along - half, reading), axial_m(gear, along + half, reading)
    face = 0.5 * pair.face_width_m if size.face_centre_mm is None else MM * constant(size.face_centre_mm)
    across = 0.5 * MM * constant(size.face_length_mm)
    return rectangle(heights, (face - across, face + across))


def spall_problems(pair: GearPair, size: SpallSize, reading: str) -> Iterator[Problem]:
    """Yield what is wrong with a spall by itself, at every combination of its bounds."""
    for corner in corners(partial(draw, size, path="")):
        spall = spall_on_tooth(pair, corner, reading, 0)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = SPALL_KEYS.get(problem.name, "profile_length_mm")
                yield Problem(key, problem.received, f"allowed: {problem.allowed}")


def largest_spall(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> FlankSpall:
    """Return a spall with all its sizes at their upper and its place at its lower bounds, without depth to speak of."""
    largest = size.model_copy(update={key: bounds(getattr(size, key))[1] for key in SIZE_KEYS})
    spall = spall_on_tooth(pair, draw(largest, lambda _: LOW, ""), reading, tooth)
    return replace(spall, depth_m=PROBE_M)


# Spalls of a state: one on each damaged tooth.


class Spalls(SpallSize, Fault):
    """A spall on each damaged tooth."""

    words: ClassVar[tuple[str, ...]] = ("spalling",)
    outranked: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "spalls"

    kind: Literal["spall"] = "spall"
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return the size that is smaller, for spalls in no direction larger than the milder ones at the same place."""
        return size_that_adds_nothing(self, milder, SIZE_KEYS)

    def drawn(self, growth: Growth) -> Parts:
        """Return a spall on each damaged tooth, with the draws of the first spall that it has grown from."""
        return tuple(self._on_tooth(growth, tooth) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with a spall by itself."""
        return spall_problems(pair, self, ARC)

    def widest(self, pair: GearPair) -> Damage:
        """Return the largest spall."""
        return (largest_spall(pair, self, ARC, 0),)

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether it is a rectangle, and whether it may go through the face."""
        return self.parallel(face_width_mm)

    def _on_tooth(self, growth: Growth, tooth: int) -> FlankSpall:
        uniform, name = growth.place(self.gear, Spalls), f"spall.{self.gear}.{tooth}"
        return spall_on_tooth(growth.pair, draw(self, uniform, name), ARC, tooth)
