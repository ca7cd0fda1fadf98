"""Section `machine`: the drivetrain as shafts, gears and meshes, each with a name of the user's own."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal, TypeAlias

from pydantic import ConfigDict, Field, model_validator

from siggen.config.dynamics import RotorSection
from siggen.config.gears import ToothForm, Wheel
from siggen.errors import Problem
from siggen.keys.by_name import NamedParts, without_key_field
from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal
from siggen.keys.section import Section
from siggen.keys.user_name import PartName
from siggen.keys.usual import Usual

IDLER = "idler"
Span: TypeAlias = Annotated[
    Number | Literal["idler"] | None, Within(above=0, most=2000, words=(IDLER, None)), Usual(5, 3000)
]
Direction: TypeAlias = Annotated[Number, Within(least=-180, most=180)]


class NamedPart(Section):
    """What has a name, for places of sensors, damage, columns, messages and pages."""

    key_field: ClassVar[str] = "name"
    model_config = ConfigDict(json_schema_extra=lambda schema: without_key_field(schema, "name"))

    name: PartName


class MachineShaft(NamedPart, RotorSection):
    """A shaft on two bearings; masses are those of the gear that the shaft in front drives, of the first its own."""

    span_mm: Span = Field(
        default=None,
        description="distance of the bearings of a shaft with two gears, which stand at its thirds; idler: one gear in "
        "two meshes; null: twice both face widths (assumed)",
    )

    @model_validator(mode="after")
    def _bearings_are_given(self) -> MachineShaft:
        if nulls := self.bearing.nulls:
            allowed = "allowed: a number; null follows from a rated torque, which a machine does not read"
            raise refusal([Problem(f"bearing.{key}", "null", allowed) for key in nulls])
        return self


class MachineGear(NamedPart, Wheel):
    """A gear on a shaft."""

    shaft: str = Field(description="name of the shaft that it stands on")


class MachineMesh(NamedPart, ToothForm):
    """A gear that drives another one."""

    driver: str = Field(description="name of the driving gear")
    driven: str = Field(description="name of the driven gear")
    direction_deg: Direction = Field(
        default=0.0,
        description="of the line from the driving to the driven gear against that of the first mesh, in the sense in "
        "which the first shaft turns",
    )


class MachineSection(Section):
    """Shafts, gears and meshes in any order; takes the place of `gears`.

    The motor drives the shaft whose gear none drives, the load hangs on the shaft whose gear drives none.
    """

    shafts: Annotated[
        tuple[MachineShaft, ...],
        Field(min_length=2, max_length=100),
        NamedParts("{input: {}, output: {mass_kg: 6}}, 2 to 100"),
    ] = Field(description="its shafts")
    gears: Annotated[
        tuple[MachineGear, ...],
        Field(min_length=2, max_length=200),
        NamedParts("{ida: {teeth: 18, bore_radius_mm: 12, shaft: input}, otto: {...}}, 2 to 200"),
    ] = Field(description="its gears")
    meshes: Annotated[
        tuple[MachineMesh, ...],
        Field(min_length=1, max_length=100),
        NamedParts("{fast: {driver: ida, driven: otto, module_mm: 2, face_width_mm: 20}}, 1 to 100"),
    ] = Field(description="its meshes")
