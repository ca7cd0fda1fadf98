"""Currents of the induction motor that drives the gearbox: its rotor's uneven rotation beside the line frequency."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import pi
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.errors import Problem, SolverFailure
from siggen.keys.number import Number, Within
from siggen.keys.section import Real
from siggen.sensing.inputs import SHAFT, Input
from siggen.sensing.stator_current import InductionMotor, active_current, phase_current
from siggen.sensors.places import Places
from siggen.sensors.quantity import Quantity
from siggen.sensors.sensor import AxisDraws, SensorBase
from siggen.sensors.transducer import Running, Transducer

PHASES = ("phase_a", "phase_b", "phase_c")
POLE_PAIRS, RATED_SLIP = 2, 0.03
"""Of the motor: four poles, and the slip at the rated torque (usual)."""
BREAKDOWN_OVER_RATED = 5.0
"""Slip of the largest torque over that of the rated one (assumed): the largest torque is 2.6 times the rated one."""
ACTIVE_A = 10.0
"""Amplitude of the active current at the rated torque; `gain` makes it another."""
MAGNETISING_OVER_ACTIVE = 0.5
"""Amplitude of the magnetising current over the active one at the rated torque: a power factor of 0.89 (assumed)."""


class MotorCurrent(SensorBase):
    """Clamps about the phases of an induction motor at a line frequency that does not change within a record."""

    quantity: ClassVar[Quantity] = Quantity("current", "current", "A", "a")
    acts: ClassVar[str] = (
        "Current clamps show the phases of an induction motor: the line frequency is that at which it turns as it does "
        "under its torque, and uneven rotation moves the active current by its slip."
    )
    plausible: ClassVar[tuple[float, float, str]] = (1.0, 5e3, "is it in A?")

    kind: Literal["motor_current"] = Field(description="current of a phase of the induction motor that drives")
    place: Literal["motor"] = Field(default="motor", description="the motor")
    axes: Annotated[tuple[Literal["phase_a", "phase_b", "phase_c"], ...], Field(min_length=1)] = Field(
        default=("phase_a",), description="what it measures, one channel each"
    )
    rated_torque_nm: Annotated[Number, Within(above=0)] = Field(description="torque at the rated slip")
    floor_a: Annotated[Number, Within(least=0)] = Field(
        default=0.0,
        description="standard deviation of the white noise",
    )
    range_a: Annotated[Real, Field(gt=0)] = Field(
        default=100.0, description="readings are clipped at plus and minus this"
    )

    def model_problems(self, places: Places) -> Iterator[Problem]:
        """Yield a model without a motor."""
        yield from places.problems(self.place, tuple(shaft for shaft in places.shafts if shaft == "motor"))

    @property
    def limit(self) -> float:
        """Its range [A]."""
        return self.range_a

    @property
    def limit_key(self) -> str:
        """The key of its range."""
        return "range_a"

    @property
    def noise_floor(self) -> Number | None:
        """Standard deviation of its white noise [A]."""
        return self.floor_a or None

    def shows(self, axis: str, draw: AxisDraws) -> Mapping[Input, float]:  # noqa: ARG002
        """Return the vibration of the rotor."""
        return {Input(SHAFT, "angle/motor"): 1.0}

    def transducer(self, axis: str, draw: AxisDraws) -> Transducer:
        """Return the winding of a phase; all phases are those of one motor."""
        motor = InductionMotor(
            pole_pairs=POLE_PAIRS,
            rated_torque_nm=draw.of_sensor(self.rated_torque_nm, "rated_torque_nm"),
            rated_slip=RATED_SLIP,
            rated_active_a=ACTIVE_A,
            breakdown_slip=BREAKDOWN_OVER_RATED * RATED_SLIP,
            magnetising_a=MAGNETISING_OVER_ACTIVE * ACTIVE_A,
        )
        return Winding(self.name, motor, 2.0 * pi / 3.0 * PHASES.index(axis))


@dataclass(frozen=True, slots=True)
class Winding:
    """One phase of a motor, and by what angle it is behind the first."""

    sensor: str
    motor: InductionMotor
    behind_rad: float

    def reading(self, shown: FloatArray, running: Running) -> FloatArray:
        """Return the current (n,) [A] of a rotor that vibrates by (n,) [rad].

        Raises
        ------
        SolverFailure
            If the speed changes more than a motor's at one line frequency.
        """
        motor, fs_hz = self.motor, running.fs_hz
        turned = running.shaft_rad("motor") + shown
        seconds = np.arange(shown.size) / fs_hz
        speed = (turned[-1] - turned[0]) / seconds[-1]
        line_hz = motor.line_hz(speed / (2.0 * pi), running.torque_nm)
        added = active_current(motor, turned - speed * seconds, fs_hz, line_hz)
        steady = motor.rated_active_a * running.torque_nm / motor.rated_torque_nm
        largest = motor.rated_active_a * motor.breakdown_slip / motor.rated_slip
        if not (steady + added < largest).all():
            raise SolverFailure(
                "unreadable",
                f"sensor {self.sensor}: the slip would pass {motor.breakdown_slip:g}, five times the rated, where a "
                "motor stalls; lower the torque or the variation of the speed in a record, or raise rated_torque_nm",
            )
        return phase_current(motor, steady + added, 2.0 * pi * line_hz * seconds + running.line_rad, self.behind_rad)
