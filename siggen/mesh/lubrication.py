"""Film, traction and asperities between two flanks, and how these roll and slide.

Film thickness of an elastohydrodynamic line contact: Dowson and Toyoda's central film of smooth surfaces.

Û = η_0 u_e/(E' R_e), Ĝ = α_pv E', Ŵ = F_l/(E' R_e); h_c = 3.06 Û^0.69 Ĝ^0.56 Ŵ^-0.10 R_e. One film serves the film
ratio and the shear of the oil. Its coefficients are from memory (Dowson and Toyoda 1978).

Verified: every group is dimensionless; the film grows with speed, viscosity and radius and falls weakly with load. At
the pitch point of 18/47 teeth, module 3 mm, 30 N m, 30 Hz, 0.115 Pa s it is 1.01 µm.

It is for steady, fully flooded contacts. At a load that goes to 0 it diverges, so the load group is held at
`LOAD_FLOOR` (derived: ours).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray

# Rolling and sliding speeds, relative radius and Hertz pressure of a spur gear contact on the line of action.
#
# Equations: reference, standard literature (involute kinematics; Hertz line contact). With s the distance of the
# contact from the pinion's base tangent point and T the length of the line of action: u_1 = Ω_1 s, u_2 = Ω_2 (T - s),
# R_e = s (T - s)/T, p_H = √(F_l E*/(π R_e)), a_H = √(4 F_l R_e/(π E*)). The effective modulus E' = 2 E* is the one
# that film formulas use. Verified: at the pitch point of 18/47 teeth, module 3 mm, 30 N m, 30 Hz they give u_e = 1.741
# m/s, R_e = 6.678 mm, p_H = 0.565 GPa and a_H = 66.6 µm, and p_H a_H π/2 is the line load.
#
# Every function takes numbers or arrays that broadcast.

Values: TypeAlias = float | NDArray[np.float64]
"""A number or an array; functions of several broadcast."""


def effective_modulus(youngs_modulus_pa: float, poisson_ratio: float) -> float:
    """Return E' = 2/[(1 - ν²)/E + (1 - ν²)/E] of two gears of one material [Pa]; the reduced modulus is half."""
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


# Friction coefficient of an oil film that is sheared between two flanks: Eyring's law, heated by its own friction.
#
# Model: τ = τ_E asinh(η v/(τ_E h)) at every place of the Hertz width (Eyring; Johnson and Tevaarwerk 1977), averaged
# over the width and divided by the mean pressure that the oil carries. Asperities carry the share La, so that pressure
# is (1 - La) times Hertz's (force balance). Viscosity by Roelands, with the oil's own pressure and temperature slopes
# at the inlet: ln η + 9.67 = (ln η_0 + 9.67) (1 + p/0.196 GPa)^Z ((T - T_p)/(T_0 - T_p))^-S, T_p = 138 K.
#
# Heat (derived): the mean film is warmer than the flanks by τ v h/(12 k), of uniform shear between two walls. Each
# flank takes half of μ p v, asperities included, and is warmed at its surface by q √(16 t/(9π))/e in the mean over the
# width, with t = 2b/u_e the time of passage and e = √(k ρ c) (reference: standard literature, Blok, Jaeger: fast heat
# source).
#
# No limiting shear stress: a mineral gear oil of ISO VG 320 reached none, and lost friction by heat alone
# (Vengudusamy, Enekes and Spallek 2019, Friction, abstract). What grows without bound in Eyring's law is cut off at
# the boundary coefficient by the composite law.
#
# Verified: against a quadrature over 20,000 places with the temperature by bracketing
# (`tests/dynamics/friction/test_film_traction.py`). Not verified against a text: τ_E and Roelands's formulas are from
# memory.

EYRING_STRESS_PA = 5e6
"""τ_E of mineral oils (from memory: 2 to 10 MPa, usually 5)."""
ROELANDS_PRESSURE_PA = 1.0 / 5.1e-9
ROELANDS_LOG = 9.67
ROELANDS_POLE_K = 138.0
OIL_CONDUCTIVITY_W_PER_M_K = 0.14
"""Of mineral oil at 60 °C (Modelica Standard Library, medium MineralOil)."""
STEEL_EFFUSIVITY = float(np.sqrt(46.0 * 7850.0 * 470.0))
"""√(k ρ c) of carbon steel [W √s/(m² K)] (reference: standard literature)."""
MOST_SHARE = 0.95
"""Of the asperities, for the pressure of the oil: without load it would have a coefficient without bound."""
NODES = 8
"""Of Gauss's rule over a quarter turn, in which the pressure is p_H cos θ."""
NEWTON_STEPS = 6

_angle, _weight = np.polynomial.legendre.leggauss(NODES)
_PRESSURE_COSINE: FloatArray = np.cos(0.25 * np.pi * (1.0 + _angle))
_WIDTH_WEIGHT: FloatArray = 0.25 * np.pi * _weight * _PRESSURE_COSINE


class Film(NamedTuple):
    """A film's state over the width, last axis NODES, and what warms it; arrays that broadcast.

    `log_viscosity`: ln η + 9.67 at the inlet's temperature; `thickness_m`, `slide_m_s`, `mean_pressure_pa` of the oil;
    `rub_pa`: stress of the asperities; `film_warms`, `flank_warms`: kelvin per pascal of stress.
    """

    log_viscosity: FloatArray
    thickness_m: FloatArray
    slide_m_s: FloatArray
    mean_pressure_pa: FloatArray
    rub_pa: FloatArray
    film_warms: FloatArray
    flank_warms: FloatArray


def film_traction(mesh: LubricatedMesh, position_m: Values, force_n: Values, share: Values) -> FloatArray:
    """Return the friction coefficient of the load that the oil carries, from 0 at the pitch point.

    Parameters
    ----------
    mesh : LubricatedMesh
        At its mean speeds: the slide is that of the place.
    position_m, force_n : float or array
        Places s [m] and normal forces [N]; they broadcast.
    share : float or array
        La, the share of the load that asperities carry, 0 to 1.
    """
    film = _film(mesh, position_m, force_n, np.minimum(share, MOST_SHARE))
    warmth = np.zeros_like(film.thickness_m)
    stress, softening = _mean_stress(mesh, film, warmth)
    for _ in range(NEWTON_STEPS):
        heat = film.film_warms + film.flank_warms
        excess = warmth - heat * stress - film.flank_warms * film.rub_pa
        # The stress falls ever more slowly with the temperature: Newton's method from the cold side never overshoots.
        warmth = warmth - excess / (1.0 + heat * softening)
        stress, softening = _mean_stress(mesh, film, warmth)
    return np.asarray(stress / film.mean_pressure_pa)


def _film(mesh: LubricatedMesh, position_m: Values, force_n: Values, share: Values) -> Film:
    radius, line_load = relative_radius(position_m, mesh.line_m), force_n / mesh.contact_length_m
    speeds = mesh.line_m, mesh.speed_1_rad_s, mesh.speed_2_rad_s
    half_width = hertz_half_width(line_load, radius, mesh.effective_modulus_pa)
    passage_s = 2.0 * np.asarray(half_width) / entrainment_speed(position_m, *speeds)
    slide = np.abs(sliding_speed(position_m, *speeds, 0.0))
    thickness = np.asarray(central_film_m(mesh.groups(position_m, force_n)))
    mean = 0.25 * np.pi * np.asarray(hertz_pressure(line_load, radius, mesh.effective_modulus_pa))
    pressure = (4.0 / np.pi * mean * (1.0 - share))[..., None] * _PRESSURE_COSINE
    at_inlet = np.log(mesh.viscosity_pa_s) + ROELANDS_LOG
    exponent = mesh.pressure_viscosity_per_pa * ROELANDS_PRESSURE_PA / at_inlet
    return Film(
        log_viscosity=at_inlet * (1.0 + pressure / ROELANDS_PRESSURE_PA) ** exponent,
        thickness_m=thickness,
        slide_m_s=np.asarray(slide),
        mean_pressure_pa=mean * (1.0 - share),
        rub_pa=mesh.boundary_friction * share * mean,
        film_warms=slide * thickness / (12.0 * OIL_CONDUCTIVITY_W_PER_M_K),
        flank_warms=0.5 * slide * np.sqrt(16.0 * passage_s / (9.0 * np.pi)) / STEEL_EFFUSIVITY,
    )


def _mean_stress(mesh: LubricatedMesh, film: Film, warmth_k: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the shear stress averaged over the width [Pa], and by how much it falls per kelvin."""
    span = mesh.inlet_temperature_k - ROELANDS_POLE_K
    steepness = mesh.viscosity_fall_per_k * span / (np.log(mesh.viscosity_pa_s) + ROELANDS_LOG)
    thinned = film.log_viscosity * ((1.0 + warmth_k / span) ** -steepness)[..., None]
    rate = (film.slide_m_s / (EYRING_STRESS_PA * film.thickness_m))[..., None] * np.exp(thinned - ROELANDS_LOG)
    slope = rate / np.sqrt(1.0 + np.square(rate)) * thinned
    stress = EYRING_STRESS_PA * (np.arcsinh(rate) @ _WIDTH_WEIGHT)
    return stress, EYRING_STRESS_PA * steepness / (span + warmth_k) * (slope @ _WIDTH_WEIGHT)


# Share of the normal load that asperities carry in mixed lubrication, from the film ratio Λ = h/σ.
#
# La = 1 - 1.21 Λ^0.64/(1 + 0.37 Λ^1.26) up to Λ = 2, nothing above: the regression of Zhu and Hu's numerical contacts,
# as Castro and Seabra use it for gears (from memory). h is the central film of smooth surfaces, σ the composite rms
# roughness. At 2 the regression is 4e-4 with a slope of -0.02, and it turns up again beyond 4: so it ends there. Rough
# discs rub more up to Λ = 3.5 (Vengudusamy, Enekes and Spallek 2019, abstract): above 2 nothing is a lower bound.
#
# Verified: the mean friction of a mesh that follows against two formulas fitted to measured gears
# (`tests/dynamics/friction/test_gear_friction.py`).

FULL_FILM = 2.0
"""Film ratio from which asperities carry nothing."""


def asperity_load_share(film_ratio: Values) -> Values:
    """Return La, from 1 without a film to 0 from a film ratio of 2 on."""
    ratio = np.minimum(film_ratio, FULL_FILM)
    share = np.maximum(1.0 - 1.21 * ratio**0.64 / (1.0 + 0.37 * ratio**1.26), 0.0)
    return np.where(np.asarray(film_ratio) >= FULL_FILM, 0.0, share)[()]
