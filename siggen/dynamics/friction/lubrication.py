"""Film thickness of an elastohydrodynamic line contact: Dowson and Toyoda's central film of smooth surfaces.

Û = η_0 u_e/(E' R_e), Ĝ = α_pv E', Ŵ = F_l/(E' R_e); h_c = 3.06 Û^0.69 Ĝ^0.56 Ŵ^-0.10 R_e. One film serves the film
ratio and the shear of the oil. Its coefficients are from memory (Dowson and Toyoda 1978).

Verified: every group is dimensionless; the film grows with speed, viscosity and radius and falls weakly with load. At
the pitch point of 18/47 teeth, module 3 mm, 30 N m, 30 Hz, 0.115 Pa s it is 1.01 µm.

It is for steady, fully flooded contacts. At a load that goes to 0 it diverges, so the load group is held at
`LOAD_FLOOR` (derived: ours).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np

from siggen.dynamics.friction.contact_kinematics import Values, entrainment_speed, relative_radius

LOAD_FLOOR = 2e-6
"""Least Ŵ that goes into the formula: some 5 % of a usual load."""

SPEED_FLOOR = 1e-16
"""Least Û: at standstill the film is practically zero anyway."""


class FilmGroups(NamedTuple):
    """Dimensionless groups of a contact and its relative radius [m], arrays of one shape or numbers."""

    load: Values
    speed: Values
    material: Values
    radius_m: Values


@dataclass(frozen=True, slots=True)
class LubricatedMesh:
    """A pair of gears in oil at one speed: what the film and the share of the asperities depend on.

    Parameters
    ----------
    line_m : float
        Length T of the line of action; negative where the gear is a ring [m].
    speed_1_rad_s, speed_2_rad_s : float
        Mean speeds of pinion and gear, both positive; that of a ring, which turns as its pinion, negative [rad/s].
    contact_length_m : float
        Length of the contact across the face [m].
    effective_modulus_pa : float
        E' of `effective_modulus` [Pa].
    viscosity_pa_s, pressure_viscosity_per_pa, viscosity_fall_per_k : float
        Oil at the temperature of the inlet: η_0, α_pv, and -d ln η_0/dT.
    inlet_temperature_k : float
    boundary_friction : float
        μ_b, the friction coefficient of the asperities.

    Raises
    ------
    ValueError
        If a number is not finite and positive; of a ring line and second speed are negative together.
    """

    line_m: float
    speed_1_rad_s: float
    speed_2_rad_s: float
    contact_length_m: float
    effective_modulus_pa: float
    viscosity_pa_s: float
    pressure_viscosity_per_pa: float
    viscosity_fall_per_k: float
    inlet_temperature_k: float
    boundary_friction: float

    def __post_init__(self) -> None:
        """Refuse impossible numbers where they enter, not as a NaN in a record."""
        inside = self.line_m < 0.0 and self.speed_2_rad_s < 0.0
        for name in self.__slots__:
            value = getattr(self, name) * (-1.0 if inside and name in {"line_m", "speed_2_rad_s"} else 1.0)
            if not (isfinite(value) and value > 0.0):
                raise ValueError(f"{name}: received {value}; allowed are finite values above 0")

    def groups(self, position_m: Values, force_n: Values) -> FilmGroups:
        """Return the groups at positions s [m] and normal forces [N]; they broadcast."""
        radius = relative_radius(position_m, self.line_m)
        speed = entrainment_speed(position_m, self.line_m, self.speed_1_rad_s, self.speed_2_rad_s)
        return FilmGroups(
            load=force_n / (self.contact_length_m * self.effective_modulus_pa * radius),
            speed=self.viscosity_pa_s * speed / (self.effective_modulus_pa * radius),
            material=self.pressure_viscosity_per_pa * self.effective_modulus_pa,
            radius_m=radius,
        )


def central_film_m(groups: FilmGroups) -> Values:
    """Return Dowson and Toyoda's h_c [m] of smooth surfaces."""
    load, speed = np.maximum(groups.load, LOAD_FLOOR), np.maximum(groups.speed, SPEED_FLOOR)
    film: Values = 3.06 * speed**0.69 * groups.material**0.56 * load**-0.10 * groups.radius_m
    return film


def film_ratio(film_m: Values, roughness_m: Values) -> Values:
    """Return Λ = h/σ: below 1 boundary, 1 to 3 mixed, above 3 full film lubrication."""
    return film_m / roughness_m
