"""Friction coefficient of an oil film that is sheared between two flanks: Eyring's law, heated by its own friction.

Model: τ = τ_E asinh(η v/(τ_E h)) at every place of the Hertz width (Eyring; Johnson and Tevaarwerk 1977), averaged over
the width and divided by the mean pressure that the oil carries. Asperities carry the share La, so that pressure is
(1 - La) times Hertz's (force balance). Viscosity by Roelands, with the oil's own pressure and temperature slopes at the
inlet: ln η + 9.67 = (ln η_0 + 9.67) (1 + p/0.196 GPa)^Z ((T - T_p)/(T_0 - T_p))^-S, T_p = 138 K.

Heat (derived): the mean film is warmer than the flanks by τ v h/(12 k), of uniform shear between two walls. Each flank
takes half of μ p v, asperities included, and is warmed at its surface by q √(16 t/(9π))/e in the mean over the width,
with t = 2b/u_e the time of passage and e = √(k ρ c) (reference: standard literature, Blok, Jaeger: fast heat source).

No limiting shear stress: a mineral gear oil of ISO VG 320 reached none, and lost friction by heat alone (Vengudusamy,
Enekes and Spallek 2019, Friction, abstract). What grows without bound in Eyring's law is cut off at the boundary
coefficient by the composite law.

Verified: against a quadrature over 20,000 places with the temperature by bracketing
(`tests/dynamics/friction/test_film_traction.py`). Not verified against a text: τ_E and Roelands's formulas are from
memory.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.friction.contact_kinematics import (
    Values,
    entrainment_speed,
    hertz_half_width,
    hertz_pressure,
    relative_radius,
    sliding_speed,
)
from siggen.dynamics.friction.lubrication import LubricatedMesh, central_film_m

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
