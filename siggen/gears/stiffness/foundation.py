"""Compliance of the gear body under the tooth root (fillet foundation), and where its fitted polynomials hold.

Source: Sainsot, Velex and Duverger 2004, "Contribution of gear body to tooth deflections", with the half angle
theta_f of the root in rad, the full root arc S_f = 2 R_f theta_f and the lever u_f = R_b/cos(alpha_1) - R_f. Damage
never changes it (paper A).
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.spur_gear import SpurGear

# Rows L*, M*, P*, Q*; columns A to F of X* = A/theta^2 + B h^2 + C h/theta + D/theta + E h + F.
SAINSOT = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
SAINSOT.setflags(write=False)
FIT_RADIUS_RATIO = (1.4, 7.0)
FIT_ROOT_ANGLE_RAD = (0.01, 0.12)


def root_half_angle(gear: SpurGear, reading: str) -> float:
    """Return theta_f [rad]: 'profile' for the idealised root, 'rack' for the root a rack cuts."""
    return gear.rack_root_half_angle_rad if reading == "rack" else gear.root_half_angle_rad


def foundation_compliance(
    gear: SpurGear, roll: FloatArray, reading: str, youngs_modulus_pa: float, face_width_m: float
) -> FloatArray:
    """Return 1/k_f at the roll angles of the contact (k,) [m/N].

    Parameters
    ----------
    gear : SpurGear
    roll : (k,)
        Roll angle of the contact [rad].
    reading : str
        'profile' or 'rack': which tooth root theta_f belongs to.
    youngs_modulus_pa, face_width_m : float
        [Pa], [m].
    """
    angle = root_half_angle(gear, reading)
    ratio = gear.root_radius_m / gear.held_radius_m
    terms = np.array([angle**-2, ratio**2, ratio / angle, 1.0 / angle, ratio, 1.0])
    big_l, big_m, big_p, big_q = SAINSOT @ terms
    slant = roll - gear.base_half_angle_rad
    lever = gear.base_radius_m / np.cos(slant) - gear.root_radius_m
    share = lever / (2.0 * gear.root_radius_m * angle)
    bracket = big_l * share**2 + big_m * share + big_p * (1.0 + big_q * np.tan(slant) ** 2)
    return np.asarray(np.cos(slant) ** 2 * bracket / (youngs_modulus_pa * face_width_m))


def outside_foundation_fit(gear: SpurGear, reading: str) -> tuple[str, ...]:
    """Return what lies outside the published fit range, as sentences; empty inside it.

    Outside, the polynomials extrapolate; a rack-cut root of a small gear is the common case (18 teeth: theta_f 0.167
    rad).
    """
    found = []
    for name, value, (low, high) in (
        ("h_f = root radius / held radius", gear.root_radius_m / gear.held_radius_m, FIT_RADIUS_RATIO),
        ("theta_f [rad]", root_half_angle(gear, reading), FIT_ROOT_ANGLE_RAD),
    ):
        if not low <= value <= high:
            found.append(f"foundation fit: {name} is {value:.4g}; fitted range {low:g} to {high:g}")
    return tuple(found)
