"""A toy kind of sensor, as somebody would add one: a gauge on the seat of a bearing that shows its strain, in um/m."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.section import Real
from siggen.sensing.inputs import FORCE, Input
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase

STRAIN_PER_FORCE = 1e6 / (2.06e11 * 4e-4)
"""Of a seat of steel with a section of 4 cm² [um/m per N]."""


class ToyStrainGauge(SensorBase):
    """What a user writes about it."""

    quantity: ClassVar[Quantity] = Quantity("strain", "strain", "um/m", "um_m")
    acts: ClassVar[str] = "Toy gauges show the strain of a bearing's seat about its mean."
    plausible: ClassVar[tuple[float, float, str]] = (1.0, 1e4, "is it in um/m?")

    kind: Literal["toy_strain_gauge"] = "toy_strain_gauge"
    place: Literal["pinion_bearing", "gear_bearing"] = "pinion_bearing"
    axes: Annotated[tuple[Literal["vertical", "horizontal"], ...], Field(min_length=1)] = ("vertical",)
    range_um_m: Annotated[Real, Field(gt=0)] = 1e3
    floor_um_m: Annotated[Number, Within(least=0)] = 0.0

    @property
    def limit(self) -> float:
        return self.range_um_m

    @property
    def limit_key(self) -> str:
        return "range_um_m"

    @property
    def noise_floor(self) -> Number | None:
        return self.floor_um_m

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:
        return {Input(FORCE, f"{self.place}/{axis}"): STRAIN_PER_FORCE}

    def own_problems(self) -> Iterator[Problem]:
        if self.range_um_m < 0.1:
            yield Problem("range_um_m", f"{self.range_um_m:g}", "allowed: at least 0.1")
