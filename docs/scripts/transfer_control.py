"""Whether injected physics teaches more than injected energy.

`python docs/scripts/transfer_control.py FOLDER --machines 30`.

FOLDER and its machines are those of `hidden_machines.py`. Into the three healthy recordings of the user the difference
damaged less healthy of gearboxes of the calibrated set is injected: as simulated, with shuffled phases, and as white
noise of the same energy. Damage is that of the test: three spalls, from 0.6 mm over a quarter of the face on. Printed
is the AUC of a detector that was trained on these rows and judged on later recordings of the machine with each spall,
plain / beside its healthy recordings. Nothing transfers until physics beats the others.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from hidden_machine import CHANNELS, FS_HZ, HEALTHY, SMALL, STATES, TEETH, Table, features, own_records
from hidden_machines import detector_auc, interval, user

from diagnostics.calibration.healthy_blocks import Block, healthy_blocks
from diagnostics.calibration.injection import (
    PHYSICS,
    SHUFFLED,
    WHITE,
    Difference,
    control_difference,
    injected,
    simulated_differences,
)
from diagnostics.recordings.measured_recording import RecordingFacts

KINDS = (PHYSICS, SHUFFLED, WHITE)
DAMAGE = [SMALL, *STATES[2:]]
NAMES = [state["name"] for state in DAMAGE]
GEARBOXES = 2


def injected_table(blocks: Sequence[Block], differences: Sequence[list[Difference]], kind: str, seed: int) -> Table:
    """Return the features of all rows; beside them those of the mean of the other healthy recordings."""
    rng = np.random.default_rng(seed)
    healthy = [features(dict(block.channels), block.pulses_s) for block in blocks]
    plain, beside, damaged = [], [], []
    for k, block in enumerate(blocks):
        others = np.mean([row for j, row in enumerate(healthy) if j != k], axis=0)
        rows = [healthy[k]]
        for difference in differences[k]:
            channels = injected(block, control_difference(difference, kind, rng), 0)
            rows.append(features(channels, block.pulses_s))
        plain += rows
        beside += [row - others for row in rows]
        damaged += [False, *(True for _ in rows[1:])]
    return Table(np.array(plain), np.array(beside), np.array(damaged))


def differences_of(folder: Path, mine: Path, blocks: Sequence[Block]) -> list[list[Difference]]:
    """Return the differences of every recording, of other gearboxes for each."""
    control = folder / "control.yaml"
    control.write_text(json.dumps({"extends": mine.name, "name": "control", "states": [STATES[0], *DAMAGE]}))
    return [
        [one for g in range(GEARBOXES) for one in simulated_differences(control, block, k * GEARBOXES + g)]
        for k, block in enumerate(blocks)
    ]


def judged(folder: Path, number: int) -> dict[str, Any]:
    """Return the AUCs of one machine by kind and damage, from its file if it was judged before."""
    file = folder / "control.json"
    if not file.exists():
        own = own_records(folder, number)
        _, mine, _ = user(folder, own.files)
        facts = RecordingFacts(FS_HZ, {}, tacho="tacho")
        blocks = healthy_blocks([(path, None) for path in own.files], CHANNELS, facts, TEETH, None).blocks
        differences = differences_of(folder, mine, blocks)
        parts = {name: own.test.part(np.isin(own.states, (HEALTHY, name))) for name in NAMES}
        found = {}
        for kind in KINDS:
            table = injected_table(blocks, differences, kind, number)
            found[kind] = {name: detector_auc(table, part) for name, part in parts.items()}
        file.write_text(json.dumps(found))
    return dict(json.loads(file.read_text()))


def main() -> None:
    """Print one row per machine and damage, means and differences with 90 % intervals over machines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=30)
    said = parser.parse_args()
    print(f"| machine | damage | {' | '.join(KINDS)} |")
    print("|---|---|---|---|---|")
    rows = []
    for number in range(said.machines):
        one = judged(said.folder / f"machine_{number}", number)
        rows.append([[one[kind][name] for kind in KINDS] for name in NAMES])
        for name, pairs in zip(NAMES, rows[-1], strict=True):
            print(f"| {number} | {name} | " + " | ".join(f"{a:.2f} / {b:.2f}" for a, b in pairs) + " |", flush=True)
    values = np.array(rows)  # machines, damage, kind, plain or beside
    for d, name in enumerate(NAMES):
        shown = (" / ".join(interval(values[:, d, k, j]) for j in (0, 1)) for k in range(len(KINDS)))
        print(f"| mean | {name} | " + " | ".join(shown) + " |")
    for d, name in enumerate(NAMES):
        for k in (1, 2):
            told = " / ".join(interval(values[:, d, 0, j] - values[:, d, k, j]) for j in (0, 1))
            print(f"{name}: {PHYSICS} - {KINDS[k]}: {told}")


if __name__ == "__main__":
    main()
