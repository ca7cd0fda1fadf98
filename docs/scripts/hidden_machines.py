"""Machines of a family of their own, and what `calibrate` gains on them.

`python docs/scripts/hidden_machines.py FOLDER --machines 30`; about one minute of CPU time for each; what is in
FOLDER is not made again. A machine is that of `hidden_machine.py`. Printed are CPU times, AUCs of a detector (logistic
regression on logarithms of the indicators) that was trained on 8 gearboxes of the machine itself, of the uncalibrated
rig and of the calibrated set, and how often 90 % intervals hold
the mean of 18 later recordings. The rig is that of the drawing, which is the same for all machines: each machine draws
8 of the same 24 gearboxes of it.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from hidden_machine import GEARBOXES, SMALL, STATES, Table, machine, own_records, simulated, training_table
from typer.testing import CliRunner

import siggen
from diagnostics.cli.app import app as diagnostics_app
from siggen.cli.app import app as siggen_app

RIG_POOL, LIBRARY = 24, 16
PENALTY = 0.03
INTERVAL = 0.9
SETS = ("true", "rig", "calibrated")


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


def user(folder: Path, files: Sequence[Path], library: int = LIBRARY) -> tuple[Path, Path, float]:
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
            str(library),
            "--compared",
            "0",
            "--out",
            str(mine),
        ]
        result = CliRunner().invoke(diagnostics_app, ["calibrate", str(rig), *map(str, files), *options])
        if result.exit_code:
            raise SystemExit(f"{folder}: {result.output} {result.exception}")
    return rig, mine, time.process_time() - start


@cache
def rig_pool(rig_text: str, folder: Path) -> tuple[Table, np.ndarray]:
    """Return features of the uncalibrated rig, the same for all machines of one drawing, and their gearboxes."""
    file = folder / "rig_pool.npz"
    if not file.exists():
        source = folder / "rig_pool.yaml"
        source.write_text(rig_text, encoding="utf-8")
        table, gearboxes = training_table(simulated(_as_judged(source, RIG_POOL), range(RIG_POOL)))
        np.savez(file, plain=table.plain, beside=table.beside, damaged=table.damaged, gearboxes=gearboxes)
    held = np.load(file)
    return Table(held["plain"], held["beside"], held["damaged"]), held["gearboxes"]


def rig_table(rig: Path, folder: Path, number: int) -> Table:
    """Return the uncalibrated training set of a machine: GEARBOXES of the pool."""
    pool, gearboxes = rig_pool(rig.read_text(encoding="utf-8"), folder)
    chosen = np.random.default_rng([2027, number]).choice(np.unique(gearboxes), GEARBOXES, replace=False)
    return pool.part(np.isin(gearboxes, chosen))


def _as_judged(source: Path, gearboxes: int) -> Any:
    return siggen.load_config(source, [f"states={json.dumps(STATES)}", f"specimens={gearboxes}"])


def coverage(mine: Path, truth: Sequence[dict[str, float]]) -> dict[str, list[bool]]:
    """Return whether each 90 % interval holds the mean level of the gearbox's later healthy records."""
    facts = json.loads((mine.parent / "mine_data" / "calibration.json").read_text())
    held: dict[str, list[bool]] = {"lines": [], "noise": []}
    for fitted, levels in zip(facts["channels"].values(), truth, strict=True):
        for name, (_, low, high) in {**fitted["line_level_db"], "noise": fitted["noise_level_db"]}.items():
            if name in levels:
                held["noise" if name == "noise" else "lines"].append(bool(low <= levels[name] <= high))
    return held


def judged(folder: Path, number: int) -> dict[str, Any]:
    """Return AUCs, coverage and CPU times of one machine, from its file if it was judged before."""
    file = folder / "judged.json"
    if not file.exists():
        start = time.process_time()
        own = own_records(folder, number)
        rig, mine, seconds = user(folder, own.files)
        raw = machine(number, folder)
        others = simulated(siggen.load_config({**raw, "states": STATES}), range(1, 1 + GEARBOXES))
        drawn = simulated(_as_judged(mine, GEARBOXES), range(GEARBOXES))
        sets = {
            "true": training_table(others)[0],
            "rig": rig_table(rig, folder.parent, number),
            "calibrated": training_table(drawn)[0],
        }
        test = own.test.part(own.states != SMALL["name"])
        found = {name: detector_auc(one, test) for name, one in sets.items()}
        spent = {"cpu_s": seconds, "all_cpu_s": time.process_time() - start}
        file.write_text(json.dumps({**found, "coverage": coverage(mine, own.truth), **spent}))
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
        held = float(np.mean([*one["coverage"]["lines"], *one["coverage"]["noise"]]))
        rows.append([*(value for name in SETS for value in one[name]), held, one["cpu_s"]])
        shown = " | ".join(f"{one[name][0]:.2f} / {one[name][1]:.2f}" for name in SETS)
        print(f"| {number} | {shown} | {held:.2f} | {one['cpu_s']:.0f} |", flush=True)
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
