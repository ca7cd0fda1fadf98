"""A hidden machine: its configuration, the recordings of its user, and features of records in tables.

A machine has fixed numbers and one transfer path; its bearings, masses, walls, relief, accuracy, housing and noise come
from ranges that no preset has. Its user has three healthy recordings of one gearbox.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.calibration.drivetrain import pair
from diagnostics.calibration.order_record import HIGHEST_SHARE, group_levels, line_groups, order_record
from diagnostics.indicators.record import record_values
from diagnostics.training.referenced import log_values
from siggen.views.path_curves import path_curves

FS_HZ, TEETH = 25_600.0, (18, 47)
CHANNELS = ("sensor_1_vertical", "sensor_2_horizontal")
SPALL = {"kind": "irregular", "gear": "pinion", "teeth": 1, "edge_radius_mm": 0.1}
HEALTHY = "healthy"
STATES = [
    {"name": HEALTHY},
    {"name": "healthy_again"},
    {"name": "partial", "severity": "slight", "damage": {**SPALL, "profile_length_mm": 1.0, "face_share": 0.4}},
    {"name": "through", "severity": "severe", "damage": {**SPALL, "profile_length_mm": 0.6, "face_share": 1.0}},
]
SMALL = {"name": "small", "severity": "slight", "damage": {**SPALL, "profile_length_mm": 0.6, "face_share": 0.25}}
"""Of the test records only, for `check_hidden_machines.py`: what `siggen init` calls slight."""
REFERENCES, TEST_HEALTHY, TEST_DAMAGED = 3, 18, 6
GEARBOXES = 8


def machine(number: int, folder: Path) -> dict[str, Any]:
    """Return the configuration of a hidden machine, its path in a file of the folder."""
    rng = np.random.default_rng([2026, number])

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    def rotor(mass: float, inertia: float) -> dict[str, Any]:
        kg, k = mass * log(0.6, 1.7), log(0.7e8, 5e8)
        damping = 2.0 * rng.uniform(0.02, 0.05) * np.sqrt(k * kg)
        axes = {f"bearing_stiffness_{axis}_n_per_m": k * rng.uniform(0.7, 1.4) for axis in "xy"}
        return {
            "mass_kg": kg,
            "inertia_kg_m2": inertia * log(0.6, 1.7),
            **axes,
            **{f"bearing_damping_{axis}_n_s_per_m": float(damping) for axis in "xy"},
        }

    relief = rng.uniform(3.0, 15.0)
    wall_mm = log(6.0, 20.0)
    found: dict[str, Any] = {
        "extends": "quickstart",
        "name": f"hidden_{number}",
        "seed": 90_000 + number,
        "specimens": 1 + GEARBOXES,
        "background": {"bearings": {}},
        "operating_points": [
            {
                "speed_hz": {"kind": "uniform", "low": 33.0, "high": 36.0},
                "torque_nm": {"kind": "uniform", "low": 25.0, "high": 45.0},
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
            "damping_ratio": {"kind": "uniform", "low": 0.015, "high": 0.05},
            "wall_mm": wall_mm,
        },
        "sensors": [
            {
                "name": f"sensor_{k + 1}",
                "place": place,
                "axes": [axis],
                "bits": 24,
                "noise": {"floor_m_s2": log(0.003, 0.03)},
            }
            for k, (place, axis) in enumerate((("lid", "vertical"), ("gear_end", "horizontal")))
        ],
    }
    return _with_own_path(found, folder)


def _with_own_path(found: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the machine with the path of its first gearbox for all of them."""
    from siggen.dataset.table_file import write_table_file

    file = (folder / "path.parquet").resolve()
    if not file.exists():
        write_table_file(path_curves(siggen.load_config({**found, "states": STATES[:1]})).table, file)
    for sensor in found["sensors"]:
        sensor |= {"place": "casing", "path": {"file": str(file)}}
    return found


def simulated(config: Any, gearboxes: Sequence[int], repeats: Sequence[int] = (0,)) -> list[tuple[str, Any]]:
    """Return state and record of every state of some gearboxes; records that failed are left out."""
    count = len(config.states)
    rows = [((g * count + s) * config.repeats + r) for g in gearboxes for s in range(count) for r in repeats]
    found = [siggen.simulate(config, [row])[0] for row in rows]
    return [(record.labels["state"], record) for record in found if hasattr(record, "channels")]


def features(channels: dict[str, np.ndarray], pulses_s: np.ndarray) -> np.ndarray:
    """Return the logarithms of the indicators of a record, in a fixed order."""
    values = record_values(dict(zip(CHANNELS, channels.values(), strict=True)), pulses_s, FS_HZ, TEETH).values
    return np.asarray(log_values(np.array([values[name] for name in sorted(values)])[None])[0])


@dataclass(frozen=True)
class Table:
    """Features (records, n), the same less the healthy record of the gearbox, and whether a record is damaged."""

    plain: np.ndarray
    beside: np.ndarray
    damaged: np.ndarray

    def part(self, chosen: np.ndarray) -> Table:
        """Return some of the rows."""
        return Table(self.plain[chosen], self.beside[chosen], self.damaged[chosen])


def training_table(records: Sequence[tuple[str, Any]]) -> tuple[Table, np.ndarray]:
    """Return features of records of several gearboxes, each less its first healthy record, and their gearboxes."""
    rows = [features(record.channels, np.asarray(record.tacho_s)) for _, record in records]
    gearbox = [record.planned.specimen_id for _, record in records]
    first = {g: row for g, row, (state, _) in zip(gearbox, rows, records, strict=True) if state == HEALTHY}
    used = [k for k, (state, _) in enumerate(records) if state != HEALTHY and gearbox[k] in first]
    plain = np.array([rows[k] for k in used])
    damaged = np.array([not records[k][0].startswith(HEALTHY) for k in used])
    beside = plain - np.array([first[gearbox[k]] for k in used])
    return Table(plain, beside, damaged), np.array([gearbox[k] for k in used])


@dataclass(frozen=True)
class Own:
    """The user's gearbox: files of the references, later records as a table, their states, true levels by channel."""

    files: list[Path]
    test: Table
    states: np.ndarray
    truth: list[dict[str, float]]


def own_records(folder: Path, number: int) -> Own:
    """Return the user's recordings and what he will measure later, from its files if they were made before."""
    folder.mkdir(parents=True, exist_ok=True)
    kept, files = folder / "own.npz", [folder / f"run{k}.npz" for k in range(REFERENCES)]
    if not kept.exists():
        records = _own_records(machine(number, folder))
        for (_, record), file in zip(records, files, strict=False):
            write_recording(record, file)
        rows = np.array([features(record.channels, np.asarray(record.tacho_s)) for _, record in records])
        states = np.array([state for state, _ in records])
        healthy = [record for state, record in records[REFERENCES:] if state == HEALTHY]
        truth = json.dumps([true_levels(healthy, k) for k in range(len(CHANNELS))])
        np.savez(kept, rows=rows, states=states, truth=np.array(truth))
    held = np.load(kept)
    plain, states = held["rows"][REFERENCES:], held["states"][REFERENCES:]
    test = Table(plain, plain - held["rows"][:REFERENCES].mean(axis=0), states != HEALTHY)
    return Own(files, test, states, json.loads(str(held["truth"])))


def _own_records(raw: dict[str, Any]) -> list[tuple[str, Any]]:
    """Return healthy records of the first gearbox, the references first, and its damaged ones."""
    repeats = REFERENCES + TEST_HEALTHY
    damaged = {**raw, "states": [SMALL, *STATES[2:]], "repeats": TEST_DAMAGED}
    healthy = siggen.load_config({**raw, "states": STATES[:1], "repeats": repeats})
    return simulated(healthy, [0], range(repeats)) + simulated(siggen.load_config(damaged), [0], range(TEST_DAMAGED))


def true_levels(healthy: Sequence[Any], channel: int) -> dict[str, float]:
    """Return the mean level [dB] of every group of lines and of the noise over records; lines to a common order."""
    signals = [(list(one.channels.values())[channel].astype(float), np.asarray(one.tacho_s)) for one in healthy]
    spectra = [order_record(signal, FS_HZ, pulses, pair(TEETH)) for signal, pulses in signals]
    groups = line_groups(pair(TEETH), HIGHEST_SHARE * FS_HZ / max(one.speed_hz for one in spectra))
    energy = np.array([group_levels(one, groups)[0] for one in spectra])
    levels = dict(zip((g.name for g in groups), (10.0 * np.log10(energy)).mean(axis=0).tolist(), strict=True))
    return {**levels, "noise": float(np.mean([10.0 * np.log10(one.floor.sum()) for one in spectra]))}


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
