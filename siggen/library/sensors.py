"""Sensors of a user's own: what they read of a gearbox, and what they do to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from siggen.arrays import ComplexArray, FloatArray
from siggen.errors import UsageError
from siggen.keys.number import Number
from siggen.sensing.inputs import FORCE, MOTION, SHAFT, Input
from siggen.sensors.places import PLATE_OF
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase

__all__ = ["Channel", "PassedSensor", "Reading", "Sensor"]

DIRECTIONS = ("vertical", "horizontal", "axial")


@dataclass(frozen=True)
class Reading:
    """A weight times what a channel reads of a gearbox.

    Attributes
    ----------
    of : str
        A place of the housing such as `lid`, a bearing such as `input.bearing`, a coupling such as `input.coupling`, or
        a gear. `Gearbox.readable` lists them.
    along : str
        'vertical', 'horizontal' or 'axial'; of couplings and gears nothing counts but their turning.
    order : int
        2: acceleration of a place or bearing [m/s²]. 0: force in a bearing [N], torque of a coupling [N m], or how far
        a gear is ahead of its mean turning [rad].
    weight : float
        In units of the channel per unit of what is read.
    """

    of: str
    along: str = "vertical"
    order: int = 2
    weight: float = 1.0


@dataclass(frozen=True)
class Channel:
    """One signal of a sensor: its readings, through its response, with white noise.

    Attributes
    ----------
    name, unit : str
    reads : sequence of Reading
        At most one place of the housing among them.
    response : callable or None
        Frequencies (k,) [Hz] -> complex factors (k,); None: 1.
    floor : float
        Standard deviation of its white noise, in its unit.
    range : float
        Readings are clipped at plus and minus this, in its unit.
    """

    name: str
    unit: str
    reads: Sequence[Reading]
    response: Callable[[FloatArray], NDArray[Any]] | None = None
    floor: float = 0.0
    range: float = inf


class Sensor(Protocol):
    """A sensor of your own: a class with this one method. Of noise it has white noise alone."""

    def channels(self, gearbox: Any) -> Sequence[Channel]:
        """Return what it records of a `Gearbox`."""


class PassedSensor(SensorBase):
    """A channel that a user passed in; no file names it."""

    kind: Literal["passed"] = "passed"
    axes: tuple[str, ...] = ("",)
    bits: None = None
    channel: Any = Field(exclude=True)
    inputs: Any = Field(exclude=True)

    @property
    def quantity(self) -> Quantity:  # type: ignore[override]
        """What it holds."""
        return Quantity(self.name, self.name, self.channel.unit, "own")

    def channel_name(self, axis: str) -> str:  # noqa: ARG002
        """Return its name: it has one channel."""
        return self.name

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:  # noqa: ARG002
        """Return its readings."""
        return dict(self.inputs)

    def response(self, draw: AxisDraws, frequency_hz: FloatArray) -> ComplexArray | None:  # noqa: ARG002
        """Return what it does at frequencies (k,).

        Raises
        ------
        UsageError
            If the user's function gives other than a number for each.
        """
        if self.channel.response is None:
            return None
        found = np.asarray(self.channel.response(frequency_hz), dtype=np.complex128)
        if found.shape != frequency_hz.shape or not np.isfinite(found).all():
            received = f"{np.count_nonzero(~np.isfinite(found))} values not finite, shape {found.shape}"
            raise UsageError(
                f"response of {self.name}: received {received}; allowed: finite, shape {frequency_hz.shape}"
            )
        return found

    @property
    def limit(self) -> float:
        """Its range."""
        return float(self.channel.range)

    @property
    def limit_key(self) -> str:
        """Where its range stands."""
        return "range"

    @property
    def noise_floor(self) -> Number | None:
        """Standard deviation of its white noise."""
        return float(self.channel.floor) or None

    @property
    def plate(self) -> str | None:
        """The plate of the housing that it stands on."""
        return PLATE_OF.get(self.place)


def reading_input(reading: Reading, channel: str, word: str, what: str) -> Input:
    """Return what a reading is in the model's terms; `what` it is: place, bearing, coupling or gear."""
    if what in {"coupling", "gear"}:
        return Input(SHAFT, f"{'torque' if what == 'coupling' else 'angle'}/{word}")
    if reading.order == 0:
        return Input(FORCE, f"{word}/{reading.along}")
    return Input(MOTION, f"{f'casing_{channel}' if word in PLATE_OF else word}/{reading.along}")
