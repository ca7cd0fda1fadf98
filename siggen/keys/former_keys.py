"""Keys that files had before, and how to write now what they said."""

from __future__ import annotations

RENAMED = {
    "pinion_encoder": "driver_encoder",
    "gear_encoder": "driven_encoder",
    "pinion_depth": "driver_depth",
    "gear_depth": "driven_depth",
    "accuracy_class_gear": "accuracy_class_driven",
    "crowning_gear_um": "crowning_driven_um",
}
NOW = {
    ".grows_from": "write grows: NAME of the milder state; a state without it begins anew",
    ".sham": "write acts: false",
    "stages": "write machine: with shafts, gears and meshes of your own names, in place of gears and stages",
    "variation.speed.rated_torque_nm": "leave it out: the slip belongs to dynamics.rated_torque_nm",
    **{f".{key}": f"write {now}" for key, now in RENAMED.items()},
}
"""Former key -> the words of its refusal; behind a dot it is the last part of any path."""
