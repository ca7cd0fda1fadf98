"""Random legal configurations far from the presets: speed, torque, damping and size of a gearbox each over decades.

All lengths of quickstart go with the module, masses with its cube, and bearings with the module: drawn gearboxes are
built like it. Nothing else ties the numbers together: a small gearbox may carry next to nothing at 150 Hz.
"""

from __future__ import annotations

from math import ceil, exp, log
from random import Random

from benchmarks.shipped import ROOT, shipped
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign

SPEED_HZ, TORQUE_NM, DAMPING, MODULE_MM = (0.5, 150.0), (0.5, 200.0), (0.005, 0.3), (1.0, 6.0)
PRESET, PRESET_MODULE_MM = ROOT / "configs" / "quickstart.yaml", 3.0
LENGTHS_MM = {
    "gears.face_width_mm": 20.0,
    "gears.pinion.bore_radius_mm": 10.0,
    "gears.gear.bore_radius_mm": 15.0,
    "dynamics.shafts.driver.bearing_span_mm": 90.0,
    "dynamics.shafts.driven.bearing_span_mm": 90.0,
    "dynamics.shafts.driver.diameter_mm": 40.0,
    "dynamics.shafts.driven.diameter_mm": 42.0,
}
SPALL = "kind: irregular, gear: pinion, teeth: 1, centre_height_mm: below_pitch, face_share: 1.0"
SPALL_MM, STIFFNESS_N_PER_M = 1.5, 2e8
LEAST_S, LEAST_PITCHES, TEETH = 0.1, 6.0, 18


def drawn_numbers(number: int) -> dict[str, float]:
    """Return speed, torque, damping ratio and module of a configuration, each loguniform over its range."""
    rng = Random(f"integration anywhere {number}")
    ranges = {"speed_hz": SPEED_HZ, "torque_nm": TORQUE_NM, "damping_ratio": DAMPING, "module_mm": MODULE_MM}
    return {name: exp(rng.uniform(log(low), log(high))) for name, (low, high) in ranges.items()}


def random_config(number: int) -> SetDesign | None:
    """Return a configuration of one gearbox, healthy and spalled, some mesh periods long; None if it is refused."""
    drawn = drawn_numbers(number)
    size = drawn["module_mm"] / PRESET_MODULE_MM
    values = {name: f"{size * length}" for name, length in LENGTHS_MM.items()}
    values |= {
        "gears.module_mm": f"{drawn['module_mm']}",
        "dynamics.mesh_damping_ratio": f"{drawn['damping_ratio']}",
        "operating_points.0.speed_hz": f"{drawn['speed_hz']}",
        "operating_points.0.torque_nm": f"{drawn['torque_nm']}",
        "states": f"{{healthy: {{}}, severe: {{damage: {{{SPALL}, profile_length_mm: {size * SPALL_MM}}}}}}}",
        "duration_s": f"{ceil(100.0 * max(LEAST_S, LEAST_PITCHES / (TEETH * drawn['speed_hz']))) / 100.0}",
        "seed": f"{1000 + number}",
        "specimens": "1",
        "mesh_harmonics": "3",
    }
    for gear in ("pinion", "gear"):
        values[f"dynamics.{gear}.bearing.stiffness_n_per_m"] = f"{STIFFNESS_N_PER_M * size}"
        values |= {f"dynamics.{gear}.{name}": "null" for name in ("mass_kg", "inertia_kg_m2")}
    try:
        return shipped(PRESET, *(f"{name}={value}" for name, value in values.items()))
    except ConfigError:
        return None
