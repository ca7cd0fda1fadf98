"""Deflection at one tooth by the load on a neighbour of the same gear, along the line of action.

Derived. The ring between hub and root circle twists under the moment F R_b and carries all its teeth along, which is
exact (R_b^2 (1/r_int^2 - 1/R_f^2)/(4 pi G L)). The rest is local. A tooth without load moves as a rigid body, and a
loaded one acts on the body by its resultants at the root (Saint-Venant). Let p = (cos a, sin a, u) of each tooth: a the
slant of the force against the tooth's normal, u = R_b - R_f cos a its lever about the root circle in modules. Then the
rest times E L is bilinear, p_lower' B p_upper. Mirroring the two teeth and reciprocity leave six entries of B free; one
of their products is sin(a_upper - a_lower), the same all along the line of action, and is left to the others. The other
five are Chebyshev polynomials of 1/z and ln h_f (root over held radius), fitted to finite elements
(`siggen.gears.stiffness.coupling_table`); two teeth apart have a table of their own, farther ones keep the ring's twist
only.

Bodies of helical gears also bend along the axis (`axial_body`), which moves neighbours too.
"""

from __future__ import annotations

from math import floor, pi, tan

import numpy as np
from numpy.polynomial import chebyshev

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import carrying_middle_m
from siggen.gears.geometry.internal_pair import RingGear
from siggen.gears.geometry.missing_material import CORNER_REACH_PITCHES
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.gears.stiffness.axial_body import axial_compliance
from siggen.gears.stiffness.calibration import RADIUS_RATIO_RANGE, TEETH_RANGE, unit_coordinates
from siggen.gears.stiffness.coupling_table import COUPLING_COEFFICIENTS
from siggen.gears.stiffness.foundation import root_half_angle
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

TERMS = 5


def body_coupling(pair: GearPair, options: StiffnessOptions, position_m: FloatArray) -> FloatArray:
    """Return the deflection of a pair per unit force on the pair 1, 2, ... base pitches ahead, (apart, k) [m/N].

    Parameters
    ----------
    pair : GearPair
    options : StiffnessOptions
        Zeros with coupling 'none'.
    position_m : (k,)
        Positions of the pair that entered later [m]; the other one is 1, 2, ... base pitches farther. Beyond its path
        of contact a tooth counts as touched at its tip.

    Returns
    -------
    (apart, k) array
        Both gears together, symmetric in the two pairs; as many rows as pairs can be in reach with corner contact, less
        one.

    Source: derived, see this module.
    """
    apart = max(1, floor(pair.contact_ratio + pair.overlap_ratio + 2.0 * CORNER_REACH_PITCHES))
    position = np.asarray(position_m, dtype=np.float64)
    out = np.zeros((apart, position.size))
    if options.coupling == "none":
        return out
    scale = pair.youngs_modulus_pa * pair.face_width_m
    behind = carrying_middle_m(pair, position)
    for row in range(apart):
        ahead = carrying_middle_m(pair, position + (row + 1) * pair.base_pitch_m)
        # The pair that entered later is nearer the pinion's root and nearer the gear's tip.
        on_gear = (pair.line_of_action_m - ahead) / pair.gear.base_radius_m
        both = neighbour_compliance(pair.pinion, behind / pair.pinion.base_radius_m, row + 1, pair.poisson_ratio)
        both = both + neighbour_compliance(pair.gear, on_gear, row + 1, pair.poisson_ratio)
        if pair.helix_rad != 0.0:
            both = both + _axial(pair, options, behind, ahead, row + 1)
        out[row] = both / scale
    return out


def _axial(
    pair: GearPair, options: StiffnessOptions, behind_m: FloatArray, ahead_m: FloatArray, apart: int
) -> FloatArray:
    """Return what both bodies do along the axis, as `neighbour_compliance`; contacts at two positions (k,) [m]."""
    found, line = np.zeros(behind_m.size), pair.line_of_action_m
    for gear, one, two in ((pair.pinion, behind_m, ahead_m), (pair.gear, line - ahead_m, line - behind_m)):
        angle, tip = root_half_angle(gear, options.root_reading), gear.tip_roll_rad
        lower, upper = (np.clip(along / gear.base_radius_m, 0.0, tip) for along in (one, two))
        found += axial_compliance(gear, pair.face_width_m, pair.poisson_ratio, angle, lower, upper, apart)
    return np.asarray(tan(pair.base_helix_rad) ** 2 * found)


def neighbour_compliance(gear: SpurGear, lower_roll: FloatArray, apart: int, poisson_ratio: float) -> FloatArray:
    """Return the deflection of one tooth of a gear per unit force on another, times E L (k,), dimensionless.

    Parameters
    ----------
    gear : SpurGear
        Outside the calibrated ranges of teeth and h_f the local rest is that of the nearest gear inside.
    lower_roll : (k,)
        Roll angle of the contact nearer the root [rad]; the other lies `apart` pitches higher, at most at the tip.
    apart : int
        Teeth between the two, plus one.
    poisson_ratio : float
        Enters the twist of the ring; the local rest is that of 0.3.

    Source: derived (finite elements, plane stress, bore clamped).
    """
    twist = ring_torsion(gear, poisson_ratio)
    if apart > COUPLING_COEFFICIENTS.shape[0]:
        return np.full(np.shape(lower_roll), twist)
    tip = gear.tip_roll_rad
    upper = np.clip(lower_roll + 2.0 * pi * apart / gear.teeth, 0.0, tip)
    terms = load_terms(gear, np.clip(lower_roll, 0.0, tip), upper)
    u, v, _ = unit_coordinates(
        float(np.clip(gear.teeth, *TEETH_RANGE)),
        float(np.clip(gear.root_radius_m / gear.held_radius_m, *RADIUS_RATIO_RANGE)),
        np.zeros(1),
    )
    entries = chebyshev.chebval(v, chebyshev.chebval(u, np.moveaxis(COUPLING_COEFFICIENTS[apart - 1], 0, -1)))
    return np.asarray(twist + entries @ terms)


def ring_torsion(gear: SpurGear, poisson_ratio: float) -> float:
    """Return R_b^2 (1/r_int^2 - 1/R_f^2)/(4 pi G) times E: the twist of the ring between held radius and root circle.

    Derived: the shear stress of a moment M is M/(2 pi r^2 L), and the rotation of the rim against the hub its strain
    over r, integrated over the radius. Times E L, dimensionless, for a unit force on the line of action.
    """
    if isinstance(gear, RingGear):
        return 0.0  # held all round
    squares = gear.held_radius_m**-2 - gear.root_radius_m**-2
    return float(gear.base_radius_m**2 * squares * (1.0 + poisson_ratio) / (2.0 * pi))


def outside_coupling(gear: SpurGear) -> tuple[str, ...]:
    """Return what lies outside the range of the fitted local rest, as sentences; empty inside it."""
    ratio = gear.root_radius_m / gear.held_radius_m
    checks = (("teeth", gear.teeth, TEETH_RANGE), ("h_f = root radius / held radius", ratio, RADIUS_RATIO_RANGE))
    return tuple(
        f"coupling: {name} is {value:.4g}; fitted range {low:g} to {high:g}"
        for name, value, (low, high) in checks
        if not low - 1e-9 <= value <= high + 1e-9
    )


def load_terms(gear: SpurGear, lower_roll: FloatArray, upper_roll: FloatArray) -> FloatArray:
    """Return the five products of root loads that the local rest is linear in, (5, k); contacts at two rolls (k,)."""
    c0, s0, u0 = _root_loads(gear, lower_roll)
    c1, s1, u1 = _root_loads(gear, upper_roll)
    return np.stack([c0 * c1, s0 * s1, u0 * u1, c0 * u1 + u0 * c1, s0 * u1 - u0 * s1])


def _root_loads(gear: SpurGear, roll: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    slant = roll - gear.base_half_angle_rad
    lever = (gear.base_radius_m - gear.root_radius_m * np.cos(slant)) / gear.module_m
    return np.cos(slant), np.sin(slant), lever
