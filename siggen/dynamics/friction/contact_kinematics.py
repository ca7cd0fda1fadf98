"""Rolling and sliding speeds, relative radius and Hertz pressure of a spur gear contact on the line of action.

Equations: reference, standard literature (involute kinematics; Hertz line contact). With s the distance of the contact
from the pinion's base tangent point and T the length of the line of action: u_1 = Ω_1 s, u_2 = Ω_2 (T - s),
R_e = s (T - s)/T, p_H = √(F_l E*/(π R_e)), a_H = √(4 F_l R_e/(π E*)). The effective modulus E' = 2 E* is the one that
film formulas use. Verified: at the pitch point of 18/47 teeth, module 3 mm, 30 N m, 30 Hz they give u_e = 1.741 m/s,
R_e = 6.678 mm, p_H = 0.565 GPa and a_H = 66.6 µm, and p_H a_H π/2 is the line load.

Every function takes numbers or arrays that broadcast.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Values: TypeAlias = float | NDArray[np.float64]
"""A number or an array; functions of several broadcast."""


def effective_modulus(youngs_modulus_pa: float, poisson_ratio: float) -> float:
    """Return E' = 2/[(1 - ν²)/E + (1 - ν²)/E] of two gears of one material [Pa]; the reduced modulus E* is half of it.

    Raises
    ------
    ValueError
        If the modulus is not positive and finite or Poisson's ratio is outside 0 to 0.5.
    """
    if not (np.isfinite(youngs_modulus_pa) and youngs_modulus_pa > 0.0):
        raise ValueError(f"youngs_modulus_pa: received {youngs_modulus_pa}; allowed are finite values above 0")
    if not 0.0 <= poisson_ratio <= 0.5:
        raise ValueError(f"poisson_ratio: received {poisson_ratio}; allowed are 0 to 0.5")
    return youngs_modulus_pa / (1.0 - poisson_ratio**2)


def relative_radius(position_m: Values, line_m: float) -> Values:
    """Return R_e = ρ_1 ρ_2/(ρ_1 + ρ_2) at positions s on a line of action of length T [m]."""
    return position_m * (line_m - position_m) / line_m


def sliding_speed(
    position_m: Values, line_m: float, speed_1_rad_s: Values, speed_2_rad_s: Values, lateral_rate_m_s: Values
) -> Values:
    """Return the velocity of the pinion's flank relative to the gear's along the flank [m/s].

    Parameters
    ----------
    position_m : s
    line_m : T
    speed_1_rad_s, speed_2_rad_s : Ω_1 + θ̇_1 and Ω_2 + θ̇_2, the actual speeds.
    lateral_rate_m_s : ẋ_1 - ẋ_2, off the line of action.
    """
    return position_m * speed_1_rad_s - (line_m - position_m) * speed_2_rad_s + lateral_rate_m_s


def entrainment_speed(position_m: Values, line_m: float, speed_1_rad_s: Values, speed_2_rad_s: Values) -> Values:
    """Return u_e = (u_1 + u_2)/2 [m/s]."""
    return 0.5 * (position_m * speed_1_rad_s + (line_m - position_m) * speed_2_rad_s)


def hertz_pressure(line_load_n_per_m: Values, radius_m: Values, effective_modulus_pa: float) -> Values:
    """Return the peak pressure p_H [Pa] of a line load F_l [N/m] on a relative radius R_e [m] (E' goes in)."""
    return np.sqrt(line_load_n_per_m * (0.5 * effective_modulus_pa) / (np.pi * radius_m))


def hertz_half_width(line_load_n_per_m: Values, radius_m: Values, effective_modulus_pa: float) -> Values:
    """Return half the width b [m] of the contact of a line load F_l [N/m] on a relative radius R_e [m] (E' goes in)."""
    return np.sqrt(line_load_n_per_m * radius_m * 8.0 / (np.pi * effective_modulus_pa))
