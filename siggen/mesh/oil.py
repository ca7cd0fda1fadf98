"""Oil: viscosity and density by temperature, pressure-viscosity coefficient.

Equations: Walther (ASTM D341), log10 log10(ν + 0.7) = m - n log10 T with ν in mm²/s and T in K; density linear in
temperature; α_pv = s ν^t 1e-9 1/Pa with ν in mm²/s (Gold 2001)
(reference: standard literature). Walther constants and density of mineral gear oils as in the open library GEARpie.

Verified: ISO VG 220 gives 218/126/78/35 mm²/s at 40/50/60/80 °C and 0.112 Pa s at 50 °C; every grade is within 10 % of
its number at 40 °C, as the grade's definition demands. Not verified against a text: s = 9.904, t = 0.1390 (mineral oil)
are from memory; the value 1.9e-8 1/Pa that follows for VG 220 at 50 °C lies where such oils are measured
(1.5e-8 to 2.5e-8), while the digits exchanged between s and t, as some codes have them, would give 1.7e-7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

PIEZO_FACTOR = 9.904
PIEZO_EXPONENT = 0.1390
COLDEST_C, HOTTEST_C = -20.0, 150.0


@dataclass(frozen=True, slots=True)
class Oil:
    """A mineral gear oil.

    Parameters
    ----------
    name : str
    walther_m, walther_n : float
        Constants of Walther's law (mm²/s, K).
    density_15c_kg_per_m3 : float
    density_slope_per_k : float
        Relative change of the density per kelvin.
    """

    name: str
    walther_m: float
    walther_n: float
    density_15c_kg_per_m3: float = 902.0
    density_slope_per_k: float = -5.8e-4

    def kinematic_viscosity_m2_s(self, temperature_c: float) -> float:
        """Return ν [m²/s].

        Raises
        ------
        ValueError
            If the temperature is outside -20 to 150 °C: Walther's law is for liquid oils.
        """
        if not COLDEST_C <= temperature_c <= HOTTEST_C:
            allowed = f"allowed are {COLDEST_C:g} to {HOTTEST_C:g} °C for {self.name}"
            raise ValueError(f"temperature_c: received {temperature_c}; {allowed}")
        exponent = self.walther_m - self.walther_n * np.log10(temperature_c + 273.15)
        return float(10.0 ** (10.0**exponent) - 0.7) * 1e-6

    def density_kg_per_m3(self, temperature_c: float) -> float:
        """Return the density [kg/m³]."""
        return self.density_15c_kg_per_m3 * (1.0 + self.density_slope_per_k * (temperature_c - 15.0))

    def viscosity_pa_s(self, temperature_c: float) -> float:
        """Return the dynamic viscosity η_0 at ambient pressure [Pa s]; raises as `kinematic_viscosity_m2_s`."""
        return self.kinematic_viscosity_m2_s(temperature_c) * self.density_kg_per_m3(temperature_c)

    def pressure_viscosity_per_pa(self, temperature_c: float) -> float:
        """Return α_pv [1/Pa]; raises as `kinematic_viscosity_m2_s`."""
        found: float = PIEZO_FACTOR * (self.kinematic_viscosity_m2_s(temperature_c) * 1e6) ** PIEZO_EXPONENT * 1e-9
        return found

    def viscosity_fall_per_k(self, temperature_c: float) -> float:
        """Return -d ln η_0/dT [1/K]; raises as `kinematic_viscosity_m2_s`."""
        kelvin = temperature_c + 273.15
        kinematic = self.kinematic_viscosity_m2_s(temperature_c) * 1e6
        # Of log10(ν + 0.7) = 10^(m - n log10 T), and of the density.
        walther = (1.0 + 0.7 / kinematic) * np.log(kinematic + 0.7) * self.walther_n / kelvin
        relative_density = self.density_kg_per_m3(temperature_c) / self.density_15c_kg_per_m3
        return float(walther - self.density_slope_per_k / relative_density)


MINERAL_OILS = {
    oil.name: oil
    for oil in (
        Oil("ISO VG 32", 9.5259, 3.7449),
        Oil("ISO VG 46", 9.7044, 3.7995),
        Oil("ISO VG 68", 9.4422, 3.6778),
        Oil("ISO VG 100", 9.2479, 3.5849),
        Oil("ISO VG 150", 9.0379, 3.4861),
        Oil("ISO VG 220", 8.8178, 3.3852),
        Oil("ISO VG 320", 9.0658, 3.4730),
        Oil("ISO VG 460", 8.7179, 3.3229),
        Oil("ISO VG 680", 8.4969, 3.2236),
    )
}
"""Mineral gear oils by their ISO grade."""
