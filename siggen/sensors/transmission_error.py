"""The transmission error that two encoders see: what one shaft is ahead of the other, on the line of action."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.errors import Problem
from siggen.sensing.inputs import Input
from siggen.sensors.converter import BITS_TEXT, Bits
from siggen.sensors.encoder import Encoder
from siggen.sensors.places import Places
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase
from siggen.sensors.transducer import Running, Transducer

LARGEST_UM = 1e6
MICROMETRES = 1e6
ENCODER = "encoder of the set on pinion or motor; on gear or load"


class TransmissionError(SensorBase):
    """R_b1 θ_1 - R_b2 θ_2 of the angles that two encoders of the set count, about its mean (standard literature).

    Encoders count from where they began: the mean error under load is in no record.
    """

    quantity: ClassVar[Quantity] = Quantity("transmission error", "transmission_error", "um", "um", "rotation")
    acts: ClassVar[str] = (
        "Transmission errors are those that two encoders see, base radius times angle of the pinion's shaft less that "
        "of the gear's, about their mean."
    )

    kind: Literal["transmission_error"] = Field(description="difference of two encoders on the line of action")
    place: Literal["mesh"] = Field(default="mesh", description="between both encoders")
    axes: Annotated[tuple[Literal["line_of_action"], ...], Field(min_length=1)] = Field(
        default=("line_of_action",), description="what it measures, one channel each"
    )
    driver_encoder: str = Field(description=ENCODER)
    driven_encoder: str = Field(description=ENCODER)
    bits: Bits = Field(default=None, description=BITS_TEXT)

    def model_problems(self, places: Places) -> Iterator[Problem]:  # noqa: ARG002
        """Yield nothing: its encoders say what the model has not."""
        yield from ()

    def beside_problems(self, others: Mapping[str, SensorBase], places: Places) -> Iterator[Problem]:
        """Yield names that are none of encoders on both sides of one mesh, that of the pinion's encoder."""
        turning = {name: one.place for name, one in others.items() if isinstance(one, Encoder)}
        ends = places.ends_of_meshes
        own = [end for end in ends if turning.get(self.driver_encoder) in end[0]] or ends
        for key, side, meshes in (("driver_encoder", 0, ends), ("driven_encoder", 1, own)):
            name, shafts = getattr(self, key), tuple(shaft for end in meshes for shaft in end[side])
            fitting = [other for other, place in turning.items() if place in shafts]
            if name not in fitting:
                listed = ", ".join(fitting) or "none there is; add one"
                yield Problem(key, f"'{name}'", f"allowed: an encoder at place {' or '.join(shafts)}: {listed}")

    @property
    def limit(self) -> float:
        """An error that no teeth have [um]: nothing is clipped."""
        return LARGEST_UM

    @property
    def limit_key(self) -> str:
        """The key that its size follows from."""
        return "driver_encoder"

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:  # noqa: ARG002
        """Return nothing: it reads other sensors."""
        return {}

    def transducer(self, axis: str, draw: AxisDraws) -> Transducer:  # noqa: ARG002
        """Return the difference of both channels."""
        return EncoderDifference(f"{self.driver_encoder}_rotation", f"{self.driven_encoder}_rotation")


@dataclass(frozen=True, slots=True)
class EncoderDifference:
    """The channels of both encoders."""

    pinion: str
    gear: str

    def reading(self, shown: FloatArray, running: Running) -> FloatArray:  # noqa: ARG002
        """Return the error (n,) [um] at the samples."""
        radii, readings = [running.base_radius_m(name) for name in (self.pinion, self.gear)], running.readings
        rate = radii[0] * readings[self.pinion] - radii[1] * readings[self.gear]
        after = np.cumsum(rate) / running.fs_hz  # each speed holds from half an interval before its sample on
        error = MICROMETRES * (after - 0.5 * rate / running.fs_hz)
        return np.asarray(error - error.mean())
