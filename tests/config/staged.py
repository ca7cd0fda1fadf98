"""A small configuration of two stages, for tests."""

from __future__ import annotations

from typing import Any

from tests.config.minimal import minimal

SPALL = {"kind": "spall", "face_length_mm": 8.0, "profile_length_mm": 1.0, "depth_mm": 0.2}
SLOW = {
    "name": "slow",
    "gears": {
        "module_mm": 3.0,
        "face_width_mm": 30.0,
        "pinion": {"teeth": 17, "bore_radius_mm": 15.0},
        "gear": {"teeth": 52, "bore_radius_mm": 25.0},
    },
}


def staged(**changes: Any) -> dict[str, Any]:
    """Return a valid mapping of a gearbox with 18/47 teeth and a stage `slow` of 17/52 behind it."""
    raw = {
        "gears": {
            "module_mm": 2.0,
            "face_width_mm": 20.0,
            "pinion": {"teeth": 18, "bore_radius_mm": 12.0},
            "gear": {"teeth": 47, "bore_radius_mm": 15.0},
        },
        "stages": [SLOW],
        "dynamics": {"model": "8dof"},
        "operating_points": [{"speed_hz": 30.0, "torque_nm": 20.0}],
        "states": {"healthy": {}, "severe": {"damage": {**SPALL, "gear": "slow.pinion", "teeth": 1}}},
    }
    return minimal(**{**raw, **changes})
