"""Tooth root cut by a rack: the trochoid that the rack's tip round envelopes, and where it hands over to the involute.

Equations: Ma 2014 (rack-cut fillet), generalised here to a profile shift X (derived): the shift moves the rack away
from the gear, so the depth of the round's centre below the rolling line is a1 = (ha + c - rho - X) m, while its
distance b1 from the tooth's centre line is fixed in the rack. The parameter gamma is the slope of the common normal:
pi/2 at the root, alpha_0 at the involute.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tan

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.quadrature import NODES_48, WEIGHTS_48


@entry(cache=True)
def trochoid_point(
    gamma: float, depth_m: float, offset_m: float, round_m: float, pitch_radius_m: float
) -> tuple[float, float]:
    """Return height above the gear centre and half thickness of the trochoid at `gamma` [m].

    `depth_m` is a1, `offset_m` b1 and `round_m` the radius of the rack's tip round.
    """
    turn = (depth_m / tan(gamma) + offset_m) / pitch_radius_m
    lever = depth_m / sin(gamma) + round_m
    height = pitch_radius_m * cos(turn) - lever * sin(gamma - turn)
    thickness = pitch_radius_m * sin(turn) - lever * cos(gamma - turn)
    return height, thickness


@njit(cache=True)
def trochoid_height_slope(
    gamma: float, depth_m: float, offset_m: float, round_m: float, pitch_radius_m: float
) -> float:
    """Return d height / d gamma [m/rad]; negative, since gamma falls from the root to the involute."""
    turn = (depth_m / tan(gamma) + offset_m) / pitch_radius_m
    turn_slope = -depth_m / (pitch_radius_m * sin(gamma) ** 2)
    lever = depth_m / sin(gamma) + round_m
    lever_slope = -depth_m * cos(gamma) / sin(gamma) ** 2
    return (
        -pitch_radius_m * sin(turn) * turn_slope
        - lever_slope * sin(gamma - turn)
        - lever * cos(gamma - turn) * (1.0 - turn_slope)
    )


@entry(cache=True)
def trochoid_integrals(
    last_gamma: float,
    depth_m: float,
    offset_m: float,
    round_m: float,
    pitch_radius_m: float,
    base_height_m: float,
    face_width_m: float,
) -> FloatArray:
    """Return int dx/I, int x dx/I, int x^2 dx/I and int dx/A from the root to `last_gamma` (4,), without 1/E.

    Units: 1/m^3, 1/m^2, 1/m, 1/m. x counts from `base_height_m`, the height of the base-circle point; the other
    lengths are those of `trochoid_point`. Four panels of 48 nodes: the integrand is analytic.
    """
    out = np.zeros(4)
    panels = 4
    width = (0.5 * pi - last_gamma) / panels
    for panel in range(panels):
        middle = 0.5 * pi - (panel + 0.5) * width
        for node in range(NODES_48.size):
            gamma = middle - 0.5 * width * NODES_48[node]
            y, h = trochoid_point(gamma, depth_m, offset_m, round_m, pitch_radius_m)
            slope = trochoid_height_slope(gamma, depth_m, offset_m, round_m, pitch_radius_m)
            dx = -slope * 0.5 * width * WEIGHTS_48[node]
            x = y - base_height_m
            per_inertia = dx * 1.5 / (h**3 * face_width_m)
            out[0] += per_inertia
            out[1] += x * per_inertia
            out[2] += x * x * per_inertia
            out[3] += dx / (2.0 * h * face_width_m)
    return out


def undercut_handover(
    pressure_angle_rad: float,
    depth_m: float,
    offset_m: float,
    round_m: float,
    pitch_radius_m: float,
    base_half_angle_rad: float,
) -> tuple[float, float]:
    """Return (gamma, roll) where the trochoid of an undercut tooth crosses the involute [rad].

    Derived: beyond the crossing the round has cut the involute away. Along the trochoid the radius grows, so the
    polar half angle of trochoid and involute at equal radius changes sign once between the base circle and the
    trochoid's end.

    Raises
    ------
    ValueError
        If they do not cross: the whole flank is cut away.
    """
    from scipy.optimize import brentq

    base_radius = pitch_radius_m * cos(pressure_angle_rad)

    def surplus(gamma: float) -> float:
        y, h = trochoid_point(gamma, depth_m, offset_m, round_m, pitch_radius_m)
        roll = sqrt(max((y * y + h * h) / base_radius**2 - 1.0, 0.0))
        return float(np.arctan2(h, y) - (base_half_angle_rad - (roll - np.arctan(roll))))

    def above_base(gamma: float) -> float:
        y, h = trochoid_point(gamma, depth_m, offset_m, round_m, pitch_radius_m)
        return float(y * y + h * h - base_radius**2)

    try:
        on_base = brentq(above_base, pressure_angle_rad, 0.5 * pi, xtol=1e-15)
        gamma = brentq(surplus, pressure_angle_rad, on_base, xtol=1e-15)
    except ValueError as error:
        raise ValueError(
            "the rack's tip round cuts the whole involute away; allowed: more teeth or profile shift"
        ) from error
    y, h = trochoid_point(gamma, depth_m, offset_m, round_m, pitch_radius_m)
    return float(gamma), sqrt(max((y * y + h * h) / base_radius**2 - 1.0, 0.0))
