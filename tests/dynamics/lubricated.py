"""The lubricated pair of gears that the tests of the contact share: 18/47 teeth, module 3 mm, 30 N m, 30 Hz."""

from __future__ import annotations

from math import pi

from siggen.mesh.lubrication import LubricatedMesh, effective_modulus
from tests.gears.builders import pair_18_47

PAIR = pair_18_47(module_m=3e-3)
SPEED_1 = 2.0 * pi * 30.0
SPEED_2 = SPEED_1 * 18 / 47
FORCE = 30.0 / PAIR.pinion.base_radius_m
PITCH_POINT = PAIR.pitch_point_m
LINE = PAIR.line_of_action_m
RANGE = (PAIR.contact_start_m - 0.5e-3, PAIR.contact_end_m + 0.5e-3)
MODULUS = effective_modulus(206e9, 0.3)


def mesh(**other: float) -> LubricatedMesh:
    numbers = {
        "line_m": LINE,
        "speed_1_rad_s": SPEED_1,
        "speed_2_rad_s": SPEED_2,
        "contact_length_m": 20e-3,
        "effective_modulus_pa": MODULUS,
        "viscosity_pa_s": 0.115,
        "pressure_viscosity_per_pa": 2.2e-8,
        "viscosity_fall_per_k": 0.052,
        "inlet_temperature_k": 323.15,
        "boundary_friction": 0.09,
    }
    return LubricatedMesh(**(numbers | other))
