"""One spall: outline, place, lengths and depth as a user writes them, and the spall on the flank of a drawn gear.

Which keys a spall needs follows from its shape and its depth law; the others are refused, so that no key is without
effect.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from siggen.errors import Problem, counted
from siggen.faults.flank_place import (
    DAMAGED_GEAR,
    FACE_WIDTH,
    MM,
    MODULE,
    PROBE_M,
    AnyGear,
    Height,
    OptionalLength,
    OptionalLengthAcross,
    PlaceOnFace,
    allowed_text,
    axial_m,
    height_m_of,
    in_mm,
    read_m,
)
from siggen.gears.damage.flank_damage import damage_problems
from siggen.gears.damage.outlines import Ellipse, Outline, Polygon, rectangle, v_outline
from siggen.gears.damage.spall import Spall, length_squared_depth_m
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.drawing import corners
from siggen.keys.number import Number, Within, bounds, constant
from siggen.keys.problems import MISSING, refusal
from siggen.keys.scaling import Grows
from siggen.keys.section import Real, Section

Shape: TypeAlias = Literal["rectangle", "ellipse", "v", "polygon"]
DepthLaw: TypeAlias = Literal["flat", "dish", "length_squared"]
OptionalWidth = Annotated[Number | None, Within(least=0, words=(None,)), Grows(FACE_WIDTH)]

SIZES = {
    "rectangle": ("face_length_mm", "profile_length_mm"),
    "ellipse": ("face_length_mm", "profile_length_mm"),
    "v": ("lower_width_mm", "upper_width_mm", "profile_length_mm"),
    "polygon": ("vertices",),
}
"""Keys that each shape needs."""


class Vertex(Section):
    """Corner of a polygon, never drawn."""

    height_mm: Annotated[Real, Field(ge=0), Grows(MODULE)] = Field(description="above the base circle")
    face_mm: Annotated[Real, Grows(FACE_WIDTH)] = Field(
        description="across the face, from one end of the tooth; what lies beyond the face is cut off"
    )


class SpallSize(Section):
    """Outline, place and depth of one spall."""

    gear: AnyGear = Field(default="pinion", description=DAMAGED_GEAR)
    shape: Shape = Field(default="rectangle", description="rectangle, ellipse, v (two widths) or polygon (vertices)")
    centre_height_mm: Height = Field(
        default="pitch",
        description="height of the middle of its profile length above the base circle; not of a polygon",
    )
    face_centre_mm: PlaceOnFace = Field(
        default=None, description="middle across the face; null: of the face; not of a polygon"
    )
    face_length_mm: OptionalLengthAcross = Field(
        default=None, description="length across the face; rectangle and ellipse"
    )
    profile_length_mm: OptionalLength = Field(
        default=None, description="length along the profile, read as height_reading says; not of a polygon"
    )
    lower_width_mm: OptionalWidth = Field(default=None, description="width of a v at its lower end; 0 for a corner")
    upper_width_mm: OptionalWidth = Field(default=None, description="width of a v at its upper end; 0 for a corner")
    vertices: tuple[Vertex, ...] = Field(default=(), description="corners of a polygon in order, at least 3")
    depth_law: DepthLaw = Field(
        default="flat",
        description="flat; dish (depth_mm in the middle); length_squared (flat, coefficient x squared arc length)",
    )
    depth_mm: OptionalLength = Field(default=None, description="depth normal to the tooth's middle plane")
    depth_coefficient_um_per_mm2: Annotated[Number, Within(above=0)] = Field(
        default=16.3, description="of length_squared; 16.3 was measured on spalls 2.3 to 3.8 mm long"
    )

    @model_validator(mode="after")
    def _keys_fit(self) -> SpallSize:
        problems = [*self._size_problems(), *self._depth_problems()]
        if problems:
            raise refusal(problems)
        return self

    def parallel(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether its edges are parallel to the axis, and whether it may then go through the face."""
        if self.shape != "rectangle" or self.face_length_mm is None:
            return False, False
        return True, bounds(self.face_length_mm)[1] >= face_width_mm

    def _size_problems(self) -> Iterator[Problem]:
        needed = SIZES[self.shape]
        for key in dict.fromkeys(key for keys in SIZES.values() for key in keys):
            given = getattr(self, key) not in (None, ())
            if key in needed and not given:
                yield Problem(key, MISSING, f"a spall of shape {self.shape} needs {', '.join(needed)}")
            if key not in needed and given:
                yield Problem(key, "a value", f"allowed: nothing, shape {self.shape} takes {', '.join(needed)}")
        if self.shape == "polygon":
            if 0 < len(self.vertices) < 3:
                yield Problem("vertices", counted(len(self.vertices), "vertex", "vertices"), "allowed: at least 3")
            for key in ("centre_height_mm", "face_centre_mm"):
                if getattr(self, key) not in ("pitch", None):
                    yield Problem(key, "a value", "allowed: nothing, a polygon lies where its vertices are")
        if self.shape == "v" and self.lower_width_mm == 0.0 == self.upper_width_mm:
            yield Problem("upper_width_mm", "0.0, with lower_width_mm 0.0", "allowed: at least one width above 0")

    def _depth_problems(self) -> Iterator[Problem]:
        by_length = self.depth_law == "length_squared"
        if by_length and self.depth_mm is not None:
            allowed = "allowed: nothing, depth_law length_squared takes depth_coefficient_um_per_mm2"
            yield Problem("depth_mm", "a value", allowed)
        if not by_length and self.depth_mm is None:
            yield Problem("depth_mm", MISSING, f"depth_law {self.depth_law} needs depth_mm")
        # The default is no mistake: a written-out configuration names every key.
        if not by_length and self.depth_coefficient_um_per_mm2 != 16.3:
            allowed = f"allowed: nothing, depth_law {self.depth_law} takes depth_mm"
            yield Problem("depth_coefficient_um_per_mm2", "a value", allowed)


SIZE_KEYS = ("face_length_mm", "profile_length_mm", "lower_width_mm", "upper_width_mm", "depth_mm")
SPALL_KEYS = {
    "height_m": "centre_height_mm",
    "face_m": "face_centre_mm",
    "depth_m": "depth_mm",
    "vertices_m": "vertices",
}
"""Key of the configuration that a problem of a spall is about."""


def spall_on_tooth(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> Spall:
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
    gear = pair.member(size.gear)
    outline = _outline(pair, size, reading)
    if size.depth_law == "length_squared":
        # um/mm^2 is 1/m.
        depth_m = length_squared_depth_m(gear, outline, constant(size.depth_coefficient_um_per_mm2))
    else:
        depth_m = MM * _given(size.depth_mm)
    return Spall(size.gear, tooth, outline, depth_m, size.depth_law)


def _outline(pair: GearPair, size: SpallSize, reading: str) -> Outline:
    gear = pair.member(size.gear)
    if size.shape == "polygon":
        vertices = [(axial_m(gear, MM * v.height_mm, reading), MM * v.face_mm) for v in size.vertices]
        return Polygon(tuple(vertices))
    centre = size.centre_height_mm
    middle = height_m_of(pair, size.gear, centre if isinstance(centre, str) else constant(centre), reading)
    along = read_m(gear, middle, reading)
    half = 0.5 * MM * _given(size.profile_length_mm)
    heights = axial_m(gear, along - half, reading), axial_m(gear, along + half, reading)
    face = 0.5 * pair.face_width_m if size.face_centre_mm is None else MM * constant(size.face_centre_mm)
    if size.shape == "v":
        return v_outline(heights, face, MM * _given(size.lower_width_mm), MM * _given(size.upper_width_mm))
    across = 0.5 * MM * _given(size.face_length_mm)
    if size.shape == "rectangle":
        return rectangle(heights, (face - across, face + across))
    # About the centre itself, not the middle of its ends: ellipses of one centre then hold each other.
    return Ellipse(middle, face, across, 0.5 * (heights[1] - heights[0]))


def _given(number: object) -> float:
    if not isinstance(number, float):
        raise TypeError(f"a drawn value was expected, received {number}")
    return number


def spall_problems(pair: GearPair, size: SpallSize, reading: str, prefix: str = "") -> Iterator[Problem]:
    """Yield what is wrong with a spall by itself, at every combination of its bounds."""
    for corner in corners(size):
        spall = spall_on_tooth(pair, corner, reading, 0)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = _spall_key(size, problem.name)
                yield Problem(prefix + key, in_mm(problem.received), allowed_text(problem.allowed))


def _spall_key(size: SpallSize, name: str) -> str:
    if size.shape == "polygon" and name in ("height_m", "face_m"):
        return "vertices"
    if name == "depth_m" and size.depth_law == "length_squared":
        return "depth_coefficient_um_per_mm2"
    return SPALL_KEYS.get(name, "profile_length_mm")


def largest_spall(pair: GearPair, size: SpallSize, reading: str, tooth: int) -> Spall:
    """Return a spall with all its sizes at their upper and its place at its lower bounds, without depth to speak of."""
    sizes = {key: value for key in SIZE_KEYS if (value := getattr(size, key)) is not None}
    largest = size.model_copy(update={key: bounds(value)[1] for key, value in sizes.items()})
    spall = spall_on_tooth(pair, next(corners(largest)), reading, tooth)
    return replace(spall, depth_m=PROBE_M)
