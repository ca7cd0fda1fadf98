"""Irregular spalls of a state: skewed and wavy edges, a rough floor; one on each damaged tooth, growing with the state.

Ranges that no source gives are assumed: skews up to a few tenths of the length per 10 mm of face, waviness of 5 to 20 %
of the length, edge radii of 0.02 to 0.2 mm, depths from the depth of the largest shear stress (0.3 to 0.8 Hertz half
widths) to several tenths of a millimetre.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field, model_validator

from siggen.arrays import FloatArray
from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import (
    DAMAGED_GEAR,
    DEPTH,
    FACE_CENTRE,
    FLOOR,
    MIDDLE_HEIGHT,
    MM,
    MODULE,
    PROBE_M,
    PROFILE_LENGTH,
    READING,
    SKEW,
    AnyGear,
    FloorShape,
    HeightReading,
    Length,
    OptionalLength,
    PlaceOnFace,
    axial_heights_m,
    axial_m,
    height_m_of,
    read_m,
    size_that_adds_nothing,
)
from siggen.faults.growth import Growth
from siggen.gears.damage.flank_damage import single_problems
from siggen.gears.damage.heights import flank_heights, initiation_height_m
from siggen.gears.damage.irregular import STRIPS, WAVE_LIMIT, IrregularSpall, drawn_waves, grown_spall, stations_across
from siggen.gears.damage.outlines import rectangle
from siggen.gears.damage.part import Parts
from siggen.gears.damage.spall import FlankSpall
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import draw
from siggen.keys.number import Number, Within, at, bounds, constant, number_text
from siggen.keys.scaling import Grows
from siggen.keys.teeth import DAMAGED_TEETH, STAGES, Stages, Teeth, refuse_stages, stage_of
from siggen.keys.usual import Usual
from siggen.names import PINION, Side

FLOOR_ROUGHNESS = 0.15
"""Rms of the depth from strip to strip across the face, over it (assumed)."""
PER_10MM = 0.1
"""mm of arc per 10 mm of face as a slope."""
WAVE_SHARE = 0.1
"""Distance across the face, over its width, in which the correlation of the waves falls to 1/e; assumed."""
DEPTH_SHARE = 0.05
"""Depth over the root of profile length x face length, where none is given; assumed."""

SIZES = ("profile_length_mm", "face_share", "depth_mm")
START: Literal["below_pitch"] = "below_pitch"
Middle = Annotated[Number | Literal["below_pitch", "pitch"], Within(least=0, words=(START, "pitch")), Grows(MODULE)]
Skew = Annotated[Number, Within(least=-5, most=5), Usual(0.005, 5), Grows(SKEW)]
Share = Annotated[Number, Within(above=0, most=1), Usual(0.01, 1)]


class IrregularSpalls(Fault):
    """An irregular spall on each damaged tooth; drawn once, so that a more severe state holds the milder one."""

    words: ClassVar[tuple[str, ...]] = ("spalling",)
    outranked: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "spalls"

    kind: Literal["irregular"] = "irregular"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    stages: Stages = Field(default=1.0, description=STAGES)
    centre_height_mm: Middle = Field(
        default=START,
        description=MIDDLE_HEIGHT,
    )
    height_reading: HeightReading = Field(default="arc", description=READING)
    profile_length_mm: Length = Field(description=PROFILE_LENGTH)
    face_share: Share = Field(description="length across the face over the face width")
    face_centre_mm: PlaceOnFace = Field(default=None, description=FACE_CENTRE)
    skew_mm_per_10mm: Skew = Field(
        default=Uniform(low=-0.15, high=0.15),
        description="rise of an edge towards the tip over 10 mm of face, in mm of arc, drawn for each edge by itself; "
        "the default is assumed",
    )
    waviness: Annotated[Number, Within(least=0, most=0.2), Usual(0.002, 0.2)] = Field(
        default=0.1, description="rms of either edge's waves over the profile length; the default is assumed"
    )
    edge_radius_mm: Annotated[Number, Within(least=0, most=1), Usual(0.002, 1), Grows(MODULE)] = Field(
        default=Uniform(low=0.02, high=0.2), description="radius of the edges; the default is assumed"
    )
    depth_mm: OptionalLength = Field(
        default=None,
        description=DEPTH,
    )
    floor: FloorShape = Field(default="dish", description=FLOOR)

    @model_validator(mode="after")
    def _a_stage_for_each_tooth(self) -> IrregularSpalls:
        refuse_stages(self.stages, self.teeth)
        return self

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return the size that is smaller, for spalls in no direction larger than the milder ones at the same place."""
        return size_that_adds_nothing(self, milder, SIZES)

    def drawn(self, growth: Growth) -> Parts:
        """Return a spall on each damaged tooth, with the draws of the first one that it has grown from."""
        return tuple(_on_tooth(self, growth, tooth, index) for index, tooth in enumerate(growth.teeth(self)))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong at the bounds, whatever the waves turn out to be: they never go beyond `WAVE_LIMIT`."""
        return _problems(pair, self)

    def widest(self, pair: GearPair) -> Damage:
        """Return a rectangle as long as the longest spall: on the safe side, since skewed edges leave land earlier."""
        gear, across = pair.member(self.side), MM * _longest_face_mm(self, pair.face_width_m / MM)
        middle = 0.5 * pair.face_width_m if self.face_centre_mm is None else MM * bounds(self.face_centre_mm)[0]
        along = read_m(gear, _heights_m(pair, self)[0], self.height_reading)
        half = 0.5 * MM * bounds(self.profile_length_mm)[1]
        heights = axial_m(gear, along - half, self.height_reading), axial_m(gear, along + half, self.height_reading)
        return (FlankSpall(self.side, 0, rectangle(heights, (middle - 0.5 * across, middle + 0.5 * across)), PROBE_M),)

    @property
    def own_edge_radius(self) -> tuple[str, Number]:
        """Each has one."""
        return "edge_radius_mm", self.edge_radius_mm

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool]:  # noqa: ARG002 - its share is given
        """Return whether nothing bends its edges, and whether it then may go through the face."""
        straight = all(bounds(number) == (0.0, 0.0) for number in self._bending())
        return straight, straight and bounds(self.face_share)[1] >= 1.0

    def _bending(self) -> Iterator[Number]:
        yield from (self.skew_mm_per_10mm, self.waviness)


def _on_tooth(model: IrregularSpalls, growth: Growth, tooth: int, index: int) -> IrregularSpall:
    pair, name = growth.pair, f"irregular.{model.gear}.{tooth}"
    uniform = growth.place(model.gear, IrregularSpalls)
    size = _staged(draw(model, uniform, name), at(stage_of(model.stages, index), uniform(f"{name}.stages")))
    gear, width = pair.member(Side(model.gear)), pair.face_width_m
    length, across = MM * constant(size.profile_length_mm), width * constant(size.face_share)
    middle = 0.5 * width if size.face_centre_mm is None else MM * constant(size.face_centre_mm)
    milder = _milder(growth, model.gear, tooth)
    face = stations_across(width, middle - 0.5 * across, middle + 0.5 * across, milder)
    along = read_m(gear, _middle_height_m(pair, size), size.height_reading)

    def slope(edge: str) -> float:
        return PER_10MM * at(model.skew_mm_per_10mm, uniform(f"{name}.{edge}_skew_mm_per_10mm"))

    arcs = [
        along + side * (0.5 * length) + (slope(edge) * (face - middle) + _waves_m(size, growth, f"{name}.{edge}", face))
        for side, edge in zip((-1.0, 1.0), _edges(model.gear), strict=True)
    ]
    edges = [axial_heights_m(gear, arc, size.height_reading) for arc in arcs]
    return grown_spall(
        Side(model.gear),
        tooth,
        face,
        (edges[0], edges[1]),
        _depth_m(size, length, across) * _rough(size, growth, name, face, width),
        MM * constant(size.edge_radius_mm),
        size.floor,
        milder,
    )


def _staged(size: IrregularSpalls, stage: float) -> IrregularSpalls:
    """Return drawn sizes at a stage: all lengths shrink alike, and the depth that follows from them."""
    given = {key: value for key in SIZES if (value := getattr(size, key)) is not None}
    return size if stage == 1.0 else size.model_copy(update={key: stage * constant(v) for key, v in given.items()})


def _milder(growth: Growth, gear: str, tooth: int) -> IrregularSpall | None:
    found = [one for one in growth.before if isinstance(one, IrregularSpall) and (one.gear, one.tooth) == (gear, tooth)]
    return found[-1] if found else None


def _edges(gear: str) -> tuple[str, str]:
    """Return which edge is the lower and which the upper one: contact climbs the driving pinion's flank."""
    return ("leading", "trailing") if gear == Side.DRIVER else ("trailing", "leading")


def _middle_height_m(pair: GearPair, size: IrregularSpalls) -> float:
    centre = size.centre_height_mm
    if centre == "below_pitch":
        return initiation_height_m(pair, Side(size.gear))
    return height_m_of(
        pair, Side(size.gear), centre if isinstance(centre, str) else constant(centre), size.height_reading
    )


def _waves_m(size: IrregularSpalls, growth: Growth, name: str, face_m: FloatArray) -> FloatArray:
    """Return how far an edge lies above its straight line by its waves, at stations (k,) [m]."""
    waves = drawn_waves(growth.shape(size.gear, IrregularSpalls, name))
    rms = constant(size.waviness) * MM * constant(size.profile_length_mm)
    return rms * waves(face_m, WAVE_SHARE * growth.pair.face_width_m)


def _depth_m(size: IrregularSpalls, length_m: float, across_m: float) -> float:
    if size.depth_mm is not None:
        return MM * constant(size.depth_mm)
    return DEPTH_SHARE * sqrt(length_m * across_m)


def _rough(size: IrregularSpalls, growth: Growth, name: str, face_m: FloatArray, width_m: float) -> FloatArray:
    """Return the depth of the strips between stations over the mean one (k - 1,): uniform, of the rms asked for."""
    draws = growth.shape(size.gear, IrregularSpalls, f"{name}.floor").random(STRIPS)
    strip = np.clip((0.5 * (face_m[1:] + face_m[:-1]) / width_m * STRIPS).astype(int), 0, STRIPS - 1)
    return np.asarray(1.0 + FLOOR_ROUGHNESS * sqrt(3.0) * (2.0 * draws[strip] - 1.0))


def _problems(pair: GearPair, size: IrregularSpalls) -> Iterator[Problem]:
    """Yield what is wrong at the bounds, whatever the waves turn out to be: they never go beyond `WAVE_LIMIT`.

    A spall at an earlier stage is the same but smaller, and its edges are as far from crossing.
    """
    width_mm = pair.face_width_m / MM
    yield from _face_problems(size, width_mm)
    yield from _edge_problems(pair, size, width_mm)


def _longest_face_mm(size: IrregularSpalls, width_mm: float) -> float:
    """Return the largest length across the face [mm]."""
    return width_mm * bounds(size.face_share)[1]


def _face_problems(size: IrregularSpalls, width_mm: float) -> Iterator[Problem]:
    length_mm = _longest_face_mm(size, width_mm)
    for centre_mm in (0.5 * width_mm,) if size.face_centre_mm is None else bounds(size.face_centre_mm):
        low, high = centre_mm - 0.5 * length_mm, centre_mm + 0.5 * length_mm
        if low < -1e-9 * width_mm or high > width_mm * (1.0 + 1e-9):
            received = f"{length_mm:.6g} mm about {centre_mm:.6g} mm, from {low:.6g} to {high:.6g} mm across the face"
            yield Problem("face_share", received, f"allowed: on the face, 0 to {width_mm:.6g} mm")
            return


def _edge_problems(pair: GearPair, size: IrregularSpalls, width_mm: float) -> Iterator[Problem]:
    across_mm = _longest_face_mm(size, width_mm)
    shortest, longest = bounds(size.profile_length_mm)
    waves = WAVE_LIMIT * bounds(size.waviness)[1]
    least, most = bounds(size.skew_mm_per_10mm)
    apart = most - least
    room = 2.0 * shortest * (1.0 - 2.0 * waves) / (PER_10MM * across_mm)
    if apart >= room:
        key, skew, at_face = "skew_mm_per_10mm", number_text(size.skew_mm_per_10mm), f"{across_mm:.6g} mm of face"
        received, narrower = (
            f"{skew}: the edges of {shortest:.6g} mm cross",
            f"a range of less than {room:.6g} mm per 10 mm",
        )
        if key in size.model_fields_set:
            yield Problem(key, received, f"allowed: {narrower}, over {at_face}")
        else:  # the default, which nobody wrote
            received = f"{number_text(size.profile_length_mm)} mm: over {at_face} its edges, with {key} {skew}, cross"
            allowed = f"allowed: above {shortest * apart / room:.6g} mm, or {key} with {narrower}"
            yield Problem("profile_length_mm", received, allowed)
        return
    reach = 0.5 * PER_10MM * across_mm * max(abs(least), abs(most)) + waves * longest
    yield from _height_problems(pair, size, MM * (0.5 * longest + reach))


def _height_problems(pair: GearPair, size: IrregularSpalls, reach_m: float) -> Iterator[Problem]:
    """Yield a middle or an edge off the flank, else a floor deeper than the tooth allows."""
    gear, reading = pair.member(Side(size.gear)), size.height_reading
    foot, tip = flank_heights(gear)
    ends = [MM * value for value in (read_m(gear, foot, reading) / MM, read_m(gear, tip, reading) / MM)]
    for height in _heights_m(pair, size):
        if not foot <= height <= tip:
            received = f"a middle {height / MM:.6g} mm above the base circle, along the tooth's axis"
            yield Problem("centre_height_mm", received, f"allowed: {foot / MM:.6g} to {tip / MM:.6g} mm, the flank")
            return
        along = read_m(gear, height, reading)
        if along - reach_m < ends[0] or along + reach_m > ends[1]:
            received = f"{number_text(size.profile_length_mm)} mm: with skew and waves the edges reach from "
            received += f"{(along - reach_m) / MM:.4g} to {(along + reach_m) / MM:.4g} mm above the base circle"
            yield Problem(
                "profile_length_mm", received, f"allowed: {ends[0] / MM:.4g} to {ends[1] / MM:.4g} mm, the flank"
            )
            return
        heights = axial_m(gear, along - reach_m, reading), axial_m(gear, along + reach_m, reading)
        spall = FlankSpall(Side(size.gear), 0, rectangle(heights, (0.0, pair.face_width_m)), _deepest_m(pair, size))
        for problem in single_problems(pair, (spall,)):
            if problem.name == "depth_m":
                yield _depth_problem(size, problem.received, f"allowed: {problem.allowed}")
                return


def _depth_problem(size: IrregularSpalls, received: str, allowed: str) -> Problem:
    if size.depth_mm is not None:
        return Problem("depth_mm", f"{number_text(size.depth_mm)} mm: its rough floor reaches {received}", allowed)
    follows = f"a depth of {received} follows from profile and face length ({DEPTH_SHARE:g} of the root of both)"
    return Problem("profile_length_mm", f"{number_text(size.profile_length_mm)} mm: {follows}", f"depth {allowed}")


def _heights_m(pair: GearPair, size: IrregularSpalls) -> list[float]:
    centre = size.centre_height_mm
    values = (centre,) if isinstance(centre, str) else dict.fromkeys(bounds(centre))
    return [_middle_height_m(pair, size.model_copy(update={"centre_height_mm": value})) for value in values]


def _deepest_m(pair: GearPair, size: IrregularSpalls) -> float:
    rough = 1.0 + sqrt(3.0) * FLOOR_ROUGHNESS
    if size.depth_mm is not None:
        return MM * bounds(size.depth_mm)[1] * rough
    area = bounds(size.profile_length_mm)[1] * _longest_face_mm(size, pair.face_width_m / MM)
    return MM * DEPTH_SHARE * sqrt(area) * rough
