"""The table of docs/start/check_a_machine.md: `python docs/scripts/speed_machines.py [MACHINES] [--noise N]`.

How often `shaft_pulses` finds the speed of a recording without a tacho. 30 machines of `siggen init`: 17 to 35 teeth,
ratio 1 to 5, module 1 to 6 mm, 12 to 50 Hz, 30 to 100 % of the rated torque, drift of 0, 0.2 or 0.5 % within 3 s, two
of three with a second stage; each healthy and with its severe spall. The speed is asked for in ranges of 3, 25 and
100 % around it, and in one that misses it. An answer is wrong from 0.02 Hz on. `--noise` adds white noise, times the
rms. Some 20 minutes of CPU time.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import siggen
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import shaft_pulses
from siggen.checks.face_accuracy import covering_classes
from siggen.columns.record import Record
from siggen.config import inherited, parse_yaml
from siggen.errors import UsageError
from siggen.rig.rig_answers import rig_of
from siggen.rig.rig_text import rig_text

MODULES_MM = (1.0, 1.5, 2.0, 3.0, 4.0, 6.0)
RATIOS = (1.0, 1.35, 1.6, 2.0, 2.5, 3.0, 3.55, 4.2, 5.0)
STATES = ("healthy", "severe")
WRONG_HZ = 0.02
RANGES = {"3 %": (0.97, 1.03), "25 %": (0.8, 1.25), "100 %": (0.55, 1.7), "beside it": (1.04, 1.35)}


def machine(index: int) -> tuple[dict[str, Any], tuple[int, int]]:
    """Return the configuration of a machine, and its teeth."""
    rng = np.random.default_rng([77, index])
    pinion = int(rng.integers(17, 36))
    teeth = pinion, round(pinion * RATIOS[index % len(RATIOS)])
    speed_hz = round(float(np.exp(rng.uniform(np.log(12.0), np.log(50.0)))), 3)
    module = str(MODULES_MM[index % len(MODULES_MM)])
    rig, _ = rig_of({"teeth": f"{teeth[0]},{teeth[1]}", "module": module, "speed": str(speed_hz)})
    rig = replace(rig, accuracy_classes=covering_classes(rig))
    raw = inherited(parse_yaml(rig_text(rig, "rig", "bench"), "rig"))
    torque_nm, seed = rig.torque_nm[1] * float(rng.uniform(0.3, 1.0)), int(rng.integers(1 << 30))
    drift = float(rng.choice([0.0, 0.002, 0.005]) * rng.choice([-1.0, 1.0]))
    speed = {**raw["variation"]["speed"], "start_ratio": 1.0 - 0.5 * drift, "end_ratio": 1.0 + 0.5 * drift}
    order = int(rng.integers(17, 29)) * teeth[0] / teeth[1]
    stage = {"order": order, "force_share": float(np.exp(rng.uniform(np.log(0.005), np.log(0.1))))}
    changes = {
        "specimens": 1, "repeats": 1, "duration_s": 3.0, "seed": seed,
        "operating_points": [{"speed_hz": speed_hz, "torque_nm": torque_nm}],
        "states": [state for state in raw["states"] if state["name"] in STATES],
        "variation": {**raw["variation"], "speed": speed},
        "background": {**raw["background"], "second_stage": stage if index % 3 else None},
    }  # fmt: skip
    return {**raw, **changes}, teeth


def recordings(index: int, noise: float) -> Iterator[tuple[MeasuredRecording, tuple[int, int], float]]:
    """Yield the recordings of a machine without their tacho, teeth, and the true mean speed [Hz]."""
    raw, teeth = machine(index)
    config, rng = siggen.load_config(raw), np.random.default_rng([78, index])
    for state, record in zip(STATES, siggen.simulate(config, range(2)), strict=True):
        if isinstance(record, Record):
            signals = {name: signal.astype(np.float64) for name, signal in record.channels.items()}
            noisy = {name: s + noise * s.std() * rng.standard_normal(s.size) for name, s in signals.items()}
            pulses = np.asarray(record.tacho_s)
            true_hz = float((pulses.size - 1) / (pulses[-1] - pulses[0]))
            yield MeasuredRecording(Path(f"{index}_{state}"), noisy, config.fs_hz, None), teeth, true_hz


def outcome(recording: MeasuredRecording, teeth: tuple[int, int], limits: tuple[float, float], true_hz: float) -> str:
    """Return `right`, `wrong` or `refused`."""
    try:
        found = shaft_pulses(recording, teeth, (limits[0] * true_hz, limits[1] * true_hz))
    except UsageError:
        return "refused"
    return "right" if abs(found.speed_hz - true_hz) < WRONG_HZ else "wrong"


def main() -> None:
    """Print a row per range."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("machines", nargs="?", type=int, default=30)
    parser.add_argument("--noise", type=float, default=0.0)
    asked = parser.parse_args()
    counts: dict[str, Counter[str]] = {name: Counter() for name in RANGES}
    for index in range(asked.machines):
        print(f"machine {index + 1} of {asked.machines}", file=sys.stderr, flush=True)
        for recording, teeth, true_hz in recordings(index, asked.noise):
            for name, limits in RANGES.items():
                counts[name][outcome(recording, teeth, limits, true_hz)] += 1
    print("| range | right | refused | wrong |\n|---|---:|---:|---:|")
    for name, found in counts.items():
        print(f"| {name} | {found['right']} | {found['refused']} | {found['wrong']} |", flush=True)


if __name__ == "__main__":
    main()
