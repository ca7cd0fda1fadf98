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
from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

FloatArray = NDArray[np.float64]

KNOTS_PER_CORNER_PERIOD = 16
"""Knots per 1/f_c: the spline damps the process by 2.6 % at the corner and cuts it off around 8 f_c."""


@dataclass(frozen=True, slots=True)
class SlowVariation:
    """One realisation; `largest` bounds |value| at all times."""

    _value: BSpline
    _slope: BSpline
    _integral: BSpline
    _offset: float
    largest: float

    def value(self, time_s: FloatArray) -> FloatArray:
        """Return n (k,) at the times (k,) [s]."""
        return np.asarray(self._value(time_s), dtype=np.float64)

    def slope(self, time_s: FloatArray) -> FloatArray:
        """Return dn/dt (k,) [1/s]."""
        return np.asarray(self._slope(time_s), dtype=np.float64)

    def integral(self, time_s: FloatArray) -> FloatArray:
        """Return the integral (k,) [s] of n from time 0."""
        return np.asarray(self._integral(time_s), dtype=np.float64) - self._offset


def slow_variation(rng: np.random.Generator, corner_hz: float, start_s: float, end_s: float) -> SlowVariation:
    """Return a realisation that covers `start_s` to `end_s`; a later end leaves what is before it as it was.

    Raises
    ------
    ValueError
        If the corner is not positive and finite, or the time 0 is not between start and end.
    """
    from scipy.interpolate import BSpline

    if not (np.isfinite(corner_hz) and corner_hz > 0.0):
        raise ValueError(f"corner_hz: received {corner_hz}; allowed are finite frequencies above 0")
    if not start_s <= 0.0 < end_s:
        raise ValueError(
            f"start_s, end_s: received {start_s}, {end_s}; allowed are a start up to 0 and an end after it"
        )
    step_s = 1.0 / (KNOTS_PER_CORNER_PERIOD * corner_hz)
    intervals = int(np.ceil((end_s - start_s) / step_s))
    keep = float(np.exp(-2.0 * np.pi * corner_hz * step_s))
    variance = (2416.0 + 2.0 * (1191.0 * keep + 120.0 * keep**2 + keep**3)) / 5040.0
    coefficients = _process(rng.standard_normal(intervals + 3), keep) / np.sqrt(variance)
    knots = start_s + step_s * np.arange(-3.0, intervals + 4.0)
    value = BSpline(knots, coefficients, 3)
    integral = value.antiderivative()
    return SlowVariation(value, value.derivative(), integral, float(integral(0.0)), float(np.abs(coefficients).max()))


@njit(cache=True)
def _process(normals: FloatArray, keep: float) -> FloatArray:
    """Return the process (k,) at its knots, stationary from the first."""
    result = np.empty_like(normals)
    result[0] = normals[0]
    fresh = np.sqrt(1.0 - keep * keep)
    for i in range(1, normals.size):
        result[i] = keep * result[i - 1] + fresh * normals[i]
    return result
