"""Irregular spalls of a state: skewed and wavy edges, a rough floor; one on each damaged tooth, growing with the state.

Ranges that no source gives are assumed: skews up to a few tenths of the length per 10 mm of face, waviness of 5 to 20 %
of the length, edge radii of 0.02 to 0.2 mm, depths from the depth of the largest shear stress (0.3 to 0.8 Hertz half
widths) to several tenths of a millimetre.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Literal

from pydantic import Field, model_validator

from siggen.config.damage_section import DamageSection
from siggen.errors import Problem
from siggen.keys.distributions import Uniform
from siggen.keys.number import Number, Within, bounds
from siggen.keys.places import DAMAGED_GEAR, READING, AnyGear, HeightReading, Length, PlaceOnFace
from siggen.keys.problems import MISSING, refusal
from siggen.keys.teeth import DAMAGED_TEETH, STAGES, Stages, Teeth, refuse_stages

START: Literal["below_pitch"] = "below_pitch"
Middle = Annotated[Number | Literal["below_pitch", "pitch"], Within(least=0, words=(START, "pitch"))]
Skew = Annotated[Number, Within(least=-5, most=5)]
OptionalLength = Annotated[Number | None, Within(above=0, words=(None,))]
Share = Annotated[Number | None, Within(above=0, most=1, words=(None,))]


class IrregularSpalls(DamageSection):
    """An irregular spall on each damaged tooth; drawn once, so that a more severe state holds the milder one."""

    kind: Literal["irregular"] = "irregular"
    gear: AnyGear = Field(default="pinion", description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    stages: Stages = Field(default=1.0, description=STAGES)
    centre_height_mm: Middle = Field(
        default=START,
        description="height of the middle above the base circle; pitch; or below_pitch: half way along the flank from "
        "the lowest point of single contact to the pitch line, where the full load meets negative sliding",
    )
    height_reading: HeightReading = Field(default="arc", description=f"{READING}; so are lengths along the profile")
    profile_length_mm: Length = Field(description="mean length along the profile")
    face_length_mm: OptionalLength = Field(default=None, description="length across the face; or face_share")
    face_share: Share = Field(default=None, description="length across the face over the face width; or face_length_mm")
    face_centre_mm: PlaceOnFace = Field(default=None, description="middle across the face; null: of the face")
    leading_skew_mm_per_10mm: Skew = Field(
        default=Uniform(low=-0.15, high=0.15),
        description="rise of the edge that the contact reaches first (lower on the pinion, upper on the gear) towards "
        "the tip over 10 mm of face, in mm of arc; the default is assumed",
    )
    trailing_skew_mm_per_10mm: Skew = Field(
        default=Uniform(low=-0.15, high=0.15), description="the same of the other edge; the default is assumed"
    )
    waviness: Annotated[Number, Within(least=0, most=0.2)] = Field(
        default=0.1, description="rms of either edge's waves over the profile length; the default is assumed"
    )
    waviness_length_mm: OptionalLength = Field(
        default=None,
        description="distance across the face over which the waves' correlation falls to 1/e; null: a tenth of the "
        "face width, assumed",
    )
    edge_radius_mm: Annotated[Number, Within(least=0, most=1)] = Field(
        default=Uniform(low=0.02, high=0.2), description="radius of the edges; the default is assumed"
    )
    depth_mm: OptionalLength = Field(
        default=None, description="depth normal to the tooth's middle plane; null: grows with the area (depth_share)"
    )
    depth_share: Annotated[Number, Within(above=0, most=0.5)] = Field(
        default=0.05, description="depth over the root of profile length x face length; the default is assumed"
    )
    floor: Literal["dish", "flat"] = Field(default="dish", description="dish: deepest half way between its ends")
    floor_roughness: Annotated[Number, Within(least=0, most=0.5)] = Field(
        default=0.15, description="rms of the depth from strip to strip across the face, over it; assumed"
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> IrregularSpalls:
        lengths = {"face_length_mm": self.face_length_mm, "face_share": self.face_share}
        given = [key for key, value in lengths.items() if value is not None]
        if not given:
            allowed = "an irregular spall needs face_length_mm or face_share"
            raise refusal([Problem("face_length_mm", MISSING, allowed)])
        if len(given) == 2:
            raise refusal([Problem("face_share", "a value, beside face_length_mm", "allowed: one of the two")])
        if self.depth_mm is not None and self.depth_share != 0.05:
            allowed = "allowed: nothing beside depth_mm, which it would compute"
            raise refusal([Problem("depth_share", "a value", allowed)])
        return self

    @model_validator(mode="after")
    def _a_stage_for_each_tooth(self) -> IrregularSpalls:
        refuse_stages(self.stages, self.teeth)
        return self

    @classmethod
    def default_fault(cls, read: Callable[[str], object]) -> str:  # noqa: ARG003
        """Return spalling."""
        return "spalling"

    @property
    def has_spalls(self) -> bool:
        """A spall it is."""
        return True

    @property
    def drawn_edges(self) -> bool:
        """Each has an edge radius of its own."""
        return True

    def parallel_edges(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether nothing bends its edges, and whether it then may go through the face."""
        straight = all(bounds(number) == (0.0, 0.0) for number in self._bending())
        share = None if self.face_share is None else bounds(self.face_share)[1] * face_width_mm
        length = share if self.face_length_mm is None else bounds(self.face_length_mm)[1]
        return straight, straight and length is not None and length >= face_width_mm

    def _bending(self) -> Iterator[Number]:
        yield from (self.leading_skew_mm_per_10mm, self.trailing_skew_mm_per_10mm, self.waviness)
