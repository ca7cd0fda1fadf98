"""SlowVariation: a smooth random process around 0 of unit variance, with its exact integral and derivative (derived).

An Ornstein-Uhlenbeck process (reference: standard literature; spectrum 1/(1 + (f/f_c)²)) is drawn exactly at knots h
apart, c_k+1 = ρ c_k + √(1 - ρ²) ξ_k with ρ = e^(-2π f_c h), and its values are the coefficients of a cubic B-spline:

    n(t) = Σ_k c_k B_3(t/h - k) / s,     s² = (2416 + 2 (1191 ρ + 120 ρ² + ρ³)) / 5040

s² is the variance of the sum averaged over a knot interval (B_3 correlated with itself is B_7, whose values at the
integers are these). n is twice continuously differentiable, its spectrum is the process's times sinc⁸(f h), and
since the B-splines add up to 1, |n| never exceeds the largest |c_k|/s.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry

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
    """Return a realisation that covers `start_s` to `end_s`; a later end leaves what is before it as it was.

    Raises
    ------
    ValueError
        If the corner is not positive and finite, or the time 0 is not between start and end.
    """
    if not (np.isfinite(corner_hz) and corner_hz > 0.0):
        raise ValueError(f"corner_hz: received {corner_hz}; allowed are finite frequencies above 0")
    if not start_s <= 0.0 < end_s:
        raise ValueError(f"start_s, end_s: received {start_s}, {end_s}; allowed are a start up to 0, an end after it")
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
