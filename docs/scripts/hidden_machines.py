"""Machines of a family of their own, and what `calibrate` gains on them.

`python docs/scripts/hidden_machines.py FOLDER --machines 30`; about three minutes of CPU time for each; what is in
FOLDER is not made again. A machine has fixed numbers and one transfer path; its bearings, masses, bolts, relief,
accuracy, housing and noise come from ranges that no preset has. Its user has three healthy recordings of one gearbox.
Printed are CPU times, AUCs of a detector (logistic regression on logarithms of the indicators) that was trained on the
calibrated set, on the uncalibrated rig and on eight other gearboxes of the machine itself, and how often 90 % intervals
hold the true level.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from typer.testing import CliRunner

import siggen
from diagnostics.calibration.order_record import HIGHEST_SHARE, group_levels, line_groups, order_record
from diagnostics.cli.app import app as diagnostics_app
from diagnostics.indicators.record import record_values
from diagnostics.training.log_features import log_values
from siggen.cli.app import app as siggen_app
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
REFERENCES, TEST_HEALTHY, TEST_DAMAGED = 3, 6, 6
TRUE_GEARBOXES, SET_GEARBOXES, LIBRARY = 8, 8, 16
PENALTY = 0.03
INTERVAL = 0.9
SETS = ("true", "rig", "calibrated")


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
    bolts = {"shear_stiffness_n_per_m": log(3e7, 3e8), "axial_stiffness_n_per_m": log(6e7, 5e8)}
    modes = int(rng.integers(4, 25))
    found: dict[str, Any] = {
        "extends": "quickstart",
        "name": f"hidden_{number}",
        "seed": 90_000 + number,
        "specimens": 1 + TRUE_GEARBOXES,
        "background": None,
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
            "casing": {"mass_kg": log(10.0, 50.0), "bolts": {**bolts, "damping_ratio": float(rng.uniform(0.02, 0.06))}},
            "mesh": {"tip_relief_um": float(relief)},
        },
        "manufacture": {"accuracy_class": int(rng.integers(4, 9)), "tolerance_share": float(rng.uniform(0.3, 0.6))},
        "variation": {"speed": {"random_rms": log(1e-4, 8e-4)}},
        "housing": {
            "modes": modes + 0.5,
            "frequency_hz": {"kind": "uniform", "low": 250.0, "high": 9000.0},
            "damping_ratio": {"kind": "uniform", "low": 0.015, "high": 0.05},
            "modal_mass_kg": log(8.0, 50.0),
            "residue_exponent": float(rng.uniform(0.5, 2.0)),
            "force_noise": {"density_n_per_sqrt_hz": log(0.03, 0.3), "corner_hz": log(500.0, 8000.0)},
        },
        "sensors": [
            {
                "name": f"sensor_{k + 1}",
                "place": "casing",
                "position_mm": place,
                "axes": [axis],
                "bits": 24,
                "path": {"kind": "modal", "rigid": False},
                "noise": {"floor_m_s2": log(0.003, 0.03)},
            }
            for k, (place, axis) in enumerate((([60.0, 50.0], "vertical"), ([-100.0, -20.0], "horizontal")))
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
        del sensor["position_mm"]
        sensor["path"] = {"kind": "measured", "file": str(file)}
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


def training_table(records: Sequence[tuple[str, Any]]) -> Table:
    """Return the features of records of several gearboxes; the first healthy record of each is its reference."""
    rows = [features(record.channels, np.asarray(record.tacho_s)) for _, record in records]
    gearbox = [record.planned.specimen_id for _, record in records]
    first = {g: row for g, row, (state, _) in zip(gearbox, rows, records, strict=True) if state == HEALTHY}
    used = [k for k, (state, _) in enumerate(records) if state != HEALTHY and gearbox[k] in first]
    plain = np.array([rows[k] for k in used])
    return Table(plain, plain - np.array([first[gearbox[k]] for k in used]), _damaged([records[k] for k in used]))


def test_table(records: Sequence[tuple[str, Any]], references: Sequence[Any]) -> Table:
    """Return the features of the user's later records, and less the mean of the references."""
    plain = np.array([features(record.channels, np.asarray(record.tacho_s)) for _, record in records])
    own = np.array([features(record.channels, np.asarray(record.tacho_s)) for record in references])
    return Table(plain, plain - own.mean(axis=0), _damaged(records))


def _damaged(records: Sequence[tuple[str, Any]]) -> np.ndarray:
    return np.array([not state.startswith(HEALTHY) for state, _ in records])


def detector_auc(training: Table, test: Table) -> tuple[float, float]:
    """Return the AUC of a logistic regression, plain and beside healthy records, on what is finite everywhere."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.metrics import roc_auc_score
    from sklearn.preprocessing import StandardScaler

    found = []
    for name in ("plain", "beside"):
        rows, later = getattr(training, name), getattr(test, name)
        known = np.isfinite(rows).all(axis=0) & np.isfinite(later).all(axis=0)
        scaler = StandardScaler().fit(rows[:, known])
        model = LogisticRegression(C=PENALTY, max_iter=3000).fit(scaler.transform(rows[:, known]), training.damaged)
        found.append(float(roc_auc_score(test.damaged, model.decision_function(scaler.transform(later[:, known])))))
    return found[0], found[1]


def tacho_waveform(time_s: np.ndarray, pulses_s: np.ndarray) -> np.ndarray:
    """Return pulses of 3 ms that rise over four samples about their time, as behind the filter of a recorder."""
    nearest = pulses_s[np.abs(time_s[:, None] - pulses_s).argmin(axis=1)]
    since = time_s - nearest
    return np.asarray(5.0 * np.clip(0.5 + since * FS_HZ / 4.0, 0.0, 1.0) * (since < 0.003))


def write_csv(record: Any, file: Path) -> Path:
    """Write a record with a tacho's waveform."""
    time_s = np.arange(next(iter(record.channels.values())).size) / FS_HZ
    columns = [*record.channels.values(), tacho_waveform(time_s, record.tacho_s)]
    np.savez(file, **dict(zip((*CHANNELS, "tacho"), columns, strict=True)))
    return file


def user(folder: Path, files: Sequence[Path]) -> tuple[Path, Path, float]:
    """Do what the user does: a rig from the drawing, a calibration; return both files and the CPU time [s]."""
    rig, mine = folder / "rig.yaml", folder / "mine.yaml"
    if not rig.exists():
        drawing = ["--teeth", "18,47", "--module", "3", "--face-width", "20", "--speed", "33,36", "--torque", "25,45"]
        CliRunner().invoke(siggen_app, ["init", *drawing, "--out", str(rig)], catch_exceptions=False)
    start = time.process_time()
    if not mine.exists():
        options = [
            "--tacho",
            "tacho",
            "--fs",
            "25600",
            "--gearboxes",
            str(LIBRARY),
            "--compared",
            "0",
            "--out",
            str(mine),
        ]
        result = CliRunner().invoke(diagnostics_app, ["calibrate", str(rig), *map(str, files), *options])
        if result.exit_code:
            raise SystemExit(f"{folder}: {result.output} {result.exception}")
    return rig, mine, time.process_time() - start


def own_records(
    folder: Path, number: int, *, with_others: bool = True
) -> tuple[list[Any], list[tuple[str, Any]], list[tuple[str, Any]]]:
    """Return the user's healthy records, the test records, and records of other gearboxes of the machine."""
    raw = machine(number, folder)
    repeats = REFERENCES + TEST_HEALTHY
    own = simulated(siggen.load_config({**raw, "states": STATES[:1], "repeats": repeats}), [0], range(repeats))
    damaged = simulated(
        siggen.load_config({**raw, "states": STATES[2:], "repeats": TEST_DAMAGED}), [0], range(TEST_DAMAGED)
    )
    gearboxes = range(1, 1 + TRUE_GEARBOXES) if with_others else ()
    others = simulated(siggen.load_config({**raw, "states": STATES}), gearboxes)
    return [record for _, record in own[:REFERENCES]], [*own[REFERENCES:], *damaged], others


def coverage(mine: Path, test: Sequence[tuple[str, Any]]) -> list[bool]:
    """Return whether each 90 % interval holds the mean level of the gearbox's other healthy records."""
    facts = json.loads((mine.parent / "mine_data" / "calibration.json").read_text())
    groups = line_groups(TEETH, HIGHEST_SHARE * FS_HZ / max(facts["speed_hz"]))
    healthy = [record for state, record in test if state == HEALTHY]
    held = []
    for k, fitted in enumerate(facts["channels"].values()):
        signals = [(list(one.channels.values())[k].astype(float), np.asarray(one.tacho_s)) for one in healthy]
        spectra = [order_record(signal, FS_HZ, pulses, TEETH) for signal, pulses in signals]
        energy = np.array([group_levels(one, groups)[0] for one in spectra])
        truth = dict(zip((g.name for g in groups), 10.0 * np.log10(energy).mean(axis=0), strict=True))
        truth["noise"] = float(np.mean([10.0 * np.log10(one.floor.sum()) for one in spectra]))
        for name, (_, low, high) in {**fitted["line_level_db"], "noise": fitted["noise_level_db"]}.items():
            held.append(bool(low <= truth[name] <= high))
    return held


def judged(folder: Path, number: int) -> dict[str, Any]:
    """Return AUCs, coverage and CPU time of one machine, from its file if it was judged before."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "judged.json"
    if not file.exists():
        references, test_records, others = own_records(folder, number)
        files = [write_csv(record, folder / f"run{k}.npz") for k, record in enumerate(references)]
        rig, mine, seconds = user(folder, files)
        test = test_table(test_records, references)
        sets = {"true": training_table(others)}
        for name, source in (("rig", rig), ("calibrated", mine)):
            config = siggen.load_config(source, [f"states={json.dumps(STATES)}", f"specimens={SET_GEARBOXES}"])
            sets[name] = training_table(simulated(config, range(SET_GEARBOXES)))
        found = {name: detector_auc(one, test) for name, one in sets.items()}
        held = coverage(mine, test_records)
        file.write_text(
            json.dumps({**found, "coverage": float(np.mean(held)), "intervals": len(held), "cpu_s": seconds})
        )
    return dict(json.loads(file.read_text()))


def main() -> None:
    """Print AUCs, plain / beside healthy records, one row per machine; means with 90 % intervals over machines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=30)
    said = parser.parse_args()
    print("| machine | true machine | uncalibrated | calibrated | 90 % intervals that hold | calibrate, CPU s |")
    print("|---|---|---|---|---|---|")
    rows = []
    for number in range(said.machines):
        one = judged(said.folder / f"machine_{number}", number)
        rows.append([*(value for name in SETS for value in one[name]), one["coverage"], one["cpu_s"]])
        shown = " | ".join(f"{one[name][0]:.2f} / {one[name][1]:.2f}" for name in SETS)
        print(f"| {number} | {shown} | {one['coverage']:.2f} | {one['cpu_s']:.0f} |", flush=True)
    values = np.array(rows)
    pairs = [" / ".join(interval(values[:, 2 * k + j]) for j in (0, 1)) for k in range(len(SETS))]
    print("| mean | " + " | ".join([*pairs, interval(values[:, -2])]) + f" | {values[:, -1].mean():.0f} |")
    for name, (a, b) in {"calibrated - true": (2, 0), "calibrated - uncalibrated": (2, 1)}.items():
        told = (interval(values[:, 2 * a + j] - values[:, 2 * b + j]) for j in (0, 1))
        print(f"{name}: " + " / ".join(told))


def interval(values: np.ndarray) -> str:
    """Return the mean with its 90 % interval (Student's t over machines)."""
    from scipy.stats import t

    if values.size < 2:
        return f"{values.mean():.2f}"
    reach = t.ppf(0.5 + 0.5 * INTERVAL, values.size - 1) * values.std(ddof=1) / np.sqrt(values.size)
    return f"{values.mean():.2f} [{values.mean() - reach:.2f}, {values.mean() + reach:.2f}]"


if __name__ == "__main__":
    main()
