"""What sets mesh lines 2 to 5 of bench: `python docs/scripts/mesh_lines.py [GEARBOXES] [WORD ...]`.

Simulates one healthy record of 1 s of every gearbox with one thing changed at a time, and prints mesh lines 2 to 5 over
line 1 of the pinion's average: the median, and the share of channels within -30 to 12 dB. With words, only the changes
that contain one of them.
"""

from __future__ import annotations

import copy
import sys
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from siggen.checks.loading import load_config
from siggen.config.inheritance import inherited
from siggen.config.yaml_source import read_yaml
from siggen.record.simulation import simulate

CONFIGS = Path("configs")
STEPS, RANGE_DB, LINES = 1024, (-30.0, 12.0), (2, 3, 4, 5)
RELIEF, SHAFTS = "dynamics.mesh.tip_relief_um", "dynamics.shafts"
BOTH = ("pinion", "gear")
Changes = dict[str, Any]


def between(kind: str, low: float, high: float) -> dict[str, Any]:
    """Return a distribution."""
    return {"kind": kind, "low": low, "high": high}


def shafts(diameter: Any, span: Any) -> Changes:
    """Return shafts of one diameter and span [mm]."""
    sizes = {"diameter_mm": diameter, "bearing_span_mm": span}
    return {f"{SHAFTS}.{which}.{name}": value for which in BOTH for name, value in sizes.items()}


def bearings(stiffer: float, more_damped: float) -> Changes:
    """Return the bearings of bench with their stiffness and damping times a factor."""
    found: Changes = {}
    for axis in ("x", "y"):
        for which, damping in (("pinion", (560, 1130)), ("gear", (980, 1960))):
            words = f"dynamics.{which}.bearing_"
            found[f"{words}stiffness_{axis}_n_per_m"] = between("loguniform", 1.4e8 * stiffer, 2.6e8 * stiffer)
            low, high = (more_damped * value for value in damping)
            found[f"{words}damping_{axis}_n_s_per_m"] = between("loguniform", low, high)
    return found


def speed(speed_hz: float) -> Changes:
    """Return one speed of the pinion."""
    return {"operating_points": [{"speed_hz": speed_hz, "torque_nm": between("uniform", 15, 60)}]}


NARROW = {RELIEF: between("uniform", 6, 10)}
SLENDER = {**shafts(30, between("uniform", 110, 140)), f"{SHAFTS}.gear.diameter_mm": 35}
CHANGES: dict[str, Changes] = {
    "bench as it is": {},
    "no friction": {"dynamics.friction.model": "off"},
    "bearings four times as stiff": bearings(4, 2),
    "bearings with four times the damping": bearings(1, 4),
    "25 Hz": speed(25),
    "45 Hz": speed(45),
    "walls of 20 mm": {"housing": {"wall_mm": 20}},
    "relief 6 to 10 um": NARROW,
    "shafts of 30 and 35 mm on 110 to 140 mm": SLENDER,
    "both, as bench was before": {**NARROW, **SLENDER},
}


def changed(raw: dict[str, Any], changes: Changes) -> dict[str, Any]:
    """Return a configuration with values set by their paths."""
    found = copy.deepcopy(raw)
    for path, value in changes.items():
        *parents, name = path.split(".")
        section = found
        for parent in parents:
            section = section[parent]
        section[name] = value
    return found


def mesh_lines_db(raw: dict[str, Any], gearboxes: int) -> np.ndarray:
    """Return mesh lines 2 to 5 over line 1 of every gearbox and channel, (gearboxes * channels, 4)."""
    config = load_config({**raw, "specimens": gearboxes})
    rows = []
    for index in range(gearboxes):
        record = simulate(config, [index])[0]
        grid, teeth = angle_grid(record.tacho_s, STEPS), config.gears.pinion.teeth
        for signal in record.channels.values():
            average = resample_to_angle(signal, config.fs_hz, grid).reshape(-1, STEPS).mean(axis=0)
            lines = np.abs(np.fft.rfft(average))
            rows.append([20.0 * np.log10(lines[h * teeth] / lines[teeth]) for h in LINES])
    return np.array(rows)


def main(gearboxes: int, words: list[str]) -> None:
    """Print one row per change."""
    raw = inherited(read_yaml(CONFIGS / "bench.yaml"), CONFIGS)
    raw = {**raw, "states": raw["states"][:1], "duration_s": 1.0}
    print("| one thing changed | mesh 2 to 5 re 1, median [dB] | inside |\n|---|---|---|")
    for name, changes in CHANGES.items():
        if words and not any(word in name for word in words):
            continue
        found = mesh_lines_db(changed(raw, changes), gearboxes)
        inside = ((found >= RANGE_DB[0]) & (found <= RANGE_DB[1])).mean(axis=0)
        middle = ", ".join(f"{value:.0f}" for value in np.median(found, axis=0))
        print(f"| {name} | {middle} | {', '.join(f'{value:.0%}' for value in inside)} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10, sys.argv[2:])
