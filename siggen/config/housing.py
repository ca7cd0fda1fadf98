"""Section `housing`: the body between bearings, ground and sensors; used by `dynamics.model: casing`.

`kind: plates` is drawn from its geometry and gives way; `kind: modal` gives way as the modes of a file say; `kind:
rigid` is a block of given mass on bolts.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Discriminator, Field, model_validator

from siggen.errors import Problem
from siggen.keys.distributions import LogUniform
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Position, Section
from siggen.keys.usual import Usual

Length = Annotated[Number | None, Within(above=0, most=10_000, words=(None,))]
INSIDE = (
    "inside, across, upright, along the shafts; null: in centre distances, 0.10 to 0.26 clear at either end, "
    "0.15 to 0.31 above, a sump of 0.26 to 0.62; width by the bearings"
)
EACH = "of each, horizontal (shear) and vertical (axial)"
FOOT = "what one foot has left of its stiffness: beside the driver, behind, or the first bolt of a rigid housing"


class PlateHousing(Section):
    """A box of six plates round the gears, with bearing seats, ribs and bolts; modes follow from its geometry."""

    understood_kind: ClassVar[bool] = True

    kind: Literal["plates"] = Field(default="plates", description="a box that gives way")
    material: Literal["any", "grey_iron", "steel"] = Field(
        default="any", description="cast or welded; any: three of five gearboxes are cast"
    )
    length_mm: Length = Field(default=None, description=INSIDE)
    height_mm: Length = Field(default=None, description=INSIDE)
    width_mm: Length = Field(default=None, description=INSIDE)
    wall_mm: Length = Field(
        default=None,
        description="of the plates with the bearings; null: 1.1 to 3 times 3 mm + 0.025 centre distances, "
        "welded 1.5 to 4.6 times",
    )
    damping_ratio: Annotated[Number, Within(above=0, below=0.5), Usual(0.0005, 0.2)] = Field(
        default=LogUniform(low=0.003, high=0.05), description="of the plates, drawn for each mode"
    )
    loose_foot_share: Annotated[Number, Within(above=0, most=1), Usual(0.01, 1)] = Field(default=1.0, description=FOOT)


class BoltsSection(Section):
    """The bolts between casing and ground, all alike but for a loose one."""

    shear_stiffness_n_per_m: Annotated[Number, Within(above=0)] = Field(default=8e7, description=EACH)
    axial_stiffness_n_per_m: Annotated[Number, Within(above=0)] = Field(default=1.5e8, description=EACH)
    damping_ratio: Annotated[Number, Within(least=0, below=1), Usual(0.002, 0.5)] = Field(
        default=0.04, description="of a bolt that carries its share of the casing's mass"
    )
    positions_mm: Annotated[tuple[Position, ...], Field(min_length=2)] = Field(
        default=((90.0, 0.0), (90.0, 0.0), (-90.0, 0.0), (-90.0, 0.0)),
        description="[horizontal, vertical] of each from the centre of gravity",
    )

    @model_validator(mode="after")
    def _support(self) -> BoltsSection:
        if len(set(self.positions_mm)) < 2:
            received = f"all bolts at {list(self.positions_mm[0])}"
            allowed = "allowed: at least two different places; about a single one the casing would turn freely"
            raise refusal([Problem("positions_mm", received, allowed)])
        return self


class RigidHousing(Section):
    """A rigid casing that carries the bearings: two translations and rocking."""

    kind: Literal["rigid"] = Field(description="a block that moves on its bolts")
    mass_kg: Annotated[Number, Within(above=0)] = Field(default=20.0, description="without the gears and shafts")
    inertia_kg_m2: Annotated[Number | None, Within(above=0, words=(None,))] = Field(
        default=0.25,
        description="about its centre of gravity; null: a radius of gyration of 1.15 centre distances, or of "
        "a planetary rim (derived)",
    )
    bolts: BoltsSection = Field(default=BoltsSection(), description="between casing and ground")
    loose_foot_share: Annotated[Number, Within(above=0, most=1), Usual(0.01, 1)] = Field(default=1.0, description=FOOT)


class ModalHousing(Section):
    """A housing by natural modes from finite elements or a modal test; all gearboxes have the same."""

    kind: Literal["modal"] = Field(description="a body whose modes are known")
    modes: str = Field(description="CSV file from the folder of the configuration, a line per mode")


def with_kind(section: Any) -> Any:
    """Return the section with its kind."""
    return {"kind": "plates", **section} if isinstance(section, Mapping) else section


Housing = Annotated[PlateHousing | ModalHousing | RigidHousing, Discriminator("kind"), BeforeValidator(with_kind)]
