"""A toy kind of sensor, as somebody would add one: a washer under a bearing that shows its force, in N."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from siggen.errors import Problem
from siggen.keys.number import Number, Within
from siggen.keys.section import Real
from siggen.sensing.inputs import FORCE, Input
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, Sensor


class ToyForceWasher(Sensor):
    """What a user writes about it."""

    quantity: ClassVar[Quantity] = Quantity("bearing force", "force", "N", "n")
    noun: ClassVar[str] = "force washer"
    acts: ClassVar[str] = "Toy washers show the force of a bearing on its seat, mean included."
    plausible: ClassVar[tuple[float, float, str]] = (10.0, 1e6, "is it in N, not kN?")

    kind: Literal["toy_force_washer"] = "toy_force_washer"
    place: Literal["pinion_bearing", "gear_bearing"] = "pinion_bearing"
    axes: Annotated[tuple[Literal["vertical", "horizontal"], ...], Field(min_length=1)] = ("vertical",)
    range_n: Annotated[Real, Field(gt=0)] = 1e4
    floor_n: Annotated[Number, Within(least=0)] = 0.0

    @property
    def limit(self) -> float:
        return self.range_n

    @property
    def limit_key(self) -> str:
        return "range_n"

    @property
    def noise_floor(self) -> Number | None:
        return self.floor_n

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:
        return {Input(FORCE, f"{self.place}/{axis}"): 1.0}

    def own_problems(self) -> Iterator[Problem]:
        if self.range_n < 1.0:
            yield Problem("range_n", f"{self.range_n:g}", "allowed: at least 1")
