"""Whether simulated damage teaches a detector more than added energy, and more than healthy recordings alone.

`python docs/scripts/does_it_help.py FOLDER --machines 30`; 30 s of CPU time for each; what is in FOLDER is not made
again. A machine is that of `outside_machine.py`, which siggen did not simulate. Its user has five healthy recordings of
a second, fits a configuration to them (`calibrate`), and injects into each the difference damaged less healthy of one
gearbox of that configuration, for two spalls. Judged are 6 later healthy recordings and 4 with each of the spalls.
Printed is the AUC of

* physics: a logistic regression trained on the recordings as they are and with the difference injected, on logarithms
  of all indicators less the mean of the other healthy recordings,
* shuffled: the same, every line of the difference with a random phase,
* distance: the score of `check` against the five recordings, which knows no damage,

and what `check` says with five references. Simulated damage helps where physics beats both.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from hidden_machine import FS_HZ, STATES, TEETH, features, write_recording
from hidden_machines import PENALTY, interval, user
from outside_machine import SIZES, Housing, Machine

from diagnostics.calibration.healthy_blocks import Block, healthy_blocks
from diagnostics.calibration.injection import (
    PHYSICS,
    SHUFFLED,
    Difference,
    control_difference,
    injected,
    simulated_differences,
)
from diagnostics.recordings.measured_recording import RecordingFacts
from diagnostics.statistics.change_score import change_score

REFERENCES, HEALTHY, DAMAGED, LIBRARY = 5, 6, 4, 6
KINDS = (PHYSICS, SHUFFLED)
DISTANCE = "distance"
SPALL = STATES[2]["damage"]
DAMAGE = [
    {"name": name, "severity": "slight", "damage": {**SPALL, "profile_length_mm": mm, "face_share": share}}
    for name, (mm, share) in SIZES.items()
]


def recorded(folder: Path, number: int) -> tuple[list[Path], dict[str, np.ndarray]]:
    """Return the files of the references, and features of them and of all later records by state."""
    files, kept = [folder / f"run{k}.npz" for k in range(REFERENCES)], folder / "later.npz"
    if not kept.exists():
        folder.mkdir(parents=True, exist_ok=True)
        machine = Machine(number)
        for k, file in enumerate(files):
            write_recording(machine.recording(None, k), file)
        counts = {None: range(REFERENCES + HEALTHY), **dict.fromkeys(SIZES, range(100, 100 + DAMAGED))}
        found = {}
        for size, numbers in counts.items():
            records = [machine.recording(size, k) for k in numbers]
            found[size or "healthy"] = np.array([features(one.channels, one.tacho_s) for one in records])
        np.savez(kept, **found)
    return files, dict(np.load(kept))


def differences_of(mine: Path, blocks: Sequence[Block]) -> list[list[Difference]]:
    """Return the differences of every recording, of another gearbox for each."""
    control = mine.with_name("control.yaml")
    control.write_text(json.dumps({"extends": mine.name, "name": "control", "states": [STATES[0], *DAMAGE]}))
    return [list(simulated_differences(control, block, k)) for k, block in enumerate(blocks)]


def trained_scores(
    blocks: Sequence[Block], differences: Sequence[list[Difference]], kind: str, later: np.ndarray, seed: int
) -> np.ndarray:
    """Return the scores of later records by a detector trained on the recordings with differences of a kind."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.preprocessing import StandardScaler

    rng = np.random.default_rng(seed)
    healthy = np.array([features(dict(block.channels), block.pulses_s) for block in blocks])
    rows, damaged = [], []
    for k, block in enumerate(blocks):
        others = np.delete(healthy, k, axis=0).mean(axis=0)
        changed = [injected(block, control_difference(one, kind, rng), 0) for one in differences[k]]
        rows += [healthy[k] - others, *(features(one, block.pulses_s) - others for one in changed)]
        damaged += [False, *(True for _ in changed)]
    table, judged = np.array(rows), later - healthy.mean(axis=0)
    known = np.isfinite(table).all(axis=0) & np.isfinite(judged).all(axis=0)
    scaler = StandardScaler().fit(table[:, known])
    model = LogisticRegression(C=PENALTY, max_iter=3000).fit(scaler.transform(table[:, known]), damaged)
    return np.asarray(model.decision_function(scaler.transform(judged[:, known])))


def judged(folder: Path, number: int) -> dict[str, Any]:
    """Return AUC by spall and detector, and shares called changed by state, from a file if judged before."""
    file = folder / "helps.json"
    if not file.exists():
        files, held = recorded(folder, number)
        try:
            _, mine, _ = user(folder, files, LIBRARY)
        except SystemExit as error:
            return {"refused": str(error)}
        facts = RecordingFacts(FS_HZ, {}, tacho="tacho")
        blocks = healthy_blocks([(path, None) for path in files], Housing.CHANNELS, facts, TEETH, None).blocks
        differences = differences_of(mine, blocks)
        later = {name: rows[REFERENCES:] if name == "healthy" else rows for name, rows in held.items()}
        every = np.concatenate(list(later.values()))
        state = np.repeat(list(later), [len(rows) for rows in later.values()])
        scores = {kind: trained_scores(blocks, differences, kind, every, number) for kind in KINDS}
        verdicts = [change_score(held["healthy"][:REFERENCES], row) for row in every]
        scores[DISTANCE] = np.array([one.score for one in verdicts])
        changed = np.array([one.changed for one in verdicts])
        found = {name: {kind: auc(one, state, name) for kind, one in scores.items()} for name in SIZES}
        said = {name: float(changed[state == name].mean()) for name in later}
        file.write_text(json.dumps({"auc": found, "changed": said}))
    return dict(json.loads(file.read_text()))


def auc(scores: np.ndarray, state: np.ndarray, damaged: str) -> float:
    """Return how often a damaged record scores above a healthy one."""
    above = scores[state == damaged][:, None] - scores[state == "healthy"]
    return float(np.mean(0.5 + 0.5 * np.sign(above)))


def main() -> None:
    """Print one row per spall: means and differences with 90 % intervals over machines."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=30)
    said = parser.parse_args()
    every = [judged(said.folder / f"outside_{number}", number) for number in range(said.machines)]
    found = [one for one in every if "auc" in one]
    columns = (*KINDS, DISTANCE)
    print(f"{len(found)} machines; {len(every) - len(found)} refused by `calibrate`")
    print(f"| spall | {' | '.join(columns)} | physics - shuffled | physics - distance | called changed |")
    print("|---" * (len(columns) + 4) + "|")
    for name in SIZES:
        value = {kind: np.array([one["auc"][name][kind] for one in found]) for kind in columns}
        means = " | ".join(interval(value[kind]) for kind in columns)
        less = " | ".join(interval(value[PHYSICS] - value[kind]) for kind in columns[1:])
        told = interval(np.array([100.0 * one["changed"][name] for one in found]))
        print(f"| {name} | {means} | {less} | {told} % |")
    print(f"healthy called changed: {interval(np.array([100.0 * one['changed']['healthy'] for one in found]))} %")


if __name__ == "__main__":
    main()
