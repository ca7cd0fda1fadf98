"""Whether injected physics teaches more than injected energy.

`python docs/scripts/transfer_control.py FOLDER --machines 30`.

FOLDER and its machines are those of `hidden_machines.py`. Into the three healthy recordings of the user the difference
damaged less healthy of gearboxes of the calibrated set is injected: as simulated, with shuffled phases, and as white
noise of the same energy. Printed is the AUC of a detector that was trained on these rows and judged on later
recordings of the machine, plain / beside its healthy recordings. Nothing transfers until the first column beats the
others.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from hidden_machines import Table, detector_auc, features, interval, own_records, test_table, user, write_csv

from diagnostics.calibration.calibration import rig_teeth
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
GEARBOXES = 2
CHANNELS = ("sensor_1_vertical", "sensor_2_horizontal")


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


def judged(folder: Path, number: int) -> dict[str, Any]:
    """Return the AUCs of one machine by kind, from its file if it was judged before."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "control.json"
    if not file.exists():
        references, test_records, _ = own_records(folder, number, with_others=False)
        files = [write_csv(record, folder / f"run{k}.npz") for k, record in enumerate(references)]
        rig, mine, _ = user(folder, files)
        facts = RecordingFacts(25_600.0, {}, tacho="tacho")
        blocks = healthy_blocks([(path, None) for path in files], CHANNELS, facts, rig_teeth(rig)[1], None).blocks
        differences = [
            [one for g in range(GEARBOXES) for one in simulated_differences(mine, block, k * GEARBOXES + g)]
            for k, block in enumerate(blocks)
        ]
        test = test_table(test_records, references)
        found = {kind: detector_auc(injected_table(blocks, differences, kind, number), test) for kind in KINDS}
        file.write_text(json.dumps(found))
    return dict(json.loads(file.read_text()))


def main() -> None:
    """Print one row per machine, means and differences with 90 % intervals over machines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--machines", type=int, default=30)
    said = parser.parse_args()
    print(f"| machine | {' | '.join(KINDS)} |")
    print("|---|---|---|---|")
    rows = []
    for number in range(said.machines):
        one = judged(said.folder / f"machine_{number}", number)
        rows.append([one[kind] for kind in KINDS])
        print(f"| {number} | " + " | ".join(f"{a:.2f} / {b:.2f}" for a, b in rows[-1]) + " |", flush=True)
    values = np.array(rows)
    print("| mean | " + " | ".join(" / ".join(interval(values[:, k, j]) for j in (0, 1)) for k in range(3)) + " |")
    for k in (1, 2):
        told = " / ".join(interval(values[:, 0, j] - values[:, k, j]) for j in (0, 1))
        print(f"{PHYSICS} - {KINDS[k]}: {told}")


if __name__ == "__main__":
    main()
