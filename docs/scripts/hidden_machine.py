"""A hidden machine: its configuration, a recording of its user, and features of records.

A machine has fixed numbers and one transfer path; its bearings, masses, walls, relief, accuracy, housing and noise come
from ranges that no preset has.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.indicators.record import record_values
from diagnostics.training.referenced import log_values
from siggen.views.path import path_curves

FS_HZ, TEETH = 25_600.0, (18, 47)
CHANNELS = ("sensor_1_vertical", "sensor_2_horizontal")
SPALL = {"kind": "irregular", "gear": "pinion", "teeth": 1, "edge_radius_mm": 0.1}
HEALTHY = "healthy"
STATES = {
    HEALTHY: {},
    "healthy_again": {},
    "partial": {"severity": "slight", "damage": {**SPALL, "profile_length_mm": 1.0, "face_share": 0.4}},
    "through": {"severity": "severe", "damage": {**SPALL, "profile_length_mm": 0.6, "face_share": 1.0}},
}


def machine(number: int, folder: Path) -> dict[str, Any]:
    """Return the configuration of a hidden machine, its path in a file of the folder."""
    rng = np.random.default_rng([2026, number])

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    def rotor(mass: float, inertia: float) -> dict[str, Any]:
        kg, k = mass * log(0.6, 1.7), log(0.7e8, 5e8)
        damping = 2.0 * rng.uniform(0.02, 0.05) * np.sqrt(k * kg)
        axes = [k * rng.uniform(0.7, 1.4) for _ in "xy"]
        return {
            "mass_kg": kg,
            "inertia_kg_m2": inertia * log(0.6, 1.7),
            "bearing": {"stiffness_n_per_m": {"each": axes}, "damping_n_s_per_m": float(damping)},
        }

    relief = rng.uniform(3.0, 15.0)
    wall_mm = log(6.0, 20.0)
    found: dict[str, Any] = {
        "extends": "quickstart",
        "name": f"hidden_{number}",
        "seed": 90_000 + number,
        "specimens": 9,
        "background": {"bearings": {}},
        "operating_points": [
            {
                "speed_hz": [33.0, 36.0],
                "torque_nm": [25.0, 45.0],
            }
        ],
        "dynamics": {
            "pinion": rotor(1.0, 1.6e-4),
            "gear": rotor(3.0, 6.4e-3),
            "mesh_damping_ratio": float(rng.uniform(0.03, 0.12)),
            "mesh": {"tip_relief_um": float(relief)},
        },
        "manufacture": {"accuracy_class": int(rng.integers(4, 9)), "tolerance_share": float(rng.uniform(0.3, 0.6))},
        "variation": {"speed": {"random_rms": log(1e-4, 8e-4)}},
        "housing": {
            "damping_ratio": [0.015, 0.05],
            "wall_mm": wall_mm,
        },
        "sensors": {"others": None}
        | {
            f"sensor_{k + 1}": {
                "place": place,
                "axes": [axis],
                "bits": 24,
                "noise": {"floor_m_s2": log(0.003, 0.03)},
            }
            for k, (place, axis) in enumerate((("lid", "vertical"), ("gear_end", "horizontal")))
        },
    }
    return _with_own_path(found, folder)


def _with_own_path(found: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the machine with the path of its first gearbox for all of them."""
    from siggen.dataset.table_file import write_table_file

    file = (folder / "path.parquet").resolve()
    if not file.exists():
        config = siggen.load_config({**found, "states": {"others": None, HEALTHY: {}}})
        write_table_file(path_curves(config.gearbox(0), config.config.mesh_harmonics).table, file)
    for sensor in filter(None, found["sensors"].values()):
        sensor |= {"place": "casing", "path": {"file": str(file)}}
    return found


def features(channels: dict[str, np.ndarray], pulses_s: np.ndarray) -> np.ndarray:
    """Return the logarithms of the indicators of a record, in a fixed order."""
    values = record_values(dict(zip(CHANNELS, channels.values(), strict=True)), pulses_s, FS_HZ, TEETH).values
    return np.asarray(log_values(np.array([values[name] for name in sorted(values)])[None])[0])


def tacho_waveform(time_s: np.ndarray, pulses_s: np.ndarray) -> np.ndarray:
    """Return pulses of 3 ms that rise over four samples about their time, as behind the filter of a recorder."""
    nearest = pulses_s[np.abs(time_s[:, None] - pulses_s).argmin(axis=1)]
    since = time_s - nearest
    return np.asarray(5.0 * np.clip(0.5 + since * FS_HZ / 4.0, 0.0, 1.0) * (since < 0.003))


def write_recording(record: Any, file: Path) -> Path:
    """Write a record with the waveform of a tacho."""
    time_s = np.arange(next(iter(record.channels.values())).size) / FS_HZ
    columns = [*record.channels.values(), tacho_waveform(time_s, record.tacho_s)]
    np.savez(file, **dict(zip((*CHANNELS, "tacho"), columns, strict=True)))
    return file
