"""Film thickness of an elastohydrodynamic line contact, and the dimensionless groups that all its formulas share.

Û = η_0 u_e/(E' R_e), Ĝ = α_pv E', Ŵ = F_l/(E' R_e), σ̂ = σ/R_e, V = hardness/E'. Formulas: Dowson-Higginson (minimum),
Dowson-Toyoda (central), Pan-Hamrock (minimum), Masjedi-Khonsari 2012 (central and minimum, rough surfaces).

Verified: every group is dimensionless, and each film grows with speed, viscosity and radius and falls weakly with load.
At the pitch point of 18/47 teeth, module 3 mm, 30 N m, 30 Hz, 0.115 Pa s the smooth formulas give h_min 0.80 and 0.74
µm (Dowson-Higginson, Pan-Hamrock) and h_c 1.01 µm (Dowson-Toyoda); Masjedi-Khonsari's h_c is 0.92 µm at σ = 0.2 µm,
where it must be near the smooth ones, and 3.22 µm at 5 µm. Not verified against their papers: the coefficients of
Dowson-Toyoda, Pan-Hamrock and Masjedi-Khonsari (J. Tribol. 134:011503; only the abstract, which states the form f(Ŵ, Û,
Ĝ, σ̂, V), was read).

All are for steady, fully flooded contacts. At a load that goes to 0 they diverge, so the load group is held at
`LOAD_FLOOR` (derived: ours).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np

from siggen.dynamics.friction.contact_kinematics import Values, entrainment_speed, relative_radius

LOAD_FLOOR = 2e-6
"""Least Ŵ that goes into a formula: a tenth of the lower end of the rough-surface fit, some 5 % of a usual load."""

SPEED_FLOOR = 1e-16
"""Least Û: keeps logarithms finite at standstill, where the film is practically zero anyway."""


class FilmGroups(NamedTuple):
    """Dimensionless groups of a contact and its relative radius [m], arrays of one shape or numbers."""

    load: Values
    speed: Values
    material: Values
    roughness: Values
    hardness: Values
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
    hardness_pa : float
        Of the softer flank [Pa].

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
    hardness_pa: float

    def __post_init__(self) -> None:
        """Refuse impossible numbers where they enter, not as a NaN in a record."""
        inside = self.line_m < 0.0 and self.speed_2_rad_s < 0.0
        for name in self.__slots__:
            value = getattr(self, name) * (-1.0 if inside and name in {"line_m", "speed_2_rad_s"} else 1.0)
            if not (isfinite(value) and value > 0.0):
                raise ValueError(f"{name}: received {value}; allowed are finite values above 0")

    def groups(self, position_m: Values, force_n: Values, roughness_m: Values) -> FilmGroups:
        """Return the groups at positions s [m], normal forces [N] and composite roughnesses σ [m]; they broadcast."""
        radius = relative_radius(position_m, self.line_m)
        speed = entrainment_speed(position_m, self.line_m, self.speed_1_rad_s, self.speed_2_rad_s)
        return FilmGroups(
            load=force_n / (self.contact_length_m * self.effective_modulus_pa * radius),
            speed=self.viscosity_pa_s * speed / (self.effective_modulus_pa * radius),
            material=self.pressure_viscosity_per_pa * self.effective_modulus_pa,
            roughness=roughness_m / radius,
            hardness=self.hardness_pa / self.effective_modulus_pa,
            radius_m=radius,
        )


def dowson_higginson_minimum(groups: FilmGroups) -> Values:
    """Return Dowson and Higginson's h_min [m] of smooth surfaces."""
    load, speed = _bounded(groups)
    return 2.65 * speed**0.70 * groups.material**0.54 * load**-0.13 * groups.radius_m


def dowson_toyoda_central(groups: FilmGroups) -> Values:
    """Return Dowson and Toyoda's h_c [m] of smooth surfaces."""
    load, speed = _bounded(groups)
    return 3.06 * speed**0.69 * groups.material**0.56 * load**-0.10 * groups.radius_m


def pan_hamrock_minimum(groups: FilmGroups) -> Values:
    """Return Pan and Hamrock's h_min [m] of smooth surfaces."""
    load, speed = _bounded(groups)
    return 1.714 * load**-0.128 * speed**0.694 * groups.material**0.568 * groups.radius_m


def masjedi_khonsari_minimum(groups: FilmGroups) -> Values:
    """Return Masjedi and Khonsari's h_min [m] of rough surfaces."""
    load, speed = _bounded(groups)
    g, rough, hard = groups.material, groups.roughness, groups.hardness
    raised = 0.026 * rough**1.120 * hard**0.185 * load**-0.312 * speed**-0.809 * g**-0.977
    return 1.652 * load**-0.077 * speed**0.716 * g**0.695 * (1.0 + raised) * groups.radius_m


def masjedi_khonsari_central(groups: FilmGroups) -> Values:
    """Return Masjedi and Khonsari's h_c [m] of rough surfaces; the film of the film ratio."""
    load, speed = _bounded(groups)
    g, rough, hard = groups.material, groups.roughness, groups.hardness
    raised = 0.2 * rough**1.222 * hard**0.223 * load**-0.229 * speed**-0.748 * g**-0.842
    return 2.691 * load**-0.135 * speed**0.705 * g**0.556 * (1.0 + raised) * groups.radius_m


FILM_FORMULAS: dict[str, Callable[[FilmGroups], Values]] = {
    "masjedi_khonsari": masjedi_khonsari_central,
    "masjedi_khonsari_minimum": masjedi_khonsari_minimum,
    "dowson_higginson": dowson_higginson_minimum,
    "dowson_toyoda": dowson_toyoda_central,
    "pan_hamrock": pan_hamrock_minimum,
}
"""Film formulas by name; the first is the default."""


def film_ratio(film_m: Values, roughness_m: Values) -> Values:
    """Return Λ = h/σ: below 1 boundary, 1 to 3 mixed, above 3 full film lubrication."""
    return film_m / roughness_m


def _bounded(groups: FilmGroups) -> tuple[Values, Values]:
    return np.maximum(groups.load, LOAD_FLOOR), np.maximum(groups.speed, SPEED_FLOOR)
