"""A machine of two meshes and three shafts with names of its own, for tests."""

from __future__ import annotations

from typing import Any

from tests.config.minimal import minimal
from tests.config.staged import SPALL

MACHINE: dict[str, Any] = {
    "shafts": {"output": {"mass_kg": 6.0}, "input": {}, "middle": {"span_mm": 120.0}},
    "gears": {
        "karl": {"teeth": 52, "bore_radius_mm": 25.0, "shaft": "output"},
        "ida": {"teeth": 18, "bore_radius_mm": 12.0, "shaft": "input"},
        "otto": {"teeth": 47, "bore_radius_mm": 15.0, "shaft": "middle"},
        "eva": {"teeth": 17, "bore_radius_mm": 15.0, "shaft": "middle"},
    },
    "meshes": {
        "slow": {"driver": "eva", "driven": "karl", "module_mm": 3.0, "face_width_mm": 30.0},
        "fast": {"driver": "ida", "driven": "otto", "module_mm": 2.0, "face_width_mm": 20.0},
    },
}
"""In no order of power."""


def mill(**changes: Any) -> dict[str, Any]:
    """Return a valid mapping of a gearbox with 18/47 teeth, and 17/52 behind them; `tests.config.staged` renamed."""
    raw = {
        "machine": MACHINE,
        "dynamics": {"model": "8dof"},
        "operating_points": [{"speed_hz": 30.0, "torque_nm": 20.0}],
        "sensors": {"bearing": {"place": "input_bearing"}},
        "states": {"healthy": {}, "severe": {"damage": {**SPALL, "gear": "eva", "teeth": 1}}},
    }
    found = minimal(**{**raw, **changes})
    return {key: value for key, value in found.items() if key != "gears"}


def with_machine(key: str, name: str, **changes: Any) -> dict[str, Any]:
    """Return the machine with keys of one shaft, gear or mesh changed."""
    return {**MACHINE, key: {**MACHINE[key], name: {**MACHINE[key][name], **changes}}}
