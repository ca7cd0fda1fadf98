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
    ".poisson_ratio": "leave it out: it is 0.3, that of steel and cast iron",
    ".youngs_modulus_gpa": "leave it out: it is 206, that of steel",
    "stiffness.coupling": "leave it out: teeth of beam: calibrated deflect each other, all others do not",
    "dynamics.sizing": "leave it out: every gearbox draws what its maker chose",
    "life.damage": "leave it out: every gearbox draws its exponent of the torque from 4.3 to 8.8",
    ".velocity_um_s": "leave it out: bearings draw {log: [20, 200]} for each band of ISO 15242",
    "variation.speed.rated_torque_nm": "leave it out: the slip belongs to dynamics.rated_torque_nm",
    "dynamics.shafts.pinion": "write dynamics.shafts.driver",
    "dynamics.shafts.gear": "write dynamics.shafts.driven",
    ".bearing_stiffness_x_n_per_m": "write bearing: {stiffness_n_per_m: ...}, of both directions across the shaft",
    ".bearing_stiffness_y_n_per_m": "write bearing: {stiffness_n_per_m: {each: [horizontal, vertical]}}",
    ".bearing_stiffness_z_n_per_m": "write bearing: {axial_stiffness_n_per_m: ...}",
    ".bearing_damping_x_n_s_per_m": "write bearing: {damping_n_s_per_m: ...}, of both directions across the shaft",
    ".bearing_damping_y_n_s_per_m": "write bearing: {damping_n_s_per_m: {each: [horizontal, vertical]}}",
    **{
        f".{key}": "belongs to the geometry of a bearing: bearing: {geometry: {...}}"
        for key in ("balls", "ball_diameter_mm", "pitch_diameter_mm", "clearance_um")
    },
    **{f".{key}": f"write {now}" for key, now in RENAMED.items()},
}
"""Former key -> the words of its refusal; behind a dot it is the last part of any path."""


def former_key(path: str) -> str:
    """Return how to write now what a former key said; nothing of other keys."""
    return NOW.get(path) or NOW.get(f".{path.rpartition('.')[2]}", "")
