"""A machine of two meshes and three shafts with names of its own, for tests."""

from __future__ import annotations

from typing import Any

from tests.config.minimal import minimal
from tests.config.staged import SPALL

MACHINE: dict[str, Any] = {
    "shafts": [{"name": "output", "mass_kg": 6.0}, {"name": "input"}, {"name": "middle", "span_mm": 120.0}],
    "gears": [
        {"name": "karl", "teeth": 52, "bore_radius_mm": 25.0, "shaft": "output"},
        {"name": "ida", "teeth": 18, "bore_radius_mm": 12.0, "shaft": "input"},
        {"name": "otto", "teeth": 47, "bore_radius_mm": 15.0, "shaft": "middle"},
        {"name": "eva", "teeth": 17, "bore_radius_mm": 15.0, "shaft": "middle"},
    ],
    "meshes": [
        {"name": "slow", "driver": "eva", "driven": "karl", "module_mm": 3.0, "face_width_mm": 30.0},
        {"name": "fast", "driver": "ida", "driven": "otto", "module_mm": 2.0, "face_width_mm": 20.0},
    ],
}
"""Its lists are in no order of power."""


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


def with_machine(key: str, index: int, **changes: Any) -> dict[str, Any]:
    """Return the machine with keys of one shaft, gear or mesh changed."""
    entries = list(MACHINE[key])
    entries[index] = {**entries[index], **changes}
    return {**MACHINE, key: entries}
