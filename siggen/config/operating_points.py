"""Section `operating_points`: speeds and torques at which every state of every specimen is measured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import BeforeValidator, Field, ValidationError

from siggen.keys.number import Number, Within
from siggen.keys.problems import refusal, section_problems
from siggen.keys.section import Section, Whole
from siggen.keys.wording import AllowedText


class OperatingRange(Section):
    """Speed and torque of one operating point, drawn per specimen."""

    speed_hz: Annotated[Number, Within(above=0)] = Field(description="rotation of the pinion shaft")
    torque_nm: Annotated[Number, Within(above=0)] = Field(description="torque on the pinion shaft")


class OperatingGrid(OperatingRange):
    """Several operating points with the same ranges, drawn independently of each other."""

    count: Annotated[Whole, Field(ge=1, le=10_000)] = Field(description="number of operating points per specimen")

    def points(self) -> tuple[OperatingRange, ...]:
        """Return the operating points one by one."""
        return (OperatingRange(speed_hz=self.speed_hz, torque_nm=self.torque_nm),) * self.count


def _listed(value: object) -> object:
    """Turn a mapping with `count` into the list it stands for; leave anything else to validation."""
    if not isinstance(value, Mapping):
        return value
    try:
        return OperatingGrid.model_validate(value).points()
    except ValidationError as error:
        raise refusal(section_problems(OperatingGrid, error.errors())) from None


OperatingRanges = Annotated[
    tuple[OperatingRange, ...],
    Field(min_length=1),
    BeforeValidator(
        _listed, json_schema_input_type=Annotated[list[OperatingRange], Field(min_length=1)] | OperatingGrid
    ),
]

OPERATING_POINTS = AllowedText(
    "a list of at least one mapping with speed_hz and torque_nm, or one mapping that has count too"
)
