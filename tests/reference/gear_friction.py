"""Mean friction of a mesh beside two formulas fitted to measured gears: `python -m tests.reference.gear_friction`.

Schlenk (ISO/TR 14179-2) and Fernandes and others (fitted to losses of FZG gears, as in the open library GEARpie) give
one coefficient for a whole mesh. Neither knows the film, so only levels and exponents are compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, hypot, pi, sin

import numpy as np

from siggen.gears.gear_pair import GearPair
from siggen.mesh.asperities import asperity_table
from siggen.mesh.friction import FrictionLaw, composite_friction
from siggen.mesh.lubrication import LubricatedMesh, effective_modulus, relative_radius
from siggen.mesh.oil import MINERAL_OILS
from tests.dynamics.friction.mesh_loss import mesh_mean_friction, schlenk_mean_friction
from tests.gears.builders import pair_18_47

PAIR = pair_18_47(module_m=3e-3)
BOUNDARY = 0.09
"""Middle of the range from which gearboxes draw."""
RA_OVER_RQ = 0.8
"""Of a Gaussian profile: √(2/π)."""
MINERAL = 0.846
"""Factor of mineral oils in both formulas."""


@dataclass(frozen=True)
class Running:
    """A pair of gears under load: 18/47 teeth of module 3 mm, 20 mm wide, ISO VG 220 at 50 °C unless said."""

    speed_hz: float
    torque_nm: float
    oil: str = "ISO VG 220"
    temperature_c: float = 50.0
    rms_um: float = 0.4
    pair: GearPair = PAIR

    @property
    def force_n(self) -> float:
        return self.torque_nm / self.pair.pinion.base_radius_m

    @property
    def pitch_radius_m(self) -> float:
        return float(relative_radius(self.pair.pitch_point_m, self.pair.line_of_action_m))

    @property
    def pitch_line_speed_m_s(self) -> float:
        return 2.0 * pi * self.speed_hz * self.pair.pinion.base_radius_m / cos(self.angle_rad)

    @property
    def angle_rad(self) -> float:
        return float(np.arctan(self.pair.pitch_point_m / self.pair.pinion.base_radius_m))

    @cached_property
    def mesh(self) -> LubricatedMesh:
        oil, speed = MINERAL_OILS[self.oil], 2.0 * pi * self.speed_hz
        return LubricatedMesh(
            line_m=self.pair.line_of_action_m,
            speed_1_rad_s=speed,
            speed_2_rad_s=speed * self.pair.pinion.teeth / self.pair.gear.teeth,
            contact_length_m=self.pair.face_width_m,
            effective_modulus_pa=effective_modulus(206e9, 0.3),
            viscosity_pa_s=oil.viscosity_pa_s(self.temperature_c),
            pressure_viscosity_per_pa=oil.pressure_viscosity_per_pa(self.temperature_c),
            viscosity_fall_per_k=oil.viscosity_fall_per_k(self.temperature_c),
            inlet_temperature_k=self.temperature_c + 273.15,
            boundary_friction=BOUNDARY,
        )

    @cached_property
    def law(self) -> FrictionLaw:
        sigma_m = hypot(self.rms_um, self.rms_um) * 1e-6
        pair = self.pair
        places = 0.5 * pair.contact_start_m, 0.5 * (pair.contact_end_m + pair.line_of_action_m)
        return composite_friction(asperity_table(self.mesh, (sigma_m,), places, 10.0 * self.force_n), BOUNDARY)

    @cached_property
    def mean(self) -> float:
        return mesh_mean_friction(self.pair, self.law, self.torque_nm)

    @property
    def schlenk(self) -> float:
        return schlenk_mean_friction(
            self.force_n / self.pair.face_width_m, self.pitch_line_speed_m_s, self.angle_rad, self.pitch_radius_m,
            self.mesh.viscosity_pa_s, RA_OVER_RQ * self.rms_um * 1e-6, MINERAL,
        )  # fmt: skip

    @property
    def fernandes(self) -> float:
        """0.014 (1/S_p)^0.25 S_g^0.25 X_L, S_p = v_Σ η √α/√F, S_g = Ra/√(b ρ), SI."""
        speed = 2.0 * self.pitch_line_speed_m_s * sin(self.angle_rad)
        oil = self.mesh
        film = speed * oil.viscosity_pa_s * oil.pressure_viscosity_per_pa**0.5 / self.force_n**0.5
        rough = RA_OVER_RQ * self.rms_um * 1e-6 / (self.pair.face_width_m * self.pitch_radius_m) ** 0.5
        return float(0.014 * film**-0.25 * rough**0.25 * MINERAL)


RUNNING = [
    *(Running(speed, 40.0) for speed in (5.0, 10.0, 20.0, 30.0, 40.0)),
    *(Running(speed, torque) for speed in (5.0, 30.0) for torque in (6.0, 54.0)),
    *(Running(20.0, 40.0, f"ISO VG {grade}", celsius) for grade, celsius in ((100, 60.0), (320, 50.0), (220, 80.0))),
    *(Running(20.0, 40.0, rms_um=rough) for rough in (0.2, 0.3, 0.5)),
]  # fmt: skip


def name(case: Running) -> str:
    return f"{case.speed_hz:g} Hz, {case.torque_nm:g} N m, {case.oil}, {case.temperature_c:g} C, {case.rms_um:g} um"


if __name__ == "__main__":
    print("| case | siggen | Schlenk | Fernandes |\n|---|---|---|---|")
    for case in RUNNING:
        print(f"| {name(case)} | {case.mean:.3f} | {case.schlenk:.3f} | {case.fernandes:.3f} |")
