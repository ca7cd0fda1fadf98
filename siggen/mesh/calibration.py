"""Factor that turns the rack-trochoid tooth compliance into that of finite elements.

Derived: ratio of a plane-stress finite-element tooth on its ring to the sum of bending, shear, axial and fillet-
foundation compliance (Ma 2014 beam, Sainsot 2004 foundation with the rack's root angle), as a smooth function of
the number of teeth z, the ratio h_f of root to held radius and the place t on the flank (0 at the involute start, 1
at the tip, linear in the roll angle), with corrections for profile shift X and pressure angle alpha_0:

    factor = F(1/z, ln h_f, t) [1 + X G1 + X^2 G2 + a G3]        a = (alpha_0 - 20 deg)/(5 deg)

F, G1, G2, G3 are tensor products of Chebyshev polynomials. Poisson's ratio is 0.3 and the rack standard (ha 1, c
0.25).
"""

from __future__ import annotations

from math import log, radians, sin

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from siggen.arrays import FloatArray
from siggen.gears.spur_gear import SpurGear
from siggen.mesh.calibration_table import (
    ANGLE_COEFFICIENTS,
    MAIN_COEFFICIENTS,
    SHIFT_COEFFICIENTS,
    SHIFT_SQUARED_COEFFICIENTS,
)

TEETH_RANGE = (17.0, 100.0)
RADIUS_RATIO_RANGE = (1.4, 7.0)
PROFILE_SHIFT_RANGE = (-0.5, 0.5)
PRESSURE_ANGLE_RANGE_RAD = (radians(17.5), radians(25.0))
ADDENDUM_RANGE = (1.0, 1.0)
CLEARANCE_RANGE = (0.2, 0.3)
TOLERATED_UNDERCUT = 0.01
"""Missing profile shift up to which undercut changes nothing: 17 standard teeth miss 0.006."""


def calibration_factor(gear: SpurGear, roll: ArrayLike) -> FloatArray:
    """Return finite-element compliance / rack-trochoid compliance of a healthy tooth (k,).

    Parameters
    ----------
    gear : SpurGear
        The gear; a quantity outside its range counts as the nearest end of the range (see `outside_calibration`).
    roll : (k,)
        Roll angle of the contact [rad]; below the involute start and above the tip as at those points.

    Returns
    -------
    (k,) array
        Dimensionless, multiplies bending + shear + axial + foundation.

    Source: derived (finite elements, plane stress, one tooth on its ring with the bore clamped).
    """
    teeth = np.clip(gear.teeth, *TEETH_RANGE)
    ratio = np.clip(gear.root_radius_m / gear.held_radius_m, *RADIUS_RATIO_RANGE)
    start, tip = gear.involute_start_roll_rad, gear.tip_roll_rad
    place = np.clip((np.asarray(roll, dtype=np.float64) - start) / (tip - start), 0.0, 1.0)
    shift = np.clip(gear.profile_shift, *PROFILE_SHIFT_RANGE)
    slant = np.clip(gear.pressure_angle_rad, *PRESSURE_ANGLE_RANGE_RAD)
    return table_factor(teeth, ratio, shift, slant, place)


def table_factor(
    teeth: float, radius_ratio: float, profile_shift: float, pressure_angle_rad: float, place: FloatArray
) -> FloatArray:
    """Return the factor from the table's own coordinates, shape of `place` (0 at the involute start, 1 at the tip)."""
    u, v, w = unit_coordinates(teeth, radius_ratio, place)
    main, first, second, angle = (
        _tensor(c, u, v, w)
        for c in (MAIN_COEFFICIENTS, SHIFT_COEFFICIENTS, SHIFT_SQUARED_COEFFICIENTS, ANGLE_COEFFICIENTS)
    )
    shift, slant = profile_shift, angle_step(pressure_angle_rad)
    return main * (1.0 + shift * first + shift**2 * second + slant * angle)


def unit_coordinates(teeth: float, radius_ratio: float, place: FloatArray) -> tuple[float, float, FloatArray]:
    """Return 1/z, ln(h_f) and the place on the flank, each scaled to -1 .. 1 over the validity range."""
    return (
        _unit(1.0 / teeth, 1.0 / TEETH_RANGE[1], 1.0 / TEETH_RANGE[0]),
        _unit(log(radius_ratio), log(RADIUS_RATIO_RANGE[0]), log(RADIUS_RATIO_RANGE[1])),
        2.0 * place - 1.0,
    )


def angle_step(pressure_angle_rad: float) -> float:
    """Return the pressure angle's distance from 20 deg in units of 5 deg."""
    return (pressure_angle_rad - radians(20.0)) / radians(5.0)


def _unit(value: float, low: float, high: float) -> float:
    return (2.0 * value - low - high) / (high - low)


def _tensor(coefficients: FloatArray, u: float, v: float, w: FloatArray) -> FloatArray:
    # chebval sums over the first axis and moves none: the result of each step keeps the remaining axes.
    along = chebyshev.chebval(v, chebyshev.chebval(u, coefficients))
    return np.asarray(chebyshev.chebval(w, along))


def outside_calibration(gear: SpurGear) -> tuple[str, ...]:
    """Return what lies outside the calibrated range, as sentences; empty inside it.

    Outside, the factor of the nearest gear inside the range is used; an undercut tooth has no exact counterpart there.
    """
    checks = (
        ("teeth", gear.teeth, TEETH_RANGE),
        ("h_f = root radius / held radius", gear.root_radius_m / gear.held_radius_m, RADIUS_RATIO_RANGE),
        ("profile shift", gear.profile_shift, PROFILE_SHIFT_RANGE),
        ("pressure angle [rad]", gear.pressure_angle_rad, PRESSURE_ANGLE_RANGE_RAD),
        ("addendum coefficient", gear.addendum_coefficient, ADDENDUM_RANGE),
        ("clearance coefficient", gear.clearance_coefficient, CLEARANCE_RANGE),
    )
    found = [
        f"calibration: {name} is {value:.4g}; calibrated range {low:.4g} to {high:.4g}"
        for name, value, (low, high) in checks
        if not low - 1e-9 <= value <= high + 1e-9
    ]
    missing = gear.addendum_coefficient - 0.5 * gear.teeth * sin(gear.pressure_angle_rad) ** 2 - gear.profile_shift
    if missing > TOLERATED_UNDERCUT:
        needed = f"profile shift {missing:.4g} too small"
        found.append(f"calibration: undercut tooth ({needed}); calibrated are teeth with a whole involute")
    return tuple(found)
