"""A small configuration of a planetary set, for tests."""

from __future__ import annotations

from typing import Any

from tests.config.minimal import minimal

SPALL = {"kind": "spall", "face_length_mm": 20.0, "profile_length_mm": 1.0, "depth_mm": 0.1, "teeth": 1}
DAMPED = {"damping_nm_s_per_rad": 2.3}
"""Ten times the default: couplings settle within 0.8 s in the place of 5 s, which were most of every simulation."""
CARRIER_HZ = 6.0
"""Of a sun of 25 teeth that turns with 24.48 Hz in a ring of 77."""


def planets(**changes: Any) -> dict[str, Any]:
    """Return a valid mapping of a set of 25, 26 and 77 teeth, of which one harmonic of the mesh in three is in step."""
    raw = {
        "specimens": 1,
        "fs_hz": 25_600.0,
        "duration_s": 0.5,
        "gears": {
            "module_mm": 2.0,
            "face_width_mm": 20.0,
            "pinion": {"teeth": 25, "bore_radius_mm": 8.0},
            "gear": {"teeth": 26, "bore_radius_mm": 8.0},
        },
        "planetary": {"ring_teeth": 77},
        "dynamics": {
            "model": "8dof",
            "friction": {"model": "off"},
            "mesh": {"tip_relief_um": 10.0},
            "motor_inertia_kg_m2": 1e-2,
            "load_inertia_kg_m2": 0.2,
            "input_coupling": DAMPED,
            "output_coupling": DAMPED,
        },
        "operating_points": [{"speed_hz": 24.48, "torque_nm": 60.0}],
        "states": {
            "healthy": {},
            "sun": {"severity": "severe", "damage": {**SPALL, "gear": "sun"}},
            "planet": {"severity": "severe", "damage": {**SPALL, "gear": "planet"}},
            "ring": {"severity": "severe", "damage": {**SPALL, "gear": "ring"}},
        },
        "sensors": {"ring": {"place": "ring", "axes": ["horizontal", "vertical"], "bits": None}},
    }
    return minimal(**{**raw, **changes})
