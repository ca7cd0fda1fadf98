"""Torque sensors: what a coupling between motor and gearbox, or gearbox and load, passes on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.section import Real
from siggen.sensing.inputs import SHAFT, Input
from siggen.sensors.places import PLACE_TEXT, Places
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase


class TorqueSensor(SensorBase):
    """A torque flange in a coupling: stiffness times twist and damping times its rate, mean included."""

    quantity: ClassVar[Quantity] = Quantity("torque", "torque", "N m", "nm")
    acts: ClassVar[str] = "Torque sensors show what spring and damper of a coupling pass on, mean included."
    plausible: ClassVar[tuple[float, float, str]] = (1.0, 1e7, "is it in N m, not kN m?")

    kind: Literal["coupling_torque"] = Field(description="torque that a coupling passes on")
    place: Literal["input_coupling", "output_coupling"] = Field(
        default="input_coupling",
        description=PLACE_TEXT,
    )
    axes: Annotated[tuple[Literal["rotation"], ...], Field(min_length=1)] = Field(
        default=("rotation",), description="what it measures, one channel each"
    )
    floor_nm: Annotated[Number, Within(least=0)] = Field(
        default=0.0,
        description="standard deviation of the white noise",
    )
    range_nm: Annotated[Real, Field(gt=0)] = Field(description="readings are clipped at plus and minus this")

    def model_problems(self, places: Places) -> Iterator[Problem]:
        """Yield a coupling that the model has not."""
        yield from places.problems(self.place, places.couplings)

    @property
    def limit(self) -> float:
        """Its range [N m]."""
        return self.range_nm

    @property
    def limit_key(self) -> str:
        """The key of its range."""
        return "range_nm"

    @property
    def noise_floor(self) -> Number | None:
        """Standard deviation of its white noise [N m]."""
        return self.floor_nm or None

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:  # noqa: ARG002
        """Return the torque of its coupling."""
        return {Input(SHAFT, f"torque/{self.place}"): 1.0}
