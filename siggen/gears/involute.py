"""Compiled involute tooth profile in roll-angle form: height, half thickness and their inverses.

Equations: derived; equal to the Yang-Lin / Tian / Liang expressions with alpha = alpha_2 - psi. With the base radius
R_b, the half tooth angle on the base circle alpha_2 and the roll angle psi (0 on the base circle):

    x(psi) = R_b [cos(psi - alpha_2) + psi sin(psi - alpha_2) - cos alpha_2]
    h(psi) = R_b [psi cos(psi - alpha_2) - sin(psi - alpha_2)]
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tan

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit


@njit(cache=True)
def height(roll: float, base_radius: float, half_angle: float) -> float:
    """Return the height x above the base-circle point along the tooth centre line [m].

    Written without the difference of two numbers near 1, so that x keeps its relative accuracy near psi = 0.
    """
    half = sin(0.5 * roll)
    rise = 2.0 * half * (roll * cos(0.5 * roll) - half)
    return base_radius * (cos(half_angle) * rise + sin(half_angle) * (sin(roll) - roll * cos(roll)))


@entry(cache=True)
def half_thickness(roll: float, base_radius: float, half_angle: float) -> float:
    """Return the half tooth thickness h normal to the tooth centre line [m]."""
    slant = roll - half_angle
    return base_radius * (roll * cos(slant) - sin(slant))


@njit(cache=True)
def roll_at_height(x: float, base_radius: float, half_angle: float) -> float:
    """Return the roll angle [rad] of the flank point at height x [m]; 0 below the base circle.

    Newton steps inside a shrinking bracket: dx/dpsi = R_b psi cos(psi - alpha_2) vanishes at psi = 0, where plain
    Newton fails.
    """
    if not x > 0.0:
        return 0.0
    low, high = 0.0, 0.5 * pi + half_angle
    roll = min(sqrt(2.0 * x / (base_radius * cos(half_angle))), 0.9 * high)
    for _ in range(100):
        excess = height(roll, base_radius, half_angle) - x
        if excess > 0.0:
            high = roll
        else:
            low = roll
        step = excess / (base_radius * roll * cos(roll - half_angle))
        trial = roll - step
        if not low <= trial <= high:
            trial = 0.5 * (low + high)
        if abs(trial - roll) <= 2e-16 * roll:
            return trial
        roll = trial
    return roll


@entry(cache=True)
def heights(roll: FloatArray, base_radius: float, half_angle: float) -> FloatArray:
    """Return `height` of every roll angle (k,) [m]."""
    out = np.empty(roll.size)
    for i in range(roll.size):
        out[i] = height(roll[i], base_radius, half_angle)
    return out


@entry(cache=True)
def half_thicknesses(roll: FloatArray, base_radius: float, half_angle: float) -> FloatArray:
    """Return `half_thickness` of every roll angle (k,) [m]."""
    out = np.empty(roll.size)
    for i in range(roll.size):
        out[i] = half_thickness(roll[i], base_radius, half_angle)
    return out


@entry(cache=True)
def rolls_at_heights(x: FloatArray, base_radius: float, half_angle: float) -> FloatArray:
    """Return `roll_at_height` of every height (k,) [rad]."""
    out = np.empty(x.size)
    for i in range(x.size):
        out[i] = roll_at_height(x[i], base_radius, half_angle)
    return out


def involute_function(angle_rad: float) -> float:
    """Return inv alpha = tan alpha - alpha."""
    return tan(angle_rad) - angle_rad


def inverse_involute(value: float) -> float:
    """Return the angle alpha in [0, pi/2) with tan alpha - alpha = value.

    Raises
    ------
    ValueError
        If the value is negative or not finite: no such angle exists.
    """
    if not 0.0 <= value < 1e6:
        raise ValueError(f"involute function value {value!r} has no angle; allowed: 0 to 1e6")
    low, high = 0.0, 0.5 * pi
    angle = min((3.0 * value) ** (1.0 / 3.0), 1.5) if value > 0.0 else 0.0
    for _ in range(200):
        if angle == 0.0:
            return 0.0
        excess = involute_function(angle) - value
        low, high = (low, angle) if excess > 0.0 else (angle, high)
        trial = angle - excess / tan(angle) ** 2
        if not low <= trial <= high:
            trial = 0.5 * (low + high)
        if abs(trial - angle) <= 2e-16:
            return trial
        angle = trial
    return angle
