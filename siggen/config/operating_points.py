"""Section `operating_points`: speeds and torques at which every state of every specimen is measured."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Section
from siggen.keys.wording import AllowedText


class OperatingRange(Section):
    """Speed and torque of one operating point, drawn per specimen."""

    speed_hz: Annotated[Number, Within(above=0, most=1e5)] = Field(description="rotation of the pinion shaft")
    torque_nm: Annotated[Number, Within(above=0, most=1e8)] = Field(description="torque on the pinion shaft")


OPERATING_POINTS = AllowedText("a list of at least one mapping with speed_hz and torque_nm")
