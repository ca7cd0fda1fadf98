"""VaryingDrive: run-up, slow random speed and ripple of the pinion's rotation as one differentiable angle (derived).

Three functions one after the other, so that angle, speed and acceleration are exact derivatives of each other:

    s(t) = t + σ ∫ n dt               slow random part: time runs faster or slower (n: `SlowVariation`, unit variance)
    u(s) = 2π × turns of the ramp     speed over the warped time
    Θ(u) = u + Σ_k (a_k/k) sin(k u + φ_k), k = 1, 2      ripple: the speed varies by ± a_k

so Ω = (1 + σ n) · 2π f(s) · (1 + Σ a_k cos(k u + φ_k)). Constant speed is `Drive`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Turning
from siggen.dynamics.drive.slow_variation import SlowVariation
from siggen.dynamics.drive.speed_ramp import SpeedRamp

NEWTON_STEPS = 8
"""Newton's method on the angle between two marks ends at rounding after 3 or 4 steps."""


@dataclass(frozen=True, slots=True)
class Ripple:
    """Relative amplitudes of the speed at once and twice per revolution, and their phases [rad]."""

    once: float = 0.0
    twice: float = 0.0
    phase_once_rad: float = 0.0
    phase_twice_rad: float = 0.0


@dataclass(frozen=True, slots=True)
class VaryingDrive:
    """Rotation of the pinion at varying speed; `slow` moves by `slow_rms` of the speed (None: not at all)."""

    ramp: SpeedRamp
    start_angle_rad: float
    ripple: Ripple = Ripple()
    slow: SlowVariation | None = None
    slow_rms: float = 0.0

    def __post_init__(self) -> None:
        if not np.isfinite(self.start_angle_rad):
            raise ValueError(f"start_angle_rad: received {self.start_angle_rad}; allowed are finite angles")
        slow = 0.0 if self.slow is None else self.slow_rms * self.slow.largest
        ripple = abs(self.ripple.once) + abs(self.ripple.twice)
        if not (slow < 1.0 and ripple < 1.0):
            raise ValueError(
                f"speed: received a random part of up to {slow:.3g} and a ripple of up to {ripple:.3g} of the speed; "
                "allowed are parts below 1, so that the pinion never stops or turns back"
            )

    def angle_rad(self, time_s: FloatArray) -> FloatArray:
        """Return the integrated pinion angle (k,) [rad] at the times (k,) [s]; time 0 is the first sample."""
        carrier = self._carrier_rad(self._warped_s(time_s))
        ahead = self._ahead_rad(carrier) - self._ahead_rad(np.array(self.start_angle_rad))
        return carrier + ahead

    def speed_rad_s(self, time_s: FloatArray) -> FloatArray:
        """Return the speed (k,) [rad/s]."""
        return self.turning(time_s).speed_rad_s

    def acceleration_rad_s2(self, time_s: FloatArray) -> FloatArray:
        """Return the angular acceleration (k,) [rad/s²]."""
        return self.turning(time_s).acceleration_rad_s2

    def turning(self, time_s: FloatArray) -> Turning:
        """Return angle, speed and acceleration together."""
        warped = self._warped_s(time_s)
        carrier, (speed, quickening) = self._carrier_rad(warped), self._carrier_rates(time_s, warped)
        r = self.ripple
        once, twice = carrier + r.phase_once_rad, 2.0 * carrier + r.phase_twice_rad
        sine_once, sine_twice = r.once * np.sin(once), np.sin(twice)
        factor = 1.0 + (r.once * np.cos(once) + r.twice * np.cos(twice))
        ahead = sine_once + 0.5 * r.twice * sine_twice - self._ahead_rad(np.array(self.start_angle_rad))
        bend = sine_once + 2.0 * r.twice * sine_twice
        return Turning(time_s, carrier + ahead, speed * factor, quickening * factor - speed**2 * bend)

    def tacho_s(self, duration_s: float) -> FloatArray:
        """Return the times (k,) [s] in [0, duration) at which the pinion angle is a whole number of revolutions."""
        turn = 2.0 * np.pi
        ends = self.angle_rad(np.array([0.0, duration_s])) / turn
        marks = np.arange(np.ceil(ends[0]), np.ceil(ends[1]) + 1.0)
        grid = np.linspace(0.0, duration_s, 8 * marks.size + 1)
        # A mark behind the record may lie a slow revolution away, where nothing is drawn any more.
        inside = marks <= ends[1]
        times, marks = np.interp(marks * turn, self.angle_rad(grid), grid)[inside], marks[inside]
        for _ in range(NEWTON_STEPS):
            times = times - (self.angle_rad(times) - marks * turn) / self.speed_rad_s(times)
        # Rounding may put the root of a mark at time 0 a hair before it.
        times = np.where(np.abs(times) < 1e-12, 0.0, times)
        times = times[(times >= 0.0) & (times < duration_s)]
        times.setflags(write=False)
        return times

    def _warped_s(self, time_s: FloatArray) -> FloatArray:
        return time_s if self.slow is None else time_s + self.slow_rms * self.slow.integral(time_s)

    def _carrier_rad(self, warped: FloatArray) -> FloatArray:
        return self.start_angle_rad + 2.0 * np.pi * self.ramp.turns(warped)

    def _carrier_rates(self, time_s: FloatArray, warped: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the first and the second derivative of the carrier angle."""
        speed, quickening = 2.0 * np.pi * self.ramp.speed_hz(warped), 2.0 * np.pi * self.ramp.acceleration_hz_s(warped)
        if self.slow is None:
            return speed, quickening
        speed_ratio = 1.0 + self.slow_rms * self.slow.value(time_s)
        return speed * speed_ratio, quickening * speed_ratio**2 + speed * self.slow_rms * self.slow.slope(time_s)

    def _ahead_rad(self, carrier_rad: FloatArray) -> FloatArray:
        r = self.ripple
        first = r.once * np.sin(carrier_rad + r.phase_once_rad)
        return first + 0.5 * r.twice * np.sin(2.0 * carrier_rad + r.phase_twice_rad)
