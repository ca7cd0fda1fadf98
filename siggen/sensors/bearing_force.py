"""Force washers: what the bearings of a shaft press on their seats with."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.section import Real
from siggen.sensing.inputs import FORCE, Input
from siggen.sensors.places import AT_BEARINGS, PLACE_TEXT, Places
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase


class ForceWasher(SensorBase):
    """Washers under both bearings of a shaft: their force on the housing, mean included."""

    quantity: ClassVar[Quantity] = Quantity("bearing force", "force", "N", "n")
    acts: ClassVar[str] = "Force washers show what both bearings of a shaft press on the housing with, mean included."
    plausible: ClassVar[tuple[float, float, str]] = (10.0, 1e7, "is it in N, not kN?")

    kind: Literal["bearing_force"] = Field(description="force of a shaft's bearings on the housing")
    place: Annotated[str, AT_BEARINGS] = Field(
        default="pinion_bearing",
        description=PLACE_TEXT,
    )
    axes: Annotated[tuple[Literal["vertical", "horizontal", "axial"], ...], Field(min_length=1)] = Field(
        default=("vertical",), description="what it measures, one channel each"
    )
    floor_n: Annotated[Number, Within(least=0)] = Field(
        default=0.0,
        description="standard deviation of the white noise",
    )
    range_n: Annotated[Real, Field(gt=0)] = Field(description="readings are clipped at plus and minus this")

    def model_problems(self, places: Places) -> Iterator[Problem]:
        """Yield bearings that the model has not."""
        yield from places.problems(self.place, places.bearings)
        if "axial" in self.axes and places.bearings and not places.helical:
            allowed = "allowed: vertical, horizontal; spur teeth press on no bearing along the shaft (helix_deg)"
            yield Problem("axes", ", ".join(self.axes), allowed)

    @property
    def limit(self) -> float:
        """Its range [N]."""
        return self.range_n

    @property
    def limit_key(self) -> str:
        """The key of its range."""
        return "range_n"

    @property
    def noise_floor(self) -> Number | None:
        """Standard deviation of its white noise [N]."""
        return self.floor_n or None

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:  # noqa: ARG002
        """Return the force along an axis."""
        return {Input(FORCE, f"{self.place}/{axis}"): 1.0}
