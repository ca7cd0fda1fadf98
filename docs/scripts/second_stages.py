"""Whether a second stage is found where there is one, and none where there is none.

`python docs/scripts/second_stages.py SET ...`; seconds of CPU time for each gearbox. A set is a finished one of a spur
pair, such as those of `siggen generate confusers` and `linear_pits`: the first has a stage in every gearbox, the second
none. Taken are the healthy recordings of every gearbox, sham damage included.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

import siggen
from diagnostics.calibration.drivetrain import Drivetrain
from diagnostics.calibration.order_record import OrderRecord, order_record
from diagnostics.calibration.rig import read_rig
from diagnostics.calibration.second_stage import SecondStage, second_stage
from diagnostics.calibration.shaft_multiples import machine_multiples

ORDER, FORCE = "second_stage_order", "second_stage_force_n"


def judged(folder: Path, drive: Drivetrain) -> dict[int, tuple[SecondStage | None, float, float]]:
    """Return by gearbox what is found, teeth of its stage on the second shaft, 0 without one, and its force [N]."""
    dataset = siggen.open(folder)
    channels = {channel.name: channel.column for channel in dataset.channels}
    spectra: dict[int, dict[str, list[OrderRecord]]] = defaultdict(lambda: defaultdict(list))
    truth: dict[int, tuple[float, float]] = {}
    for batch in dataset.records():
        for row in range(batch.num_rows):
            own = {name: batch.column(name)[row] for name in batch.schema.names}
            if own["fault"].as_py() != "healthy":
                continue
            gearbox, pulses = own["specimen_id"].as_py(), np.asarray(own["tacho_s"].values, dtype=np.float64)
            for name, column in channels.items():
                signal = np.asarray(own[column].values, dtype=np.float64)
                spectra[gearbox][name].append(order_record(signal, dataset.fs_hz, pulses, drive))
            order, force_n = (own[name].as_py() if name in own else 0.0 for name in (ORDER, FORCE))
            truth[gearbox] = order / drive.gear_order, force_n
    return {one: (second_stage(machine_multiples(each, drive), drive), *truth[one]) for one, each in spectra.items()}


def main() -> None:
    """Print one row per gearbox that has a stage or shows one, and the counts of every set."""
    for folder in map(Path, sys.argv[1:]):
        drive = read_rig(folder / "config.yaml").drive
        found = judged(folder, drive)
        print(f"| {folder.name} | stage: teeth | force [N] | found |\n|---|---|---|---|")
        right, wrong = 0, 0
        for gearbox, (stage, teeth, force_n) in sorted(found.items()):
            same = stage is not None and (stage.shaft, stage.teeth) == (drive.shafts[1].name, round(teeth))
            right, wrong = right + same, wrong + (stage is not None and not same)
            if stage is not None or teeth:
                told = "none" if stage is None else f"{stage.teeth} on {stage.shaft} (e^{stage.score:.0f})"
                print(f"| {gearbox} | {teeth:.0f} | {force_n:.0f} | {told} |", flush=True)
        print(f"{len(found)} gearboxes: {right} right, {wrong} wrong or invented\n")


if __name__ == "__main__":
    main()
