"""One example of every kind: damage, sensors, sources, housings and meshes, and the machine that carries them."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import siggen

PIT = {"semi_axis_face_mm": 0.6, "semi_axis_profile_mm": 0.4, "depth_mm": 0.3}
DAMAGES: dict[str, dict[str, Any]] = {
    "layered": {"layers": 2, "pits_per_layer": 3, **PIT},
    "clustered": {"count": 6, "spread_profile_mm": 1.0, **PIT},
    "spall": {"face_length_mm": 12.0, "profile_length_mm": 1.5, "depth_mm": 0.4},
    "list": {"pits": [{"face_mm": 8.0, **PIT}]},
    "irregular": {"face_share": 1.0, "skew_mm_per_10mm": 0.0, "profile_length_mm": 1.5, "depth_mm": 0.4},
    "crack": {"depth_share": 0.25},
    "chip": {"height_mm": 1.5},
    "wear": {"depth_um": 20.0},
    "bearing_spall": {"element": "inner", "length_mm": 2.0, "depth_mm": 0.1},
}  # fmt: skip
"""Kind of damage -> its numbers."""

SIZES = {
    "layered": PIT, "clustered": PIT, "spall": ("face_length_mm", "profile_length_mm", "depth_mm"), "list": PIT,
    "irregular": ("profile_length_mm", "depth_mm"), "crack": ("depth_share",), "chip": ("height_mm",),
    "wear": ("depth_um",), "bearing_spall": ("length_mm", "depth_mm"),
}  # fmt: skip
"""Kind of damage -> the numbers without which there is none."""

SENSORS: dict[str, dict[str, Any]] = {
    "pinion": {"kind": "accelerometer", "place": "pinion_bearing", "axes": ["vertical", "horizontal"]},
    "in": {"kind": "encoder", "place": "pinion", "pulses_per_turn": 2000},
    "out": {"kind": "encoder", "place": "gear", "pulses_per_turn": 2000},
    "te": {"kind": "transmission_error", "driver_encoder": "in", "driven_encoder": "out"},
    "torque": {"kind": "coupling_torque", "place": "input_coupling", "range_nm": 1000},
    "washer": {"kind": "bearing_force", "place": "gear_bearing", "axes": ["vertical"], "range_n": 100000},
    "clamp": {"kind": "motor_current", "rated_torque_nm": 80},
}
"""Sensor -> its entry; one of every kind."""

SOURCES: dict[str, tuple[dict[str, Any], str]] = {
    "rubbing": ({}, ""),
    "bearings": ({}, ""),  # at velocity 0 balls still pass
    "machines": ({}, "density_n_per_sqrt_hz"),
    "shafts": ({}, ""),
    "second_stage": ({"order": 5.3}, "force_share"),
    "auxiliary_drive": ({"order": 3.7}, "force_share"),
}
"""Part of the background -> what it needs, and the number without which there is none."""

SHAPES = {
    "pinion_bearing_vertical": (0.2, 0.10), "pinion_bearing_horizontal": (0.05, -0.15),
    "gear_bearing_vertical": (0.18, -0.12), "gear_bearing_horizontal": (0.04, 0.2), "lid_vertical": (0.25, 0.4),
}  # fmt: skip
MODES = "\n".join(
    ",".join(row)
    for row in (
        ["frequency_hz", "damping_ratio", *(f"{seat}_per_sqrt_kg" for seat in SHAPES)],
        ["410", "0.05", *(f"{shape[0]}" for shape in SHAPES.values())],
        ["1730", "0.03", *(f"{shape[1]}" for shape in SHAPES.values())],
        "",
    )
)
"""Two modes, as a file has them."""

HOUSINGS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "plates": ({}, {"place": "lid"}),
    "rigid": ({}, {"place": "casing", "position_mm": [50.0, 40.0]}),
    "modal": ({"modes": MODES}, {"place": "casing"}),
}
"""Kind of housing -> what it needs, and where its sensor stands."""


MESHES: dict[str, tuple[Callable[[], siggen.Gearbox], list[float]]] = {
    "spur pair": (lambda: siggen.single_stage((23, 61), 2.5), [23]),
    "helical pair": (lambda: siggen.draw(siggen.load_config("helical")), [18]),
    "two stages": (
        lambda: siggen.machine(
            shafts={"input": {}, "middle": {}, "drum": {}},
            gears={
                "a": {"teeth": 18, "shaft": "input"}, "b": {"teeth": 47, "shaft": "middle"},
                "c": {"teeth": 17, "shaft": "middle"}, "d": {"teeth": 52, "shaft": "drum"},
            },
            meshes={"fast": {"gears": ["a", "b"], "module_mm": 2}, "slow": {"gears": ["c", "d"], "module_mm": 3}},
            rated_nm=60,
        ),
        [18, 17 * 18 / 47],
    ),
    "planetary set": (lambda: siggen.planetary((25, 26, 77), 2.0), [25 * 77 / (25 + 77)]),
}  # fmt: skip
"""Kind of mesh -> a machine of it, and the orders of its mesh lines: teeth times turns, per turn of the first shaft."""


def machine(**changes: Any) -> dict[str, Any]:
    """Return a small configuration of one pair as a file has it, with top-level keys replaced."""
    raw = {
        "name": "kinds", "seed": 11, "specimens": 1, "fs_hz": 25600.0, "duration_s": 0.06, "mesh_harmonics": 3,
        "gears": {
            "module_mm": 3.0, "face_width_mm": 20.0,
            "pinion": {"teeth": 18, "bore_radius_mm": 10.0}, "gear": {"teeth": 47, "bore_radius_mm": 15.0},
        },
        "dynamics": {
            "model": "8dof", "pinion": {"bearing": {"geometry": {}}}, "mesh": {"law": "pairs", "damage": "all"},
        },
        "operating_points": [{"speed_hz": [28, 32], "torque_nm": 60.0}],
        "states": {"healthy": {}},
        "sensors": {"bearing": {}},
    }  # fmt: skip
    return copy.deepcopy({**raw, **changes})


def smaller(kind: str, factor: float) -> dict[str, Any]:
    """Return a damage whose sizes are `factor` times those of the example."""
    damage = copy.deepcopy(DAMAGES[kind])
    for entry in damage.get("pits", [damage]):
        entry.update({key: factor * entry[key] for key in SIZES[kind]})
    return {"kind": kind, **damage}
