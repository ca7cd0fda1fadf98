"""Power that sliding friction takes from a mesh with equal load sharing, and its closed form, the loss factor H_V.

P = μ ⟨Σ N |v_s|⟩ over one base pitch, N = T_m/(R_b1 · number of pairs in contact) (derived); in closed form P = μ H_V
P_in, H_V = (i + 1) π/(z_1 i) (1 - ε + ε_1² + ε_2²) for 1 <= ε <= 2 (reference: standard literature, Ohlendorf). The two
agree to rounding; 18/47 teeth, module 3 mm: H_V = 0.171.
"""

from __future__ import annotations

from math import pi

import numpy as np

from siggen.gears.gear_pair import GearPair
from siggen.mesh.friction import FrictionLaw, friction_coefficient
from siggen.mesh.lubrication import sliding_speed


def loss_factor(pair: GearPair) -> float:
    """Return H_V of the closed form.

    Raises
    ------
    ValueError
        If the contact ratio is outside 1 to 2, for which the formula was derived.
    """
    if not 1.0 <= pair.contact_ratio <= 2.0:
        raise ValueError(f"contact ratio: received {pair.contact_ratio:.4g}; allowed for the closed form are 1 to 2")
    ratio = pair.gear.teeth / pair.pinion.teeth
    recess = (pair.contact_end_m - pair.pitch_point_m) / pair.base_pitch_m
    approach = (pair.pitch_point_m - pair.contact_start_m) / pair.base_pitch_m
    bracket = 1.0 - pair.contact_ratio + recess**2 + approach**2
    return (ratio + 1.0) * pi / (pair.pinion.teeth * ratio) * bracket


def mesh_power_loss(
    pair: GearPair, coefficient: float, torque_nm: float, speed_rad_s: float, points: int = 20001
) -> float:
    """Return the mean power loss [W] of a constant friction coefficient, by the midpoint rule over one base pitch.

    Parameters
    ----------
    pair : GearPair
        Of any contact ratio.
    coefficient : float
    torque_nm, speed_rad_s : float
        Torque and speed of the pinion.
    points : int
        Cells; the error is about ε/points, from the cells in which a pair enters or leaves.
    """
    newest = pair.contact_start_m + pair.base_pitch_m * (np.arange(points) + 0.5) / points
    position = newest + pair.base_pitch_m * np.arange(int(pair.contact_ratio) + 1)[:, None]
    inside = position <= pair.contact_end_m
    share = inside / inside.sum(axis=0)
    gear_speed = speed_rad_s * pair.pinion.teeth / pair.gear.teeth
    slide = np.abs(sliding_speed(position, pair.line_of_action_m, speed_rad_s, gear_speed, 0.0))
    force = torque_nm / pair.pinion.base_radius_m
    return float(coefficient * force * (share * slide).sum(axis=0).mean())


def mesh_mean_friction(pair: GearPair, law: FrictionLaw, torque_nm: float, points: int = 200) -> float:
    """Return the coefficient that loses the same power, Σ μ N |v|/Σ N |v| over one base pitch, with equal load sharing.

    That is what formulas fitted to measured losses give. The sliding speed |v| is proportional to the distance from the
    pitch point.
    """
    force = torque_nm / pair.pinion.base_radius_m
    lost, slid = 0.0, 0.0
    for start in pair.contact_start_m + pair.base_pitch_m * (np.arange(points) + 0.5) / points:
        places = start + pair.base_pitch_m * np.arange(int(pair.contact_ratio) + 1)
        places = places[places <= pair.contact_end_m]
        for place in places:
            power = abs(place - pair.pitch_point_m) / places.size
            lost += power * friction_coefficient(law, 0, place, force / places.size)
            slid += power
    return lost / slid


def schlenk_mean_friction(
    line_load_n_per_m: float,
    pitch_line_speed_m_s: float,
    pressure_angle_rad: float,
    pitch_radius_m: float,
    viscosity_pa_s: float,
    roughness_m: float,
    oil_factor: float = 0.846,
) -> float:
    """Return Schlenk's mean friction coefficient of a mesh (ISO/TR 14179-2).

    Parameters
    ----------
    line_load_n_per_m : float
        Transverse tangential force on the base circle over the face width [N/m].
    pitch_line_speed_m_s : float
    pressure_angle_rad : float
        Working pressure angle; the sum speed at the pitch point is 2 v_t sin α_w.
    pitch_radius_m : float
        Relative radius of curvature at the pitch point [m].
    viscosity_pa_s : float
        At the oil's temperature.
    roughness_m : float
        Arithmetic mean roughness of pinion and gear [m].
    oil_factor : float
        0.846 mineral, 0.65 polyalphaolefin.
    """
    speed = 2.0 * pitch_line_speed_m_s * np.sin(pressure_angle_rad)
    group = (line_load_n_per_m * 1e-3) / (speed * pitch_radius_m * 1e3)
    rough = roughness_m * 1e6
    return float(0.048 * group**0.2 * (viscosity_pa_s * 1e3) ** -0.05 * rough**0.25 * oil_factor)
