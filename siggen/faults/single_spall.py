"""One spall: outline, place, lengths and depth as a user writes them, and the spall on the flank of a drawn gear."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from pydantic import Field

from siggen.errors import Problem
from siggen.faults.flank_place import (
    DAMAGED_GEAR,
    DEPTH,
    FACE_CENTRE,
    FLOOR,
    MIDDLE_HEIGHT,
    MM,
    PROBE_M,
    PROFILE_LENGTH,
    AnyGear,
    FloorShape,
    Height,
    Length,
    LengthAcross,
    PlaceOnFace,
    axial_m,
    height_m_of,
    read_m,
)
from siggen.gears.damage.flank_damage import damage_problems
from siggen.gears.damage.outlines import Outline, rectangle
from siggen.gears.damage.spall import FlankSpall
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import corners, draw
from siggen.keys.number import LOW, bounds, constant
from siggen.keys.section import Section
from siggen.names import PINION, Side


class SpallSize(Section):
    """Outline, place and depth of one spall."""

    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    centre_height_mm: Height = Field(default="pitch", description=MIDDLE_HEIGHT)
    face_centre_mm: PlaceOnFace = Field(default=None, description=FACE_CENTRE)
    face_length_mm: LengthAcross = Field(description="length across the face")
    profile_length_mm: Length = Field(description=PROFILE_LENGTH)
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
        How its heights and its profile length are measured: 'axial', 'radial' or 'arc'.
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


def spall_problems(pair: GearPair, size: SpallSize, reading: str, prefix: str = "") -> Iterator[Problem]:
    """Yield what is wrong with a spall by itself, at every combination of its bounds."""
    for corner in corners(partial(draw, size, path="")):
        spall = spall_on_tooth(pair, corner, reading, 0)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = SPALL_KEYS.get(problem.name, "profile_length_mm")
                yield Problem(prefix + key, problem.received, f"allowed: {problem.allowed}")


def largest_spall(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> FlankSpall:
    """Return a spall with all its sizes at their upper and its place at its lower bounds, without depth to speak of."""
    largest = size.model_copy(update={key: bounds(getattr(size, key))[1] for key in SIZE_KEYS})
    spall = spall_on_tooth(pair, draw(largest, lambda _: LOW, ""), reading, tooth)
    return replace(spall, depth_m=PROBE_M)
