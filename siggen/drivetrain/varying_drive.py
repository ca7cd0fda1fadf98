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
from siggen.compiled import entry
from siggen.drivetrain.drive import Turning
from siggen.drivetrain.excitation import InputSource
from siggen.drivetrain.structure import Structure, driven_and_loaded, rigid_rotation, vector, without_drift

# SpeedRamp: speed that changes linearly over the record, with an acceleration that comes and goes smoothly (derived).
#
# Over [0, D] the speed is f = A + a t with a = (B - A)/D. Before 0 and after D the acceleration blends in and out
# along the cubic 3x² - 2x³, so that no jump of the acceleration shakes the train; outside of that the speed is
# constant. A blend takes half a second, or less where the speed would otherwise change to below half or above one and
# a half times A or B.

LONGEST_BLEND_S = 0.5


@dataclass(frozen=True, slots=True)
class SpeedRamp:
    """Speed from `start_hz` at time 0 to `end_hz` at `duration_s`; equal speeds are constant at all times."""

    start_hz: float
    end_hz: float
    duration_s: float

    @property
    def slope_hz_s(self) -> float:
        """Acceleration over the record [Hz/s]."""
        return (self.end_hz - self.start_hz) / self.duration_s

    @property
    def slowest_hz(self) -> float:
        """Lowest speed at any time, before and after the record included."""
        before = self.start_hz - 0.5 * self.slope_hz_s * self._blend_s(self.start_hz)
        after = self.end_hz + 0.5 * self.slope_hz_s * self._blend_s(self.end_hz)
        return min(before, after, self.start_hz, self.end_hz)

    def turns(self, time_s: FloatArray) -> FloatArray:
        """Return the revolutions (k,) since time 0."""
        a, fade_in, fade_out = self.slope_hz_s, self._blend_s(self.start_hz), self._blend_s(self.end_hz)
        inside = np.clip(time_s, 0.0, self.duration_s)
        if a == 0.0:  # powers cost most, and nobody sees them
            early, late = np.minimum(time_s, 0.0), np.maximum(time_s - self.duration_s, 0.0)
            return self.start_hz * inside + self.start_hz * early + self.end_hz * late
        result = self.start_hz * inside + 0.5 * a * inside**2
        early, x = np.minimum(time_s, 0.0), self._early(time_s)
        before_hz = self.start_hz - 0.5 * a * fade_in
        result = result + before_hz * early + a * fade_in**2 * (x**4 / 4.0 - x**5 / 10.0 - 0.15)
        late, y = np.maximum(time_s - self.duration_s, 0.0), self._late(time_s)
        past = 0.5 * y**2 - y**4 / 4.0 + y**5 / 10.0 + 0.5 * (late / fade_out - y)
        return result + self.end_hz * late + a * fade_out**2 * past

    def speed_hz(self, time_s: FloatArray) -> FloatArray:
        """Return the speed (k,) [Hz]."""
        if self.slope_hz_s == 0.0:
            return np.full_like(time_s, self.start_hz)
        a, x, y = self.slope_hz_s, self._early(time_s), self._late(time_s)
        inside = self.start_hz + a * np.clip(time_s, 0.0, self.duration_s)
        fading_in = a * self._blend_s(self.start_hz) * (x**3 - 0.5 * x**4 - 0.5)
        return inside + fading_in + a * self._blend_s(self.end_hz) * (y - y**3 + 0.5 * y**4)

    def acceleration_hz_s(self, time_s: FloatArray) -> FloatArray:
        """Return the acceleration (k,) [Hz/s]."""
        if self.slope_hz_s == 0.0:
            return np.zeros_like(time_s)
        x, y = self._early(time_s), self._late(time_s)
        return self.slope_hz_s * (3.0 * x**2 - 2.0 * x**3) * (1.0 - 3.0 * y**2 + 2.0 * y**3)

    def _blend_s(self, speed_hz: float) -> float:
        slope = abs(self.slope_hz_s)
        return LONGEST_BLEND_S if slope * LONGEST_BLEND_S <= speed_hz else speed_hz / slope

    def _early(self, time_s: FloatArray) -> FloatArray:
        """Return how far the acceleration has blended in, 0 to 1."""
        return np.clip(1.0 + time_s / self._blend_s(self.start_hz), 0.0, 1.0)

    def _late(self, time_s: FloatArray) -> FloatArray:
        """Return how far the acceleration has blended out, 0 to 1."""
        return np.clip((time_s - self.duration_s) / self._blend_s(self.end_hz), 0.0, 1.0)


# SlowVariation: a smooth random process around 0 of unit variance, with its exact integral and derivative (derived).
#
# An Ornstein-Uhlenbeck process (reference: standard literature; spectrum 1/(1 + (f/f_c)²)) is drawn exactly at knots h
# apart, c_k+1 = ρ c_k + √(1 - ρ²) ξ_k with ρ = e^(-2π f_c h), and its values are the coefficients of a cubic B-spline:
#
#     n(t) = Σ_k c_k B_3(t/h - k) / s,     s² = (2416 + 2 (1191 ρ + 120 ρ² + ρ³)) / 5040
#
# s² is the variance of the sum averaged over a knot interval (B_3 correlated with itself is B_7, whose values at the
# integers are these). n is twice continuously differentiable, its spectrum is the process's times sinc⁸(f h), and
# since the B-splines add up to 1, |n| never exceeds the largest |c_k|/s.

SLOW_CORNER_HZ = 0.5
"""Above which the random part of speeds and torques falls off (assumed)."""
KNOTS_PER_CORNER_PERIOD = 16
"""Knots per 1/f_c: the spline damps the process by 2.6 % at the corner and cuts it off around 8 f_c."""
VALUE, SLOPE, INTEGRAL = range(3)


@dataclass(frozen=True, slots=True)
class SlowVariation:
    """One realisation from `start_s` to `end_s`: coefficients c_k/s (intervals + 3,) and knots `step_s` apart.

    `before` (intervals,) is the integral [s] from the first knot to each knot.
    """

    coefficients: FloatArray
    before: FloatArray
    start_s: float
    step_s: float

    @property
    def end_s(self) -> float:
        """Last time that the realisation covers [s]."""
        return self.start_s + self.step_s * self.before.size

    @property
    def largest(self) -> float:
        """What |value| never exceeds."""
        return float(np.abs(self.coefficients).max())

    def value(self, time_s: FloatArray) -> FloatArray:
        """Return n at the times [s], of any shape."""
        return self._evaluated(VALUE, time_s)

    def slope(self, time_s: FloatArray) -> FloatArray:
        """Return dn/dt [1/s]."""
        return self._evaluated(SLOPE, time_s)

    def integral(self, time_s: FloatArray) -> FloatArray:
        """Return the integral [s] of n from time 0."""
        return np.asarray(self._evaluated(INTEGRAL, time_s) - self._evaluated(INTEGRAL, np.zeros(1))[0])

    def _evaluated(self, what: int, time_s: FloatArray) -> FloatArray:
        """Return value, slope or integral.

        Raises
        ------
        ValueError
            If a time lies outside of what the realisation covers.
        """
        times = np.ascontiguousarray(time_s, dtype=np.float64).ravel()
        if times.size and not (self.start_s <= times.min() and times.max() <= self.end_s):
            raise ValueError(
                f"time_s: received {times.min()} to {times.max()}; allowed are {self.start_s} to {self.end_s}"
            )
        values = _spline(self.coefficients, self.before, self.start_s, self.step_s, times, what)
        return np.asarray(values.reshape(np.shape(time_s)))


def slow_variation(rng: np.random.Generator, corner_hz: float, start_s: float, end_s: float) -> SlowVariation:
    """Return a realisation that covers `start_s` to `end_s`; a later end leaves what is before it as it was."""
    step_s = 1.0 / (KNOTS_PER_CORNER_PERIOD * corner_hz)
    intervals = int(np.ceil((end_s - start_s) / step_s)) + 1
    keep = float(np.exp(-2.0 * np.pi * corner_hz * step_s))
    variance = (2416.0 + 2.0 * (1191.0 * keep + 120.0 * keep**2 + keep**3)) / 5040.0
    c = _process(rng.standard_normal(intervals + 3), keep) / np.sqrt(variance)
    whole = step_s / 24.0 * (c[:-3] + 11.0 * (c[1:-2] + c[2:-1]) + c[3:])
    before = np.concatenate([[0.0], np.cumsum(whole)[:-1]])
    for array in (c, before):
        array.setflags(write=False)
    return SlowVariation(c, before, start_s, step_s)


@entry(cache=True)
def _spline(
    c: FloatArray, before: FloatArray, start_s: float, step_s: float, times: FloatArray, what: int
) -> FloatArray:
    """Return value, slope or integral from the first knot of a uniform cubic B-spline at the times (k,)."""
    result = np.empty_like(times)
    for k in range(times.size):
        place = (times[k] - start_s) / step_s
        i = min(max(int(place), 0), before.size - 1)
        x = place - i
        y = 1.0 - x
        a, b, d, e = c[i], c[i + 1], c[i + 2], c[i + 3]
        if what == VALUE:
            inner = b * (4.0 + x * x * (3.0 * x - 6.0)) + d * (4.0 + y * y * (3.0 * y - 6.0))
            result[k] = (a * y * y * y + inner + e * x * x * x) / 6.0
        elif what == SLOPE:
            inner = b * x * (3.0 * x - 4.0) - d * y * (3.0 * y - 4.0)
            result[k] = (-a * y * y + inner + e * x * x) / (2.0 * step_s)
        else:
            inner = b * x * (4.0 + x * x * (0.75 * x - 2.0)) + d * x * (1.0 + x * (1.5 + x * (1.0 - 0.75 * x)))
            result[k] = before[i] + step_s / 6.0 * (0.25 * a * (1.0 - y * y * y * y) + inner + 0.25 * e * x * x * x * x)
    return result


@entry(cache=True)
def _process(normals: FloatArray, keep: float) -> FloatArray:
    """Return the process (k,) at its knots, stationary from the first."""
    result = np.empty_like(normals)
    result[0] = normals[0]
    fresh = np.sqrt(1.0 - keep * keep)
    for i in range(1, normals.size):
        result[i] = keep * result[i - 1] + fresh * normals[i]
    return result


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


# TorqueVariation: torques beside the constant one, and those that speed the train up, without moving it as a whole.
#
# Derived. Body i turns by r_i Θ(t) + θ_i, where Θ is prescribed and θ_i a coordinate; r is the rigid rotation (pinion
# 1). With kinetic energy ½ Σ J_i (r_i Ω + θ̇_i)² the equations of the coordinates get the force -M r Ω̇. Since Mᵀr Ω̇
# does work on r, the motor has to supply J Ω̇ with J = rᵀ M r, the inertia of the train seen from the pinion:
#
#     M q̈ + C q̇ + K q + p F = τ T + (e_m J - M r) Ω̇          rᵀ(e_m J - M r) = 0: no rigid drift
#
# Any torque u on a body b does the same with its own share of the rigid acceleration: it acts along e_b - M r
# (rᵀe_b)/J. That is, Θ is by definition the whole rigid motion, and what a torque adds to the coordinates is twist
# alone.


@dataclass(frozen=True, slots=True)
class TorqueSettings:
    """How the torque varies, relative to the mean torque; the defaults leave it constant.

    Attributes
    ----------
    slow, slow_rms : slow random part of motor and load together, unit variance and its rms
    load_once, load_phase_rad : load torque at once per revolution of its own shaft
    line_ripple, line_hz, line_phase_rad : motor torque at twice the line frequency
    """

    slow: SlowVariation | None = None
    slow_rms: float = 0.0
    load_once: float = 0.0
    load_phase_rad: float = 0.0
    line_ripple: float = 0.0
    line_hz: float = 50.0
    line_phase_rad: float = 0.0


class TorqueVariation(InputSource):
    """Three inputs: slow torque of motor and load in balance, torque of the load, torque of the motor."""

    def __init__(self, structure: Structure, torque_nm: float, settings: TorqueSettings) -> None:
        motor, load = driven_and_loaded(structure)
        rotation = rigid_rotation(structure)
        self.reduced_inertia_kg_m2 = float(rotation @ structure.mass @ rotation)
        self._vectors = np.stack([structure.torque_vector, *without_drift(structure, _units(structure, load, motor))])
        self._gear_turn = abs(rotation[structure.coordinates.index(load)])
        self._torque_nm = torque_nm
        self._settings = settings

    @property
    def vectors(self) -> FloatArray:
        """The generalised forces (3, n)."""
        return self._vectors

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the inputs (k, 3) [N m]: the first and the last as motor torques, the second on the load's shaft."""
        s = self._settings
        gear_angle = turning.angle_rad * self._gear_turn
        once = -self._torque_nm / self._gear_turn * s.load_once * np.cos(gear_angle + s.load_phase_rad)
        return np.stack([self._slow_nm(turning), once, self._motor_nm(turning)], axis=1)

    def motor_torque_nm(self, turning: Turning) -> FloatArray:
        """Return the whole torque (k,) that the motor delivers, the mean and what speeds the train up included."""
        return self._torque_nm + self._slow_nm(turning) + self._motor_nm(turning)

    def _slow_nm(self, turning: Turning) -> FloatArray:
        s = self._settings
        if s.slow is None:
            return np.zeros_like(turning.time_s)
        return self._torque_nm * s.slow_rms * s.slow.value(turning.time_s)

    def _motor_nm(self, turning: Turning) -> FloatArray:
        s = self._settings
        ripple = np.cos(4.0 * np.pi * s.line_hz * turning.time_s + s.line_phase_rad)
        return self.reduced_inertia_kg_m2 * turning.acceleration_rad_s2 + self._torque_nm * s.line_ripple * ripple


def _units(structure: Structure, *names: str) -> FloatArray:
    """Return a unit torque (names, n) at each of the coordinates."""
    return np.array([vector(structure.coordinates, {name: 1.0}) for name in names])
