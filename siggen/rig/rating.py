"""The torque that a gear pair is rated for, and a face width for its module.

Stresses as ISO 6336-2 and -3 define the nominal ones, with the limits of ISO 6336-5 for case-hardened steel of quality
MQ: 1500 MPa at the flank, 860 MPa at the root. Factors that a drawing does not give are assumed: 2 for what the load
varies and how it spreads (K_A K_v K_Hβ K_Hα), safeties of 1.2 at the flank and 1.5 at the root, form and stress
correction of the root together 4.3 (17 teeth and more: 4.1 to 4.5), zone and contact ratio as at the pitch point.
"""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt

FACE_OVER_MODULE = 8.0
"""Usual are 8 to 16 modules (Norton, Machine Design); the least, since plain flanks bear a narrow face best."""
LOAD_FACTOR = 2.0
LARGEST_FLANK_PA, LARGEST_ROOT_PA = 1500e6, 860e6
FLANK_PA = LARGEST_FLANK_PA / 1.2 / sqrt(LOAD_FACTOR)
ROOT_PA = LARGEST_ROOT_PA / 1.5 / LOAD_FACTOR
ROOT_FACTOR = 4.3
EFFECTIVE_MODULUS_PA = 206e9 / (2.0 * (1.0 - 0.3**2))
RULE = (
    f"Hertz pressure {1e-6 * FLANK_PA:.0f} MPa, root {1e-6 * ROOT_PA:.0f} MPa: ISO 6336-5 case-hardened MQ, "
    f"load factor {LOAD_FACTOR:g}, safeties 1.2 and 1.5"
)


def proposed_face_width_mm(module_mm: float) -> float:
    """Return eight modules [mm]."""
    return FACE_OVER_MODULE * module_mm


def rated_torque_nm(
    teeth: tuple[int, int], module_mm: float, face_width_mm: float, pressure_angle_deg: float = 20.0
) -> float:
    """Return the largest torque on the pinion that stresses neither flank nor root of a steel pair too far [N m]."""
    return _torque_nm(teeth, module_mm, face_width_mm, pressure_angle_deg, (FLANK_PA, ROOT_PA))


def bearable_torque_nm(
    teeth: tuple[int, int], module_mm: float, face_width_mm: float, pressure_angle_deg: float = 20.0
) -> float:
    """Return the same without load factor and safeties: beyond it flanks or roots of the best steel fail [N m]."""
    return _torque_nm(teeth, module_mm, face_width_mm, pressure_angle_deg, (LARGEST_FLANK_PA, LARGEST_ROOT_PA))


def _torque_nm(
    teeth: tuple[int, int],
    module_mm: float,
    face_width_mm: float,
    pressure_angle_deg: float,
    stresses_pa: tuple[float, float],
) -> float:
    """Return the torque at which the first of two stresses is reached, of the flank and of the root [Pa].

    Flank: p = sqrt(F E*/(π b R)) at the pitch point, F = T/r_b. Root: σ = F_t Y/(b m), F_t = T/r.
    """
    pinion_m, gear_m = (0.5e-3 * module_mm * z for z in teeth)
    width_m, angle = 1e-3 * face_width_mm, radians(pressure_angle_deg)
    curvature_m = pinion_m * gear_m / (pinion_m + gear_m) * sin(angle)
    flank_n = stresses_pa[0] ** 2 * pi * width_m * curvature_m / EFFECTIVE_MODULUS_PA
    root_n = stresses_pa[1] * width_m * 1e-3 * module_mm / ROOT_FACTOR
    return min(flank_n * cos(angle), root_n) * pinion_m
