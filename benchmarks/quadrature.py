"""Alternative: the potential-energy integrals by `scipy.integrate.quad`, one contact and one integral at a time.

Same equations as `siggen.gears.stiffness.compliance` (paper A, section 2.2) with the rack-cut fillet and the Sainsot
foundation, written as the formulas stand. Tooth profile and section of the pitted tooth are siggen's compiled
functions, so what is compared is the way of integrating.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from math import cos, pi, sin

import numpy as np
from numba import njit
from scipy.integrate import IntegrationWarning, quad

from siggen.arrays import FloatArray
from siggen.gears.damage.flank_damage import pit_rows
from siggen.gears.damage.tooth_damage import Damage, pits_of
from siggen.gears.damage.union import (
    active_pits,
    add_intervals,
    depth_moments,
    interval_room,
    lengths_covered,
    stretch_room,
)
from siggen.gears.geometry import involute, trochoid
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.gears.stiffness.compliance import SHEAR_FACTOR
from siggen.gears.stiffness.foundation import foundation_compliance
from siggen.gears.stiffness.mesh_stiffness import pairs_in_contact
from siggen.gears.stiffness.mesh_tables import pair_kinds
from siggen.gears.stiffness.pitted_beams import section_losses

RELATIVE_TOLERANCE = 1e-8
"""The only one: quad's own absolute tolerance, 1.5e-8, exceeds a compliance in m/N, and quad would stop at once."""


def mesh_stiffness_by_quad(pair: GearPair, angle_rad: float, damage: Damage = ()) -> float:
    """Return the mesh stiffness [N/m] at one pinion angle; as the function of that name."""
    _, count, position = pairs_in_contact(pair, np.array([angle_rad]))
    total = 0.0
    for n, s in zip(count.tolist(), position.tolist(), strict=True):
        teeth = (n % pair.pinion.teeth, n % pair.gear.teeth)
        first, second = (pit_rows(pits_of(damage, w, t)) for w, t in zip(("pinion", "gear"), teeth, strict=True))
        compliance = _contact(pair, s, first, second)
        compliance += _tooth(pair, pair.pinion, _rolls(pair, s)[0], first)
        compliance += _tooth(pair, pair.gear, _rolls(pair, s)[1], second)
        total += 1.0 / compliance
    return total


def pair_stiffness_by_quad(pair: GearPair, damage: Damage, position_m: float) -> FloatArray:
    """Return the stiffness of every kind of pair at one position (kinds,) [N/m]; as one column of `mesh_tables`."""
    kinds = pair_kinds(pair, damage)
    rolls = _rolls(pair, position_m)
    rows, tooth = {}, {}
    for which, column in (("pinion", 0), ("gear", 1)):
        for index in {kind[column] for kind in kinds}:
            rows[which, index] = pit_rows(pits_of(damage, which, index))
            tooth[which, index] = _tooth(pair, pair.member(which), rolls[column], rows[which, index])
    return np.array(
        [
            1.0
            / (_contact(pair, position_m, rows["pinion", i], rows["gear", j]) + tooth["pinion", i] + tooth["gear", j])
            for i, j in kinds
        ]
    )


def _rolls(pair: GearPair, position_m: float) -> tuple[float, float]:
    return position_m / pair.pinion.base_radius_m, (pair.line_of_action_m - position_m) / pair.gear.base_radius_m


def _contact(pair: GearPair, position_m: float, pinion_rows: FloatArray, gear_rows: FloatArray) -> float:
    heights = (
        np.array([involute.height(roll, gear.base_radius_m, gear.base_half_angle_rad)])
        for roll, gear in zip(_rolls(pair, position_m), (pair.pinion, pair.gear), strict=True)
    )
    first, second = heights
    lost = float(lengths_covered(first, pinion_rows, second, gear_rows, pair.face_width_m)[0])
    modulus = pair.youngs_modulus_pa / (1.0 - pair.poisson_ratio**2)
    return 4.0 / (pi * modulus * (pair.face_width_m - lost))


def _tooth(pair: GearPair, gear: SpurGear, roll: float, rows: FloatArray) -> float:
    """Return bending, shear, axial and foundation compliance of one tooth loaded at `roll` [m/N]."""
    slant = roll - gear.base_half_angle_rad
    across, along = cos(slant), sin(slant)
    load_height = involute.height(roll, gear.base_radius_m, gear.base_half_angle_rad)
    load_thickness = involute.half_thickness(roll, gear.base_radius_m, gear.base_half_angle_rad)
    young = pair.youngs_modulus_pa
    shear_modulus = young / (2.0 * (1.0 + pair.poisson_ratio))

    def bending(x: float, _area: float, inertia: float) -> float:
        return (across * (load_height - x) - along * load_thickness) ** 2 / (young * inertia)

    def shear(_x: float, area: float, _inertia: float) -> float:
        return SHEAR_FACTOR * across**2 / (shear_modulus * area)

    def axial(_x: float, area: float, _inertia: float) -> float:
        return along**2 / (young * area)

    foundation = foundation_compliance(gear, np.array([roll]), "rack", young, pair.face_width_m)
    beam = sum(_along_tooth(f, gear, roll, rows, pair.face_width_m) for f in (bending, shear, axial))
    return float(foundation[0]) + beam


def _along_tooth(
    density: Callable[[float, float, float], float], gear: SpurGear, roll: float, rows: FloatArray, width: float
) -> float:
    """Return the integral of `density(x, A, I)` dx from the root to the contact, fillet and involute."""
    fillet = (gear.rack_round_depth_m, gear.rack_round_offset_m, gear.rack_round_m, gear.pitch_radius_m)
    base_radius, half_angle, base_height = gear.base_radius_m, gear.base_half_angle_rad, gear.base_height_m

    def in_fillet(gamma: float) -> float:
        y, h = trochoid.trochoid_point(gamma, *fillet)
        slope = trochoid.trochoid_height_slope(gamma, *fillet)
        return -slope * density(y - base_height, 2.0 * h * width, 2.0 / 3.0 * h**3 * width)

    def on_involute(psi: float) -> float:
        x, area, inertia = _section(psi, base_radius, half_angle, rows, width)
        return base_radius * psi * cos(psi - half_angle) * density(x, area, inertia)

    with warnings.catch_warnings():
        # pits have kinks, which quad reports after having met its tolerance nearly everywhere
        warnings.simplefilter("ignore", IntegrationWarning)
        root = _quad(in_fillet, gear.involute_start_gamma_rad, 0.5 * pi)
        return root + _quad(on_involute, gear.involute_start_roll_rad, roll)


def _quad(function: Callable[[float], float], low: float, high: float) -> float:
    return float(quad(function, low, high, epsabs=0.0, epsrel=RELATIVE_TOLERANCE, limit=200)[0])


@njit(cache=True)
def _section(
    roll: float, base_radius: float, half_angle: float, pits: FloatArray, width: float
) -> tuple[float, float, float]:
    """Return height, area and second moment of the section at a roll angle of a tooth with pits (n, 13)."""
    x = involute.height(roll, base_radius, half_angle)
    h = involute.half_thickness(roll, base_radius, half_angle)
    area, inertia = 2.0 * h * width, 2.0 / 3.0 * h**3 * width
    room = pits.shape[0]
    if room == 0:
        return x, area, inertia
    intervals, active, moments = interval_room(room), np.empty(room, np.int64), np.empty(3)
    count = active_pits(x, pits, active)
    filled = add_intervals(x, pits, active, count, width, intervals, 0)
    depth_moments(x, pits, intervals, filled, stretch_room(room), moments)
    area_loss, inertia_loss = section_losses(h, width, moments)
    return x, area - area_loss, inertia - inertia_loss
