"""Share of the normal load that asperities carry in mixed lubrication, by one of three models.

Each model gives a ratio of loads from 0 that may exceed 1 where its assumptions end; the share is the ratio cut off at
1. The ratios themselves are smooth, which is what tables need.

* `masjedi_khonsari` (default): regression of Masjedi and Khonsari 2012 for rough line contacts. Verified:
  0.3/8.9/21/31/38/52/62/75/93 % at σ = 0.2/0.4/0.6/0.8/1/1.5/2/3/5 µm, pitch point of 18/47 teeth, module 3 mm, 30 N
  m, 30 Hz; grows with roughness, falls with speed and viscosity. Its coefficients were not compared with the paper.
* `greenwood_tripp`: p_a = (16√2 π/15) (η β σ)² √(σ/β) E* F_5/2(h/σ) on the Hertz width. Verified: the factor follows
  from Hertz contact of two spheres of radius β, averaged over their offset (derived), and the modulus is the reduced
  one.
* `simple`: F_5/2(Λ)/F_5/2(0), without any mechanics. Verified: 0.39/0.13/0.009 at Λ = 0.5/1/2.

At one film ratio they differ by factors, since each is tied to its own film: Masjedi-Khonsari to none, the others to
Dowson and Toyoda's film of smooth surfaces. The two Gaussian ones use exact integrals.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import gamma, pbdv

from siggen.dynamics.friction.contact_kinematics import Values
from siggen.dynamics.friction.lubrication import LOAD_FLOOR, SPEED_FLOOR, FilmGroups, dowson_toyoda_central, film_ratio

ASPERITY_DENSITY_PRODUCT = 0.05
"""η β σ of Greenwood and Tripp; 0.03 to 0.06 for ground steel (reference: standard literature)."""

ASPERITY_SLOPE = 1e-3
"""σ/β of Greenwood and Tripp; 1e-4 to 1e-2 (reference: standard literature)."""


def masjedi_khonsari_ratio(groups: FilmGroups) -> Values:
    """Return the asperity load ratio of rough surfaces by Masjedi and Khonsari's regression.

    The logarithm's argument spans 1e-20 to 1e60 over usual roughness, so it is formed in logarithms. Below `LOAD_FLOOR`
    the ratio stays what it is there.
    """
    load = np.log(np.maximum(groups.load, LOAD_FLOOR))
    speed = np.log(np.maximum(groups.speed, SPEED_FLOOR))
    material, hardness = np.log(groups.material), np.log(groups.hardness)
    rough = np.log(np.maximum(groups.roughness, 1e-30))
    inner = np.log(4470.0) + 6.015 * rough + 1.168 * hardness + 0.485 * load - 3.741 * speed - 2.898 * material
    percent: Values = 0.005 * np.exp(-0.408 * load - 0.088 * speed + 0.103 * material) * np.logaddexp(0.0, inner)
    return 0.01 * percent


def greenwood_tripp_ratio(groups: FilmGroups) -> Values:
    """Return the ratio of Greenwood and Tripp's asperity pressure, uniform over the Hertz width 2 a_H, to the load.

    With p_a = c E* and F_l = Ŵ E' R_e, a_H = R_e √(8 Ŵ/π): ratio = 2 a_H p_a/F_l = c √(8/(π Ŵ)).
    """
    load = np.maximum(groups.load, LOAD_FLOOR)
    separation = _smooth_film_ratio(groups)
    level: float = 16.0 * np.sqrt(2.0) * np.pi / 15.0 * ASPERITY_DENSITY_PRODUCT**2 * np.sqrt(ASPERITY_SLOPE)
    return level * gaussian_integral(2.5, separation) * np.sqrt(8.0 / (np.pi * load))


def simple_ratio(groups: FilmGroups) -> Values:
    """Return F_5/2(Λ)/F_5/2(0) with Λ by Dowson and Toyoda's film."""
    return simple_share(_smooth_film_ratio(groups))


def simple_share(ratio: Values) -> Values:
    """Return F_5/2(Λ)/F_5/2(0): 1 for touching mean planes, 0 for a thick film."""
    return gaussian_integral(2.5, ratio) / gaussian_integral(2.5, 0.0)


def gaussian_integral(order: float, separation: Values) -> Values:
    """Return F_n(H) = ∫_H^∞ (x - H)^n exp(-x²/2)/√(2π) dx, exact by the parabolic cylinder function.

    F_n(H) = Γ(n + 1) exp(-H²/4) D_{-n-1}(H)/√(2π) (reference: standard literature); 0 beyond H = 30, where it is below
    1e-190.
    """
    height = np.minimum(separation, 30.0)
    value = (
        gamma(order + 1.0) * np.exp(-0.25 * np.square(height)) * pbdv(-order - 1.0, height)[0] / np.sqrt(2.0 * np.pi)
    )
    return np.where(np.asarray(separation) > 30.0, 0.0, value)[()]


RATIO_MODELS: dict[str, Callable[[FilmGroups], Values]] = {
    "masjedi_khonsari": masjedi_khonsari_ratio,
    "greenwood_tripp": greenwood_tripp_ratio,
    "simple": simple_ratio,
}
"""Models by name; the first is the default."""


def _smooth_film_ratio(groups: FilmGroups) -> Values:
    film = dowson_toyoda_central(groups)
    roughness = np.maximum(groups.roughness * groups.radius_m, 1e-12)
    return film_ratio(film, roughness)
