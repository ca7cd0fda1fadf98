"""Drive: the angle of the pinion over time, which sets the phase of the mesh and of the tacho (derived)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from siggen.arrays import FloatArray


class Turning(NamedTuple):
    """Times and the prescribed rotation of the pinion at them, each (k,)."""

    time_s: FloatArray
    angle_rad: FloatArray
    speed_rad_s: FloatArray
    acceleration_rad_s2: FloatArray


class Rotation(Protocol):
    """The prescribed rotation of the pinion; speed and acceleration are the exact derivatives of the angle."""

    def angle_rad(self, time_s: FloatArray) -> FloatArray:
        """Return the integrated pinion angle (k,) [rad] at the times (k,) [s]; time 0 is the first sample."""

    def speed_rad_s(self, time_s: FloatArray) -> FloatArray:
        """Return the speed (k,) [rad/s]."""

    def acceleration_rad_s2(self, time_s: FloatArray) -> FloatArray:
        """Return the angular acceleration (k,) [rad/s²]."""

    def turning(self, time_s: FloatArray) -> Turning:
        """Return angle, speed and acceleration together: they share most of their work."""

    def tacho_s(self, duration_s: float) -> FloatArray:
        """Return the times (k,) [s] in [0, duration) at which the pinion angle is a whole number of revolutions."""


@dataclass(frozen=True, slots=True)
class Drive:
    """Rotation of the pinion at constant speed; angle 0: the pair of tooth 0 enters contact, a tacho mark passes."""

    speed_hz: float
    start_angle_rad: float

    def angle_rad(self, time_s: FloatArray) -> FloatArray:
        """Return the integrated pinion angle (k,) [rad] at the times (k,) [s]; time 0 is the first sample."""
        return self.start_angle_rad + 2.0 * np.pi * self.speed_hz * time_s

    def speed_rad_s(self, time_s: FloatArray) -> FloatArray:
        """Return the speed (k,) [rad/s]."""
        return np.full_like(time_s, 2.0 * np.pi * self.speed_hz)

    def acceleration_rad_s2(self, time_s: FloatArray) -> FloatArray:
        """Return zeros (k,) [rad/s²]."""
        return np.zeros_like(time_s)

    def turning(self, time_s: FloatArray) -> Turning:
        """Return angle, speed and acceleration together."""
        return Turning(time_s, self.angle_rad(time_s), self.speed_rad_s(time_s), self.acceleration_rad_s2(time_s))

    def tacho_s(self, duration_s: float) -> FloatArray:
        """Return the times (k,) [s] in [0, duration) at which the pinion angle is a whole number of revolutions."""
        start = self.start_angle_rad / (2.0 * np.pi)
        first = np.ceil(start)
        marks = np.arange(first, np.ceil(start + self.speed_hz * duration_s) + 1.0)
        times = (marks - start) / self.speed_hz
        times = times[times < duration_s]
        times.setflags(write=False)
        return times
