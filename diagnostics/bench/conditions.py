"""Conditions of the test parts, as what differs from the configuration to learn from; sizes of the tiers.

Sizes: two unlike detectors that differ by an AUC of 0.05 need 135 to 177 paired gearboxes for a power of 80 % at 5 %
(computed with detectors of bench); hence 180 a condition in `full`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

SPEED, TORQUE = [32.5, 37.0], [30.0, 60.0]
HEALTHY: Mapping[str, Any] = {"healthy": {}, "healthy_again": {}}
MODERATE = {"severity": "moderate"}
SPALL = {
    "kind": "irregular",
    "gear": "pinion",
    "teeth": 1,
    "centre_height_mm": "below_pitch",
    "profile_length_mm": 0.3,
    "face_share": 1.0,
    "skew_mm_per_10mm": [-0.054, 0.054],
}
OTHER_FAULTS = {
    **HEALTHY,
    "crack": {
        **MODERATE,
        "damage": {"kind": "crack", "gear": "pinion", "depth_share": [0.15, 0.35], "angle_deg": [45.0, 65.0]},
    },
    "chip": {**MODERATE, "damage": {"kind": "chip", "gear": "pinion", "height_mm": [0.3, 1.0]}},
    "wear": {**MODERATE, "damage": {"kind": "wear", "depth_um": [10.0, 30.0]}},
    "bearing": {**MODERATE, "damage": {"kind": "bearing_spall", "element": "outer", "length_mm": [1.0, 3.0]}},
    "sham": {"acts": False, "damage": SPALL},
}
"""Faults of `confusers` with the sizes that it has: none of them is learned from."""

TEETH = ((20, 51), (22, 45), (23, 37), (24, 61))
PAIRS = [{"teeth": list(teeth), "module_mm": 3.0, "face_width_mm": 20.0} for teeth in TEETH]
SHAFTS = {"shafts": {"driver": {"diameter_mm": [30.0, 38.0]}}}
"""Diameters for 18 teeth, which grow with the pair: 45 mm would not fit the root circles of all."""
CONDITIONS: Mapping[str, Mapping[str, Any]] = {
    "same": {},
    "other_speed": {"operating_points": [{"speed_hz": [25.0, 29.0], "torque_nm": TORQUE}]},
    "other_torque": {"operating_points": [{"speed_hz": SPEED, "torque_nm": [12.0, 20.0]}]},
    "new_pair": {"gears": {"pairs": PAIRS}, "dynamics": SHAFTS},
    "other_place": {"sensors": {"first": {"place": "wall"}, "second": {"place": "pinion_end"}}},
    "other_fault": {"states": OTHER_FAULTS},
}
"""Name -> top-level keys that differ."""
LIFE_CONDITIONS: Mapping[str, Mapping[str, Any]] = {"same": {}, "other_load": {"life": {"history": [[1.0, 1.05]]}}}
"""The same of lives; 5 % more torque wears 1.05^10 = 1.6 times as fast."""


@dataclass(frozen=True, slots=True)
class Tier:
    """How many gearboxes to learn from, and in each test part."""

    learn: int
    test: int


TIERS: Mapping[str, Tier] = {"tiny": Tier(12, 6), "small": Tier(60, 24), "full": Tier(300, 180)}


ALONE = "_alone"
"""Ending of a part of which each gearbox has one record and no reference."""


def is_alone(part: str) -> bool:
    """Return whether records of a part are judged by themselves; asked records of one gearbox would tell each other."""
    return part.endswith(ALONE)


def parts_of(parts: Sequence[str], *, referenced: bool) -> tuple[str, ...]:
    """Return the test parts that a track asks, by whether it uses references; all where none is judged alone."""
    split = any(map(is_alone, parts))
    return tuple(name for name in parts if not split or is_alone(name) != referenced)


def with_alone(conditions: Mapping[str, Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    """Return conditions, and each again for gearboxes of which one record is shown."""
    return {**conditions, **{f"{name}{ALONE}": changes for name, changes in conditions.items()}}


def changed(config: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration with what a condition changes; sections stay but for the keys named, states are others."""
    named = {name: value if name == "states" else _merged(config.get(name), value) for name, value in changes.items()}
    return {**config, **named}


def _merged(section: Any, value: Any) -> Any:
    """Return a section with the keys of a mapping, or the value itself; a section of another kind is a value."""
    if not isinstance(value, Mapping) or not isinstance(section, Mapping) or "kind" in value:
        return value
    return {**section, **{name: _merged(section.get(name), own) for name, own in value.items()}}
