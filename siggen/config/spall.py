"""Spalls of a state: outline, place, lengths and depth; one on each damaged tooth, or listed one by one.

Which keys a spall needs follows from its shape and its depth law; the others are refused, so that no key is without
effect.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Literal, TypeAlias

from pydantic import Field, model_validator

from siggen.config.damage_section import DamageSection
from siggen.errors import Problem, counted
from siggen.keys.number import Number, Within, bounds
from siggen.keys.places import DAMAGED_GEAR, READING, AnyGear, GearName, Height, HeightReading, Length, PlaceOnFace
from siggen.keys.problems import MISSING, refusal
from siggen.keys.section import Real, Section, Whole
from siggen.keys.teeth import DAMAGED_TEETH, STAGES, Stages, Teeth, refuse_stages

Shape: TypeAlias = Literal["rectangle", "ellipse", "v", "polygon"]
DepthLaw: TypeAlias = Literal["flat", "dish", "length_squared"]
OptionalLength = Annotated[Number | None, Within(above=0, words=(None,))]
OptionalWidth = Annotated[Number | None, Within(least=0, words=(None,))]

SIZES = {
    "rectangle": ("face_length_mm", "profile_length_mm"),
    "ellipse": ("face_length_mm", "profile_length_mm"),
    "v": ("lower_width_mm", "upper_width_mm", "profile_length_mm"),
    "polygon": ("vertices",),
}
"""Keys that each shape needs."""


class Vertex(Section):
    """Corner of a polygon, never drawn."""

    height_mm: Annotated[Real, Field(ge=0)] = Field(description="above the base circle")
    face_mm: Real = Field(
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
    face_length_mm: OptionalLength = Field(default=None, description="length across the face; rectangle and ellipse")
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
    depth_coefficient_um_per_mm2: Length = Field(
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


class Spalls(SpallSize, DamageSection):
    """A spall on each damaged tooth."""

    kind: Literal["spall"] = "spall"
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    height_reading: HeightReading = Field(default="arc", description=f"{READING}; so are lengths along the profile")
    stages: Stages = Field(default=1.0, description=f"{STAGES}; not of a polygon")

    @model_validator(mode="after")
    def _a_stage_for_each_tooth(self) -> Spalls:
        refuse_stages(self.stages, self.teeth)
        if self.shape == "polygon" and self.stages != 1.0:
            raise refusal([Problem("stages", "a value", "allowed: nothing, a polygon is as large as its vertices say")])
        return self

    @classmethod
    def default_fault(cls, read: Callable[[str], object]) -> str:  # noqa: ARG003
        """Return spalling."""
        return "spalling"

    @property
    def has_spalls(self) -> bool:
        """A spall it is."""
        return True

    def parallel_edges(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether it is a rectangle, and whether it may go through the face."""
        return self.parallel(face_width_mm)


class ListedSpall(SpallSize):
    """One spall at a given place."""

    gear: GearName = Field(default="pinion", description="damaged gear")
    tooth: Annotated[Whole, Field(ge=0)] = Field(default=0, description="index of the tooth, from 0")
