"""One pit: its size as a user writes it, drawn at a place, checked at a place (pits: paper A, section 2.1).

Sizes are those of one pit: an ellipse on the flank with semi-axes across the face and along the profile, and a depth.
A distribution of a size is drawn once per pit.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from pydantic import Field

from siggen.errors import Problem
from siggen.faults.flank_place import (
    DEPTH,
    FLOOR,
    MM,
    PROBE_M,
    FloorShape,
    Length,
    found_problems,
    height_m_of,
)
from siggen.gears.damage.heights import flank_heights
from siggen.gears.damage.pit import FlankPit
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import at, bounds
from siggen.keys.section import Section
from siggen.names import Side

SEMI_AXES = "half the length across the face, and along the profile"


class PitSize(Section):
    """Size and floor of a pit."""

    semi_axis_face_mm: Length = Field(description=SEMI_AXES)
    semi_axis_profile_mm: Length = Field(description=SEMI_AXES)
    depth_mm: Length = Field(description=DEPTH)
    floor: FloorShape = Field(default="flat", description=FLOOR)


@dataclass(frozen=True, slots=True)
class PitPlace:
    """A place where pits of a state may come to lie, and the keys of the configuration that put them there."""

    gear: Side
    height_m: float
    face_m: float
    size: PitSize
    height_key: str
    face_key: str
    depth_key: str
    remark: str = ""


def drawn_pit(
    size: PitSize, gear: Side, pair: GearPair, tooth: int, centre_m: tuple[float, float], rng: np.random.Generator
) -> FlankPit:
    """Return a pit with its own sizes at a height and across the face [m].

    A centre that a random shift took off the flank is put on its edge.
    """
    low, high = flank_heights(pair.member(gear))
    semi_face, semi_profile, depth = (
        MM * at(n, rng.random()) for n in (size.semi_axis_face_mm, size.semi_axis_profile_mm, size.depth_mm)
    )
    return FlankPit(
        gear=gear,
        tooth=tooth,
        height_m=min(max(centre_m[0], low), high),
        face_m=min(max(centre_m[1], 0.0), pair.face_width_m),
        semi_axis_face_m=semi_face,
        semi_axis_profile_m=semi_profile,
        depth_m=depth,
        floor=size.floor,
    )


def pit_place_problems(pair: GearPair, place: PitPlace) -> list[Problem]:
    """Return what is wrong with one place: its height and its place on the face first, then the depth there."""
    middle_m = pair.face_width_m / 2
    at_height = found_problems(pair, (_probe(place, place.height_m, middle_m),), place.height_key, place.remark)
    pitch_m = height_m_of(pair, Side(place.gear), "pitch", "axial")
    at_face = found_problems(pair, (_probe(place, pitch_m, place.face_m),), place.face_key, place.remark)
    if at_height or at_face:
        return [*at_height, *at_face]
    deepest = replace(
        _probe(place, place.height_m, middle_m),
        semi_axis_profile_m=bounds(place.size.semi_axis_profile_mm)[1] / 1e3,
        depth_m=bounds(place.size.depth_mm)[1] / 1e3,
    )
    return found_problems(pair, (deepest,), place.depth_key, place.remark)


def _probe(place: PitPlace, height_m: float, face_m: float) -> FlankPit:
    return FlankPit(Side(place.gear), 0, height_m, face_m, PROBE_M, PROBE_M, PROBE_M, place.size.floor)


def largest_pit(gear: Side, tooth: int, height_m: float, face_m: float, size: PitSize) -> FlankPit:
    """Return a pit with its sizes at their upper bounds, without depth to speak of."""
    across_m, along_m = bounds(size.semi_axis_face_mm)[1] / 1e3, bounds(size.semi_axis_profile_mm)[1] / 1e3
    return FlankPit(gear, tooth, height_m, face_m, across_m, along_m, PROBE_M, size.floor)
