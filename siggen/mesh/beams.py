"""Integrals of a healthy tooth as a cantilever beam, shared by all contact points of the flank.

Derived: with A = cos(alpha_1) d - sin(alpha_1) h_c and B = cos(alpha_1) the bending integrand is (A - B x)^2/(E I),
so that

    J0 = int dx/I,  J1 = int x dx/I,  J2 = int x^2 dx/I,  JA = int dx/A

from the foot of the beam to the contact carry everything about the tooth. Feet: the base circle (paper A), the root
circle (straight piece below the base circle, Liang/Zuo closed forms, memory of the literature) and the rack-cut
trochoid (Ma 2014).
"""

from __future__ import annotations

from functools import lru_cache
from math import cos, sin, sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.involute import half_thickness, height
from siggen.gears.quadrature import NODES_8, WEIGHTS_8
from siggen.gears.spur_gear import SpurGear
from siggen.gears.trochoid import trochoid_integrals

BEAMS = ("base_circle", "root_circle", "rack_trochoid")
PANEL_RAD = 0.05
"""Panel of 8 nodes: the integrand's nearest singularity is about 0.4 rad away, so the rule is exact to rounding."""


def first_roll(gear: SpurGear, beam: str) -> float:
    """Return the roll angle where the involute part of a beam starts [rad].

    Raises
    ------
    ValueError
        For an unknown beam, or when the whole involute is undercut.
    """
    if beam == "base_circle":
        return 0.0
    if beam == "root_circle":
        return gear.root_roll_rad
    if beam == "rack_trochoid":
        return gear.involute_start_roll_rad
    raise ValueError(f"received beam {beam!r}; allowed: {', '.join(BEAMS)}")


@lru_cache(maxsize=256)
def root_integrals(gear: SpurGear, beam: str, face_width_m: float) -> tuple[float, float, float, float]:
    """Return (J0, J1, J2, JA) of the part of a beam below its involute; all 0 for the base-circle beam.

    Units: 1/m^3, 1/m^2, 1/m, 1/m. The face width is in m. Source: closed forms of the straight piece (Liang/Zuo),
    trochoid as in `siggen.gears.trochoid`.
    """
    if beam == "rack_trochoid":
        values = trochoid_integrals(
            gear.involute_start_gamma_rad,
            gear.rack_round_depth_m,
            gear.rack_round_offset_m,
            gear.rack_round_m,
            gear.pitch_radius_m,
            gear.base_height_m,
            face_width_m,
        )
        return float(values[0]), float(values[1]), float(values[2]), float(values[3])
    if beam == "root_circle" and gear.root_radius_m < gear.base_radius_m:
        thickness = gear.base_radius_m * sin(gear.base_half_angle_rad)
        length = gear.base_height_m - sqrt(gear.root_radius_m**2 - thickness**2)
        per_inertia = 1.5 / (thickness**3 * face_width_m)
        return (
            length * per_inertia,
            -(length**2) / 2.0 * per_inertia,
            length**3 / 3.0 * per_inertia,
            length / (2.0 * thickness * face_width_m),
        )
    return 0.0, 0.0, 0.0, 0.0


@njit(cache=True)
def _add_panel(low: float, high: float, base_radius: float, half_angle: float, total: FloatArray) -> None:
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    for node in range(NODES_8.size):
        roll = middle + half * NODES_8[node]
        x = height(roll, base_radius, half_angle)
        h = half_thickness(roll, base_radius, half_angle)
        dx = half * WEIGHTS_8[node] * base_radius * roll * cos(roll - half_angle)
        per_inertia = 1.5 * dx / (h * h * h)
        total[0] += per_inertia
        total[1] += x * per_inertia
        total[2] += x * x * per_inertia
        total[3] += 0.5 * dx / h


@njit(cache=True)
def _panel_width(roll: float, base_radius: float, half_angle: float) -> float:
    """Return the panel that starts at `roll`; short where the tooth thins: a pointed tip is a singularity."""
    thinning = base_radius * roll * sin(roll - half_angle)
    if thinning <= 0.0:
        return PANEL_RAD
    return max(min(PANEL_RAD, 0.5 * half_thickness(roll, base_radius, half_angle) / thinning), 1e-6)


@entry(cache=True)
def involute_integrals(
    rolls: FloatArray, start: float, base_radius: float, half_angle: float, face_width: float
) -> FloatArray:
    """Return (J0, J1, J2, JA) from the roll angle `start` to each of the rolls, (4, k) [1/m^3, 1/m^2, 1/m, 1/m].

    Rolls in rad, in any order; base radius and face width in m. Source: derived.

    Integrated in the roll angle, where x has no square-root branch at the base circle. Full panels are summed once,
    each contact adds its own piece of a panel: a contact's result is the same to the bit whatever other contacts come
    along.
    """
    out = np.empty((4, rolls.size))
    last = start
    for i in range(rolls.size):
        last = max(last, rolls[i])
    ends = [start]
    while ends[-1] < last:
        ends.append(ends[-1] + _panel_width(ends[-1], base_radius, half_angle))
    sums = np.zeros((len(ends), 4))
    for k in range(1, len(ends) - 1):
        for m in range(4):  # not whole rows, here and below: what numba compiles for those costs a second
            sums[k, m] = sums[k - 1, m]
        _add_panel(ends[k - 1], ends[k], base_radius, half_angle, sums[k])
    lows = np.array(ends)
    total = np.empty(4)
    for i in range(rolls.size):
        k = min(max(np.searchsorted(lows, rolls[i], side="right") - 1, 0), max(lows.size - 2, 0))
        for m in range(4):
            total[m] = sums[k, m]
        if rolls[i] > lows[k]:
            _add_panel(lows[k], rolls[i], base_radius, half_angle, total)
        for m in range(4):
            out[m, i] = total[m] / face_width
    return out


def beam_integrals(gear: SpurGear, beam: str, rolls: FloatArray, face_width_m: float) -> FloatArray:
    """Return (J0, J1, J2, JA) of a healthy tooth from the foot of the beam to each of the rolls, (4, k).

    Parameters
    ----------
    gear : SpurGear
    beam : str
        'base_circle', 'root_circle' or 'rack_trochoid'.
    rolls : (k,)
        Roll angles of the contacts, in any order; below the beam's first roll as at it [rad].
    face_width_m : float
        [m].

    Returns
    -------
    (4, k) array
        [1/m^3, 1/m^2, 1/m, 1/m].

    Raises
    ------
    ValueError
        For an unknown beam, or when the whole involute is undercut.

    Source: derived.
    """
    root = np.array(root_integrals(gear, beam, face_width_m))
    flank = involute_integrals(
        rolls, first_roll(gear, beam), gear.base_radius_m, gear.base_half_angle_rad, face_width_m
    )
    return root[:, np.newaxis] + flank
