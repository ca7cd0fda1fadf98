"""Section `dynamics.shafts`: shafts that bend, so that the gears tilt; used by the model casing alone."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from siggen.keys.number import Number, Within
from siggen.keys.section import Section


class Shaft(Section):
    """A round steel shaft of one diameter on two bearings, with its gear between them."""

    bearing_span_mm: Annotated[Number, Within(above=0, most=2000)] = Field(
        default=100.0, description="distance of the bearings"
    )
    gear_position: Annotated[Number, Within(above=0, below=1)] = Field(
        default=0.5, description="middle of the gear from one bearing, as a share of the span"
    )
    diameter_mm: Annotated[Number, Within(least=5)] = Field(default=25.0, description="of the shaft")


class Shafts(Section):
    """Shafts of both gears; bearing stiffnesses of `dynamics.pinion` and `dynamics.gear` are those of both bearings."""

    pinion: Shaft = Field(default=Shaft(), description="shaft of the pinion")
    gear: Shaft = Field(default=Shaft(), description="shaft of the gear")
