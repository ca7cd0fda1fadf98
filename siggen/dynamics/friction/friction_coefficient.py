"""Friction coefficients of lubricated gear flanks by published formulas: parts, checks and targets of the friction law.

* `eyring_friction`: τ_E asinh(η_p |v_s|/(h τ_E))/p_m, limited to a share of the mean pressure (reference: standard
  literature).
* `xu_kahraman_friction`: regression of Xu and Kahraman 2007. Its exp(b_9 e^S) explodes over a rough flank (0.05, 0.14,
  2.6 at S = 0.1, 1, 2 µm), so a roughness above 0.6 µm is refused: it is for the healthy flank only. Verified: those
  values at SR 0.17, 0.565 GPa, 1.74 m/s, 115 mPa s; P_h in GPa (with MPa the formula gives 1e-34). Coefficients: public
  texts.
* `benedict_kelley_friction`: Benedict and Kelley 1961 in metric units, capped at the boundary value since it is
  singular at v_s -> 0. Verified: 0.056/0.071/0.098 at Ra 0.2/0.4/0.6 µm and the metric constant from the imperial one.
"""

from __future__ import annotations

import numpy as np

from siggen.dynamics.friction.contact_kinematics import Values
from siggen.dynamics.friction.oil import viscosity_under_pressure

XU_KAHRAMAN_ROUGHEST_M = 0.6e-6
BENEDICT_KELLEY_ROUGHEST_M = 0.8e-6
B1, B2, B3, B4, B5, B6, B7, B8, B9 = (
    -8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305,
)  # fmt: skip


def eyring_friction(
    sliding_m_s: Values,
    film_m: Values,
    pressure_pa: Values,
    viscosity_pa_s: float,
    pressure_viscosity_per_pa: float,
    eyring_stress_pa: float = 5e6,
    limiting_ratio: float = 0.07,
) -> Values:
    """Return the friction coefficient of an Eyring fluid in a Hertz contact of peak pressure p_H.

    Parameters
    ----------
    sliding_m_s, film_m, pressure_pa : v_s, h and p_H; arrays broadcast.
    viscosity_pa_s, pressure_viscosity_per_pa : float
        η_0 and α_pv; the viscosity at the mean pressure π p_H/4 is Roelands'.
    eyring_stress_pa : float
        τ_E, 3 to 10 MPa.
    limiting_ratio : float
        Limiting shear stress over mean pressure, 0.05 to 0.10: the bound of the result.
    """
    mean = 0.25 * np.pi * pressure_pa
    thick = viscosity_under_pressure(viscosity_pa_s, pressure_viscosity_per_pa, mean)
    stress = eyring_stress_pa * np.arcsinh(thick * np.abs(sliding_m_s) / (film_m * eyring_stress_pa))
    return np.minimum(stress / mean, limiting_ratio)


def xu_kahraman_friction(
    slide_roll: Values,
    pressure_pa: Values,
    entrainment_m_s: Values,
    viscosity_pa_s: float,
    radius_m: Values,
    roughness_m: float,
) -> Values:
    """Return Xu and Kahraman's friction coefficient of a flank without damage; 0 at the pitch point.

    Raises
    ------
    ValueError
        If the composite rms roughness is above 0.6 µm, the end of the data behind the regression.
    """
    if not 0.0 <= roughness_m <= XU_KAHRAMAN_ROUGHEST_M:
        raise ValueError(
            f"roughness_m: received {roughness_m:.3g}; the Xu-Kahraman regression holds up to "
            f"{XU_KAHRAMAN_ROUGHEST_M:.1g} m; use the composite friction law for rougher and for pitted flanks"
        )
    slide = np.maximum(np.abs(slide_roll), 1e-12)
    pressure, viscosity = pressure_pa * 1e-9, viscosity_pa_s * 1e3
    heat = slide * pressure * np.log10(viscosity)
    exponent = B1 + B4 * heat + B5 * np.exp(-heat) + B9 * np.exp(roughness_m * 1e6)
    value: Values = np.exp(exponent) * pressure**B2 * slide**B3 * entrainment_m_s**B6 * viscosity**B7 * radius_m**B8
    return value


def benedict_kelley_friction(
    line_load_n_per_m: Values,
    sliding_m_s: Values,
    speed_sum_m_s: Values,
    viscosity_pa_s: float,
    roughness_m: float,
    largest: float = 0.11,
) -> Values:
    """Return Benedict and Kelley's friction coefficient between 0 and `largest`; `speed_sum_m_s` is u_1 + u_2.

    Raises
    ------
    ValueError
        If the arithmetic mean roughness is above 0.8 µm: the formula is singular at 1.13 µm.
    """
    if not 0.0 <= roughness_m <= BENEDICT_KELLEY_ROUGHEST_M:
        raise ValueError(
            f"roughness_m: received {roughness_m:.3g}; the Benedict-Kelley formula holds up to "
            f"{BENEDICT_KELLEY_ROUGHEST_M:.1g} m; use the composite friction law for rougher flanks"
        )
    slide = np.maximum(np.abs(sliding_m_s), 1e-12)
    group = 29660.0 * (line_load_n_per_m * 1e-3) / (viscosity_pa_s * 1e3 * slide * np.square(speed_sum_m_s))
    value = 0.0127 * 1.13 / (1.13 - roughness_m * 1e6) * np.log10(np.maximum(group, 1.0))
    return np.clip(value, 0.0, largest)
