r"""Compliance of the contact between two teeth: the linear law, and one that depends on the force.

With E, nu of both gears, contact length L, normal force F and the contact half width a_H,
a_H^2 = 8 F R_e (1 - nu^2)/(pi E L), R_e = rho_1 rho_2/(rho_1 + rho_2):

    linear            1/k = 4 (1 - nu^2)/(pi E L)                                              (Yang and Sun)
    weber_banaschek   1/k = 4 (1 - nu^2)/(pi E L) [ln(2 sqrt(h_1 h_2)/a_H) - nu/(2 (1 - nu))]

Both are secant compliances, deflection over force. `weber_banaschek` is derived: under an elliptic pressure the
surface of a half plane approaches a point at depth h >> a_H by 2 F (1 - nu^2)/(pi E L) [ln(2 h/a_H) - nu/(2 (1 - nu))]
(plane strain; Johnson, Contact Mechanics, section 5.6), and both teeth add; h_i is the distance from the contact to
the tooth's centre line along the line of action, h(psi)/cos(alpha_1), beyond which bending takes over.

`linear` is `weber_banaschek` with a bracket of 1, which is 3 to 5 for teeth: it makes the contact that much too stiff,
but is what paper A's kind of model uses. The force is one number for all contacts, the mesh force in single-pair
contact. Where two pairs share the load the bracket is ln(2)/2 = 0.35 too small for half the force, which is a tenth of
the contact's compliance and 2 % of the pair's: less than what the laws differ by, and a table stays one per specimen
and state.
"""

from __future__ import annotations

from math import cos, pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair
from siggen.names import Side

LARGEST_HALF_WIDTH = 0.5
"""Largest a_H/h_i that `weber_banaschek` reckons with. There the logarithm is 6 % off the exact approach of the half
plane (at 0.25: 1 %, measured); a wider contact, on the last remains of a pitted face, keeps this ratio."""


def linear_compliance(pair: GearPair, length_m: FloatArray) -> FloatArray:
    """Return 1/k = 4 (1 - nu^2)/(pi E L) of contacts of length L (k,) [m/N].

    Parameters
    ----------
    pair : GearPair
    length_m : (k,)
        Contact lengths, above 0 [m].

    Source: Yang and Sun; once per pair, equal materials.
    """
    return 4.0 / (pi * _plane_modulus(pair) * length_m)


def weber_banaschek_compliance(
    pair: GearPair, roll_pinion: FloatArray, roll_gear: FloatArray, length_m: FloatArray, force_n: float
) -> FloatArray:
    """Return the secant compliance of contacts at roll angles and of length L (k,) [m/N].

    Parameters
    ----------
    pair : GearPair
    roll_pinion, roll_gear : (k,)
        Roll angles of the contact on the two flanks, above 0 [rad].
    length_m : (k,)
        Contact lengths, above 0 [m].
    force_n : float
        Normal force of the pair, above 0 [N].

    Source: Weber and Banaschek 1953, derived as in this module's docstring.
    """
    first = centre_line_depth(pair, Side.DRIVER, roll_pinion)
    second = centre_line_depth(pair, Side.DRIVEN, roll_gear)
    width = contact_half_width(pair, roll_pinion, roll_gear, length_m, force_n)
    width = np.minimum(width, LARGEST_HALF_WIDTH * np.minimum(first, second))
    poisson = pair.poisson_ratio
    bracket = np.log(2.0 * np.sqrt(first * second) / width) - poisson / (2.0 * (1.0 - poisson))
    return linear_compliance(pair, length_m) * bracket


def contact_half_width(
    pair: GearPair, roll_pinion: FloatArray, roll_gear: FloatArray, length_m: FloatArray, force_n: float
) -> FloatArray:
    """Return Hertz's half width a_H of contacts at roll angles (k,) [m].

    Parameters as in `weber_banaschek_compliance`. Radii of curvature are rho_i = R_bi psi_i. Source: Hertz, parallel
    cylinders.
    """
    first, second = roll_pinion * pair.pinion.base_radius_m, roll_gear * pair.gear.signed_base_radius_m
    radius = first * second / (first + second)
    return np.sqrt(8.0 * force_n * radius / (pi * _plane_modulus(pair) * length_m))


def centre_line_depth(pair: GearPair, side: Side, roll: FloatArray) -> FloatArray:
    """Return the distance from contact to tooth centre line along the line of action, h/cos(alpha_1), (k,) [m].

    Parameters
    ----------
    pair : GearPair
    side : Side
        Of which it is.
    roll : (k,)
        Roll angles of the contact [rad].

    Raises
    ------
    ValueError
        For any other gear name.

    Source: derived; alpha_1 is the angle between load and the normal to the centre line.
    """
    gear = pair.member(side)
    return gear.half_thickness_m(roll) / np.cos(roll - gear.base_half_angle_rad)


def _plane_modulus(pair: GearPair) -> float:
    # Of a helical pair length and force are those of the transverse plane: see `helical`.
    return pair.youngs_modulus_pa / (1.0 - pair.poisson_ratio**2) * cos(pair.base_helix_rad)
