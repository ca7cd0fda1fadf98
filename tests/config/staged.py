"""A small configuration of two meshes in a row, for tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tests.config.minimal import by_name, minimal

SPALL = {"kind": "spall", "face_length_mm": 8.0, "profile_length_mm": 1.0, "depth_mm": 0.2}
FAST = {
    "module_mm": 2.0,
    "face_width_mm": 20.0,
    "pinion": {"teeth": 18, "bore_radius_mm": 12.0},
    "gear": {"teeth": 47, "bore_radius_mm": 15.0},
}
SLOW = {
    "name": "slow",
    "gears": {
        "module_mm": 3.0,
        "face_width_mm": 30.0,
        "pinion": {"teeth": 17, "bore_radius_mm": 15.0},
        "gear": {"teeth": 52, "bore_radius_mm": 25.0},
    },
}
"""A mesh behind others: `gears`, its shaft in `gear`, the span of the shaft in front of it, its direction."""


def in_a_row(
    first: Mapping[str, Any], stages: Sequence[Mapping[str, Any]], rotors: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return a machine of gears pinion, gear, slow_pinion, slow_gear, on shafts pinion, gear and slow."""
    shafts = [{"name": which, **(rotors or {}).get(which, {})} for which in ("pinion", "gear")]
    gears, meshes, front = [], [], ""
    for name, stage in zip(("", *(one["name"] for one in stages)), ({"gears": first}, *stages), strict=True):
        if name:
            shafts[-1]["span_mm"] = stage.get("span_mm")
            shafts.append({"name": name, **stage.get("gear", {})})
        pair, both = dict(stage["gears"]), [f"{name}_{which}".lstrip("_") for which in ("pinion", "gear")]
        on = (front or "gear", name) if name else ("pinion", "gear")
        gears += [
            {"name": gear, "shaft": shaft, **pair.pop(which)}
            for gear, shaft, which in zip(both, on, ("pinion", "gear"), strict=True)
        ]
        direction = {key: stage[key] for key in ("direction_deg",) if key in stage}
        meshes.append({"name": name or "fast", "driver": both[0], "driven": both[1], **pair, **direction})
        front = name
    return {"shafts": by_name(shafts), "gears": by_name(gears), "meshes": by_name(meshes)}


def staged(stages: Sequence[Mapping[str, Any]] = (SLOW,), **changes: Any) -> dict[str, Any]:
    """Return a valid mapping of a gearbox with 18/47 teeth and a mesh `slow` of 17/52 behind it."""
    raw = {
        "machine": in_a_row(FAST, stages),
        "dynamics": {"model": "8dof"},
        "operating_points": [{"speed_hz": 30.0, "torque_nm": 20.0}],
        "states": {"healthy": {}, "severe": {"damage": {**SPALL, "gear": "slow_pinion", "teeth": 1}}},
    }
    found = minimal(**{**raw, "sensors": {"bearing": {}}, **changes})
    return {key: value for key, value in found.items() if key != "gears"}
