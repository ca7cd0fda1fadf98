"""The smallest configuration that is complete, as a mapping to be changed."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from typing import Any

from siggen.config import Config, parse
from siggen.gearbox.design import SetDesign

MINIMAL: dict[str, Any] = {
    "name": "minimal",
    "seed": 7,
    "specimens": 20,
    "gears": {
        "module_mm": 3.0,
        "face_width_mm": 20.0,
        "pinion": {"teeth": 18, "bore_radius_mm": 10.0},
        "gear": {"teeth": 47, "bore_radius_mm": 15.0},
    },
    "operating_points": [{"speed_hz": 30.0, "torque_nm": 60.0}],
    "states": {
        "healthy": {},
        "slight": {
            "damage": {
                "kind": "layered",
                "layers": 1,
                "pits_per_layer": 4,
                "semi_axis_face_mm": 0.3,
                "semi_axis_profile_mm": 0.2,
                "depth_mm": 0.4,
            }
        },
    },
    "sensors": {"bearing": {}},
}


def by_name(entries: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return states or sensors with names as a file gives them."""
    return {one["name"]: {key: value for key, value in one.items() if key != "name"} for one in entries}


def minimal(**changes: Any) -> dict[str, Any]:
    """Return the mapping with dotted paths (dots written as two underscores) replaced."""
    raw = copy.deepcopy(MINIMAL)
    for path, value in changes.items():
        *parents, key = path.split("__")
        place: Any = raw
        for parent in parents:
            place = place[int(parent)] if isinstance(place, list) else place.setdefault(parent, {})
        place[int(key) if isinstance(place, list) else key] = value
    return raw


def config(**changes: Any) -> Config:
    """Return the configuration with dotted paths replaced."""
    parsed = parse(minimal(**changes))
    assert parsed.config is not None, [str(problem) for problem in parsed.problems]
    return parsed.config


def design(**changes: Any) -> SetDesign:
    """Return its design with dotted paths replaced."""
    return SetDesign(config(**changes))
