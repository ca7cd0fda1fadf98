"""Temperature of splashed oil by the heat balance of a gearbox: its losses leave through the walls of its box.

T_end = T_air + P(T_end)/(k A); after a start the record sees a share of the rise. P is the sum of (ISO/TR 14179, from
memory):

* mesh: μ F v_s with Schlenk's mean coefficient, 0.048 (F/b)^0.2 (v_Σ ρ)^-0.2 η^-0.05 Ra^0.25 X_L in N/mm, m/s, mm,
  mPa s and µm at the pitch point, X_L = 0.846 of mineral oil (both read in the open library GEARpie), and the mean
  sliding of Ohlendorf, (p_b/2)(1 + z_1/z_2)(1 - ε + ε_1² + ε_2²) Ω_1;
* ball bearings by Palmgren, M_0 = 1e-7 f_0 (ν n)^(2/3) d_m³ with ν n from 2000 on, and M_1 = f_1 F d_m, in N mm, mm²/s,
  1/min and mm: f_0 = 2 of an oil bath, f_1 = 6e-4, the end of its range for full loads;
* lips of seals, 2.4e-3 N m per mm of the shaft.

Oil that gears splash is left out: at rim speeds of a few m/s it is little.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cos, pi

from siggen.gears.gear_pair import GearPair
from siggen.mesh.lubrication import relative_radius
from siggen.mesh.oil import COLDEST_C, Oil

MINERAL = 0.846
HEAT_TRANSFER_W_PER_M2_K = 17.5
"""Of a housing in still air: 15 to 20 (ISO/TR 14179, from memory)."""
HOTTEST_SUMP_C = 90.0
"""Above it mineral oil ages fast; makers fit a cooler that holds it (usual limit, 90 to 95 °C)."""
RMS_OVER_MEAN = 1.25
"""Of a Gaussian profile: Rq over Ra."""


@dataclass(frozen=True, slots=True)
class MeshAtWork:
    """A pair, turns of its pinion [Hz], force of its teeth [N] and rms roughness of its flanks [m]."""

    pair: GearPair
    speed_hz: float
    force_n: float
    roughness_m: float

    def coefficient(self, viscosity_pa_s: float) -> float:
        """Return Schlenk's mean coefficient of friction; 0 without speed."""
        pair = self.pair
        rolling_m_s = 4.0 * pi * self.speed_hz * pair.pitch_point_m
        if rolling_m_s == 0.0:
            return 0.0
        radius_mm = 1e3 * relative_radius(pair.pitch_point_m, pair.line_of_action_m)
        load = 1e-3 * self.force_n / pair.face_width_m / (rolling_m_s * radius_mm)
        mean_um = 1e6 * self.roughness_m / RMS_OVER_MEAN
        return float(0.048 * load**0.2 * (1e3 * viscosity_pa_s) ** -0.05 * mean_um**0.25 * MINERAL)

    def loss_w(self, viscosity_pa_s: float) -> float:
        """Return the power that sliding takes [W]."""
        pair, pitch = self.pair, self.pair.base_pitch_m
        after, before = (
            (pair.contact_end_m - pair.pitch_point_m) / pitch,
            (pair.pitch_point_m - pair.contact_start_m) / pitch,
        )
        slid_m = 0.5 * pitch * (1.0 - after - before + after**2 + before**2) / cos(pair.base_helix_rad)
        turning = 1.0 + pair.pinion.base_radius_m / pair.gear.signed_base_radius_m
        return float(self.coefficient(viscosity_pa_s) * self.force_n * 2.0 * pi * self.speed_hz * turning * slid_m)


@dataclass(frozen=True, slots=True)
class ShaftAtWork:
    """Turns of a shaft [Hz], mean diameter of its two bearings [m], force on both [N], diameter of a seal [m] or 0."""

    speed_hz: float
    bearing_m: float
    force_n: float
    seal_m: float

    def loss_w(self, viscosity_m2_s: float) -> float:
        """Return the power that two ball bearings and a seal take [W]."""
        mean_mm = 1e3 * self.bearing_m
        stirred: float = max(1e6 * viscosity_m2_s * 60.0 * self.speed_hz, 2000.0) ** (2.0 / 3.0)
        idle_nmm, loaded_nmm = 1e-7 * 2.0 * stirred * mean_mm**3, 6e-4 * self.force_n * mean_mm
        return 2.0 * pi * self.speed_hz * (1e-3 * (2.0 * idle_nmm + loaded_nmm) + 2.4 * self.seal_m)


def loss_w(meshes: Sequence[MeshAtWork], shafts: Sequence[ShaftAtWork], oil: Oil, temperature_c: float) -> float:
    """Return the power that a gearbox turns into heat [W] with its oil at a temperature."""
    viscosity_pa_s, viscosity_m2_s = oil.viscosity_pa_s(temperature_c), oil.kinematic_viscosity_m2_s(temperature_c)
    of_meshes = sum(one.loss_w(viscosity_pa_s) for one in meshes)
    return of_meshes + sum(one.loss_w(viscosity_m2_s) for one in shafts)


def sump_c(loss: Callable[[float], float], air_c: float, area_m2: float, warm_share: float = 1.0) -> float:
    """Return the temperature of the oil [°C].

    Parameters
    ----------
    loss : callable
        Temperature [°C] -> power [W].
    air_c, area_m2 : of the air around, and of the walls
    warm_share : of the rise that is there since the start
    """
    from scipy.optimize import brentq  # here: a tenth of a second that imports need not wait for

    surplus_w = _surplus_w(loss, air_c, area_m2)
    if surplus_w(max(air_c, COLDEST_C)) <= 0.0:
        return air_c
    hottest = max(HOTTEST_SUMP_C, air_c)
    end_c = hottest if surplus_w(hottest) >= 0.0 else float(brentq(surplus_w, air_c, hottest, xtol=1e-6))
    return air_c + warm_share * (end_c - air_c)


def _surplus_w(loss: Callable[[float], float], air_c: float, area_m2: float) -> Callable[[float], float]:
    return lambda oil_c: loss(oil_c) - HEAT_TRANSFER_W_PER_M2_K * area_m2 * (oil_c - air_c)
