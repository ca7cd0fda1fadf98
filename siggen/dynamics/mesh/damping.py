"""Mesh damping that depends on the lubrication, squeeze film between flanks apart, and warnings of overdamped supports.

* Ratio by asperity share: ζ = ζ_s + ζ_f (1 - La) + ζ_a La. Derived (ours): literature gives mesh damping ratios of 0.03
  to 0.17 and names structure, film and asperities as sources, but no law that was read relates them.
* c = 2 ζ √(k_m m_e), split over the pairs in contact by their stiffness (reference: standard literature).
* Squeeze film of a rigid cylinder on a plane in an isoviscous oil: c = 3√2 π η L (R_e/h)^1.5. Derived from Reynolds'
  equation, p = 6 η V R_e/h²; 2.3e4 N s/m at h = 0.8 µm for 20 mm face width, R_e 6.7 mm, 0.112 Pa s, some 15 times the
  mesh damper: so it acts only while the flanks are apart and approach each other, never in closed contact.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, pi, sqrt
from typing import NamedTuple

import numpy as np
from numba import njit


class DampingLaw(NamedTuple):
    """Parts of the mesh damping ratio (a named tuple, since compiled code takes no dataclass).

    `structure`: ζ_s, always present (0.03 to 0.05); `film`: ζ_f (0.01 to 0.03); `asperities`: ζ_a (0.03 to 0.08).
    """

    structure: float = 0.04
    film: float = 0.02
    asperities: float = 0.05


@njit(cache=True)
def mesh_damping_ratio(law: DampingLaw, share: float) -> float:
    """Return ζ of a pair whose asperities carry the share La of the load; numbers or arrays."""
    return law.structure + law.film * (1.0 - share) + law.asperities * share


@njit(cache=True)
def pair_damping(ratio: float, pair_n_per_m: float, mesh_n_per_m: float, mesh_mass_kg: float) -> float:
    """Return c_n = 2 ζ √(k_m m_e) k_n/k_m [N s/m] of one of the pairs in contact, whose stiffnesses sum to k_m."""
    damping: float = 2.0 * ratio * np.sqrt(mesh_mass_kg / mesh_n_per_m) * pair_n_per_m
    return damping


@njit(cache=True)
def squeeze_damping(film_m: float, radius_m: float, length_m: float, viscosity_pa_s: float) -> float:
    """Return the damping [N s/m] of an oil film of thickness h between flanks of relative radius R_e."""
    ratio = radius_m / film_m
    damping: float = 3.0 * np.sqrt(2.0) * np.pi * viscosity_pa_s * length_m * ratio * np.sqrt(ratio)
    return damping


@njit(cache=True)
def squeeze_force(
    penetration_m: float, rate_m_s: float, film_m: float, radius_m: float, length_m: float, viscosity_pa_s: float
) -> float:
    """Return the force [N] that keeps approaching flanks apart.

    Parameters
    ----------
    penetration_m : float
        d; 0 from contact on, where the film is as good as rigid and the mesh damper acts instead.
    rate_m_s : float
        ḋ, positive while the flanks approach; oil does not pull, so parting flanks feel nothing.
    film_m : float
        Least thickness h that counts, about that of the film in contact.
    radius_m, length_m, viscosity_pa_s : float
        R_e, contact length and the oil's viscosity at ambient pressure.
    """
    if penetration_m > 0.0 or rate_m_s <= 0.0:
        return 0.0
    return squeeze_damping(max(-penetration_m, film_m), radius_m, length_m, viscosity_pa_s) * rate_m_s


def damping_ratio(stiffness_n_per_m: float, damping_n_s_per_m: float, mass_kg: float) -> float:
    """Return ζ = c/(2 √(k m)); in rad for torsion with inertia instead of mass.

    Raises
    ------
    ValueError
        If stiffness or mass are not finite and positive.
    """
    for name, value in (("stiffness_n_per_m", stiffness_n_per_m), ("mass_kg", mass_kg)):
        if not (isfinite(value) and value > 0.0):
            raise ValueError(f"{name}: received {value}; allowed are finite values above 0")
    return damping_n_s_per_m / (2.0 * sqrt(stiffness_n_per_m * mass_kg))


def damping_notes(supports: Mapping[str, tuple[float, float, float]]) -> tuple[str, ...]:
    """Return a sentence for each support that is damped beyond oscillation.

    Parameters
    ----------
    supports : mapping of name to (stiffness [N/m], damping [N s/m], moving mass [kg])
        Or of couplings: [N m/rad], [N m s/rad], [kg m²].
    """
    notes = []
    for name, (stiffness, damping, mass) in supports.items():
        ratio = damping_ratio(stiffness, damping, mass)
        if ratio > 1.0:
            frequency = sqrt(stiffness / mass) / (2.0 * pi)
            notes.append(
                f"{name}: damping ratio {ratio:.3g} is above 1, so its {frequency:.4g} Hz mode cannot swing and the "
                f"support acts as if rigid; some published sets hold such values; measured supports have 0.02 to 0.1"
            )
    return tuple(notes)
