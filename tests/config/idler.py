"""A machine of three gears in a row, the middle one in both meshes, for tests."""

from __future__ import annotations

from typing import Any

from tests.config.mill import mill
from tests.config.minimal import by_name
from tests.config.staged import SPALL

MACHINE: dict[str, Any] = {
    "shafts": {"input": {}, "middle": {}, "output": {}},
    "gears": {
        "a": {"teeth": 18, "bore_radius_mm": 12.0, "shaft": "input"},
        "b": {"teeth": 27, "bore_radius_mm": 12.0, "shaft": "middle"},
        "c": {"teeth": 35, "bore_radius_mm": 15.0, "shaft": "output"},
    },
    "meshes": {
        "first": {"driver": "a", "driven": "b", "module_mm": 2.0, "face_width_mm": 20.0},
        "second": {
            "driver": "b", "driven": "c", "module_mm": 2.0, "face_width_mm": 20.0, "direction_deg": 60.0,
        },
    },
}  # fmt: skip


def idler(**changes: Any) -> dict[str, Any]:
    """Return a valid mapping of the machine, with a spall on tooth 5 of either flank of the idler."""
    spall = {**SPALL, "teeth": [5], "face_length_mm": 20.0}
    states = [
        {"name": "healthy"},
        {"name": "front", "severity": "severe", "damage": {**spall, "gear": "first.b"}},
        {"name": "behind", "severity": "severe", "damage": {**spall, "gear": "second.b"}},
    ]
    return mill(**{"machine": MACHINE, "states": by_name(states), **changes})


def with_idler(key: str, name: str, **changes: Any) -> dict[str, Any]:
    """Return the machine with keys of one shaft, gear or mesh changed."""
    return {**MACHINE, key: {**MACHINE[key], name: {**MACHINE[key][name], **changes}}}
