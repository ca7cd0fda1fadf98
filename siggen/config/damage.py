"""Damage of a state: layers or a cluster of pits, spalls, or both listed one by one (pits: paper A, section 2.1).

Sizes are those of one pit: an ellipse on the flank with semi-axes across the face and along the profile, and a depth.
A distribution of a size is drawn once per pit or spall.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal, TypeAlias, get_args

from pydantic import Field, model_validator

from siggen.config.damage_section import DamageSection, HitTeeth
from siggen.config.irregular import IrregularSpalls
from siggen.config.spall import ListedSpall, Spalls
from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.places import DAMAGED_GEAR, READING, AnyGear, GearName, Height, HeightReading, Length, PlaceOnFace
from siggen.keys.problems import refusal
from siggen.keys.section import Section, Whole
from siggen.keys.teeth import DAMAGED_TEETH, Teeth
from siggen.keys.wording import AllowedText


class PitSize(Section):
    """Size and floor of a pit."""

    semi_axis_face_mm: Length = Field(description="half the length across the face")
    semi_axis_profile_mm: Length = Field(description="half the length along the profile")
    depth_mm: Length = Field(description="depth normal to the tooth's middle plane")
    floor: Literal["flat", "dish"] = Field(
        default="flat", description="flat floor, or a dish that is deepest in the middle"
    )


class LayeredPits(PitSize, DamageSection):
    """Rows of equal count, one above the other, as in paper A."""

    kind: Literal["layered"] = "layered"
    gear: AnyGear = Field(default="pinion", description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    layers: Annotated[Whole, Field(ge=1, le=1000)] = Field(description="rows of pits")
    pits_per_layer: Annotated[Whole, Field(ge=1, le=1000)] = Field(description="pits in a row, across the face")
    first_height_mm: Height = Field(default="pitch", description="height of the first row above the base circle")
    height_reading: HeightReading = Field(default="axial", description=READING)
    spacing_face_mm: Length = Field(default=1.0, description="between pits of a row")
    spacing_profile_mm: Length = Field(default=0.4, description="between rows")
    jitter_mm: Annotated[Number, Within(least=0)] = Field(
        default=0.0, description="every pit is moved by up to this, along both directions"
    )
    face_centre_mm: PlaceOnFace = Field(
        default=None, description="middle of the rows across the face; null: of the face"
    )

    def key_that_adds_nothing(self, milder: DamageSection) -> str | None:
        """Return 'layers' for no more layers nor pits than the milder state has on the same teeth."""
        if not isinstance(milder, LayeredPits) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "layers" if self.layers <= milder.layers and self.pits_per_layer <= milder.pits_per_layer else None


class ClusteredPits(PitSize, DamageSection):
    """Pits scattered around a height."""

    kind: Literal["clustered"] = "clustered"
    gear: AnyGear = Field(default="pinion", description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    count: Annotated[Whole, Field(ge=1, le=10_000)] = Field(description="pits")
    centre_height_mm: Height = Field(default="pitch", description="height above the base circle around which they lie")
    height_reading: HeightReading = Field(default="axial", description=READING)
    spread_profile_mm: Length = Field(description="standard deviation of the heights")
    spread_face_mm: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=None, description="standard deviation across the face about its middle; null: evenly over the face"
    )

    def key_that_adds_nothing(self, milder: DamageSection) -> str | None:
        """Return 'count' for no more pits than the milder state has on the same teeth."""
        if not isinstance(milder, ClusteredPits) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "count" if self.count <= milder.count else None


class ListedPit(PitSize):
    """One pit at a given place."""

    gear: GearName = Field(default="pinion", description="damaged gear")
    tooth: Annotated[Whole, Field(ge=0)] = Field(default=0, description="index of the tooth, from 0")
    height_mm: Height = Field(default="pitch", description="height of the centre above the base circle")
    face_mm: Annotated[Number, Within(least=0)] = Field(description="centre across the face, from one end of the tooth")


class ListedPits(DamageSection):
    """Pits and spalls one by one."""

    kind: Literal["list"] = "list"
    height_reading: HeightReading = Field(default="axial", description=READING)
    pits: tuple[ListedPit, ...] = Field(default=(), description="the pits")
    spalls: tuple[ListedSpall, ...] = Field(default=(), description="the spalls")

    @model_validator(mode="after")
    def _not_empty(self) -> ListedPits:
        if not (self.pits or self.spalls):
            raise refusal([Problem("pits", "no pits and no spalls", "allowed: at least 1 pit or spall")])
        return self

    @classmethod
    def default_fault(cls, read: Callable[[str], object]) -> str:
        """Return spalling for a list of spalls alone."""
        return "spalling" if read("spalls") and not read("pits") else "pitting"

    @property
    def has_spalls(self) -> bool:
        """Whether a spall is listed."""
        return bool(self.spalls)

    @property
    def may_be_pitting(self) -> bool:
        """Whatever is listed may be called pitting."""
        return True

    def hit_teeth(self) -> HitTeeth:
        """Yield every listed tooth."""
        yield from ((f"pits.{number}.tooth", pit.gear, (pit.tooth,)) for number, pit in enumerate(self.pits))
        yield from ((f"spalls.{number}.tooth", spall.gear, (spall.tooth,)) for number, spall in enumerate(self.spalls))

    def parallel_edges(self, face_width_mm: float) -> tuple[bool, bool]:
        """Return whether all listed spalls are rectangles, and whether one may go through the face."""
        found = [spall.parallel(face_width_mm) for spall in self.spalls]
        return bool(found) and all(parallel for parallel, _ in found), any(through for _, through in found)


DamageModel: TypeAlias = LayeredPits | ClusteredPits | Spalls | ListedPits | IrregularSpalls

KINDS: dict[str, type[DamageSection]] = {
    get_args(model.model_fields["kind"].annotation)[0]: model for model in get_args(DamageModel)
}
"""Kind -> section, in the order of the union."""

DAMAGE = AllowedText("null, or a mapping with kind: {} or {}".format(", ".join([*KINDS][:-1]), [*KINDS][-1]))
