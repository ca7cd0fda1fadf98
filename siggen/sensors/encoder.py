"""Encoders: a disc with marks on a shaft, and a counter that times their pulses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf, pi
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.errors import Problem, SolverFailure
from siggen.keys.number import Number, Within
from siggen.keys.section import Whole
from siggen.keys.usual import Usual
from siggen.names import PINION
from siggen.sensing.inputs import SHAFT, Input
from siggen.sensing.pulses import counted_speed, disc_marks, pulse_times
from siggen.sensors.converter import BITS_TEXT, Bits
from siggen.sensors.places import PLACE_TEXT, TURNING, Places
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase
from siggen.sensors.transducer import Running, Transducer

FEWEST_PULSES = 2
"""In a record: fewer have no time between them."""
FASTEST_RAD_S = 1e5
"""A million turns a minute."""
LARGEST_PITCH_ERROR = 3.0
"""Standard deviations beyond which no mark is off; so marks of 0.1 rms never change places."""


class Encoder(SensorBase):
    """An incremental encoder on a shaft, as a counter stores it: the mean angular speed over each sampling interval."""

    quantity: ClassVar[Quantity] = Quantity("angular speed", "speed", "rad/s", "rad_s", "rotation")
    acts: ClassVar[str] = (
        "Encoders time the marks of a disc that turns with its shaft, vibration included; "
        "stored is the mean speed over each sampling interval, whose sum over fs is the angle."
    )

    kind: Literal["encoder"] = Field(description="angular speed of a shaft, from the pulses of a disc")
    place: Annotated[str, TURNING] = Field(
        default=PINION,
        description=PLACE_TEXT,
    )
    axes: Annotated[tuple[Literal["rotation"], ...], Field(min_length=1)] = Field(
        default=("rotation",), description="what it measures, one channel each"
    )
    pulses_per_turn: Annotated[Whole, Field(ge=1, le=100_000)] = Field(
        default=1024, description="marks of the disc, as the counter counts them"
    )
    pitch_error: Annotated[Number, Within(least=0, most=0.1), Usual(0.0002, 0.1)] = Field(
        default=0.01, description="standard deviation of each mark's place over the pitch"
    )
    eccentricity: Annotated[Number, Within(least=0, most=0.1), Usual(1e-05, 0.02)] = Field(
        default=5e-4, description="of the disc over the radius of its marks, in a direction drawn per gearbox"
    )
    bits: Bits = Field(default=None, description=BITS_TEXT)

    def model_problems(self, places: Places) -> Iterator[Problem]:
        """Yield a shaft that the model has not."""
        yield from places.problems(self.place, places.shafts)

    def duration_problems(self, turns: Mapping[str, float]) -> Iterator[Problem]:
        """Yield an encoder whose slowest record has too few pulses."""
        if self.place in turns and self.pulses_per_turn * turns[self.place] < FEWEST_PULSES:
            least = int(np.ceil(FEWEST_PULSES / turns[self.place]))
            allowed = (
                f"allowed: at least {least}; in duration_s its shaft makes {turns[self.place]:.3g} turns at the lowest "
                f"speed, and a speed needs {FEWEST_PULSES} pulses"
            )
            yield Problem("pulses_per_turn", str(self.pulses_per_turn), allowed)

    @property
    def drawn_by_name(self) -> bool:
        """Every disc sits at an angle of its own on its shaft, whatever its errors."""
        return True

    @property
    def limit(self) -> float:
        """A speed that no shaft has [rad/s]: a counter clips nothing."""
        return FASTEST_RAD_S

    @property
    def limit_key(self) -> str:
        """The key that the speed of its pulses follows from."""
        return "pulses_per_turn"

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:  # noqa: ARG002
        """Return the vibration of its shaft."""
        return {Input(SHAFT, f"angle/{self.place}"): 1.0}

    def transducer(self, axis: str, draw: AxisDraws) -> Transducer:  # noqa: ARG002
        """Return its disc, with the errors and the place that it has on this gearbox."""
        rng = draw.generator("marks")
        errors = np.clip(rng.standard_normal(self.pulses_per_turn), -LARGEST_PITCH_ERROR, LARGEST_PITCH_ERROR)
        marks = disc_marks(
            self.pulses_per_turn,
            draw(self.pitch_error, "pitch_error") * errors,
            draw(self.eccentricity, "eccentricity"),
            2.0 * pi * draw.uniform(f"{draw.path}.eccentricity.angle"),
        )
        return Disc(self, marks, 2.0 * pi * draw.uniform(f"{draw.path}.disc.angle"))


@dataclass(frozen=True, slots=True)
class Disc:
    """The marks (m,) [rad] of an encoder on one gearbox, and the angle at which it sits on its shaft."""

    encoder: Encoder
    marks_rad: FloatArray
    seat_rad: float

    def reading(self, shown: FloatArray, running: Running) -> FloatArray:
        """Return the speed (n,) [rad/s] that the counter makes of the pulses of a vibration (n,) [rad].

        Raises
        ------
        SolverFailure
            If the shaft turns back, or the record has too few pulses.
        """
        encoder = self.encoder
        angle = running.shaft_rad(encoder.place) + shown + self.seat_rad
        numbers, times = self._pulses(angle, running.fs_hz)
        if numbers.size < FEWEST_PULSES:
            raise SolverFailure(
                "unreadable",
                f"sensor {encoder.name}: {numbers.size} pulses; change pulses_per_turn ({encoder.pulses_per_turn}), "
                "the speed or duration_s",
            )
        return counted_speed(numbers, times, encoder.pulses_per_turn, running.fs_hz, shown.size)

    def _pulses(self, angle: FloatArray, fs_hz: float) -> tuple[FloatArray, FloatArray]:
        try:
            return pulse_times(angle, fs_hz, self.marks_rad)
        except ValueError as error:
            slowest = np.diff(angle).min(initial=inf) * fs_hz
            raise SolverFailure(
                "unreadable",
                f"sensor {self.encoder.name}: the {self.encoder.place} turns back in its vibration (down to "
                f"{slowest:.3g} rad/s), and pulses have no direction; raise the speed or the couplings' damping",
            ) from error
