"""Whether a second stage is found where there is one, and none where there is none.

`python docs/scripts/second_stages.py [FOLDER]`; two minutes of CPU time. Printed are 30 machines of `quickstart`, each
with the second stage that it draws and with none, from three healthy records, and how many 90 % intervals of its lines
hold the mean of three later records; then the recordings of the machines in FOLDER, which `hidden_machines.py` made and
which have no stage.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from hidden_machine import CHANNELS, FS_HZ, REFERENCES, TEETH

import siggen
from diagnostics.calibration.drivetrain import pair
from diagnostics.calibration.healthy_blocks import healthy_blocks
from diagnostics.calibration.order_record import OrderRecord, order_record
from diagnostics.calibration.second_stage import SecondStage, second_stage, stage_lines
from diagnostics.calibration.shaft_multiples import machine_multiples
from diagnostics.recordings.measured_recording import RecordingFacts

MACHINES, LATER = 30, 3
PAIR = pair(TEETH)
POINT = {"speed_hz": 34.0, "torque_nm": 40.0}
NO_STAGE = {"background": {"second_stage": None}}


def records_of(
    seed: int, repeats: int, changes: Mapping[str, Any]
) -> tuple[dict[str, list[OrderRecord]], Mapping[str, Any]]:
    """Return healthy records of a machine by channel, and the labels of the last."""
    base = {"extends": "quickstart", "seed": seed, "specimens": 1, "repeats": repeats, "operating_points": [POINT]}
    config = siggen.load_config({**base, "states": [{"name": "healthy"}], **changes})
    records: list[Any] = siggen.simulate(config, range(repeats))
    spectra = [
        {name: order_record(x.astype(float), FS_HZ, np.asarray(one.tacho_s), PAIR) for name, x in one.channels.items()}
        for one in records
    ]
    return {name: [one[name] for one in spectra] for name in spectra[0]}, records[-1].labels


def held(stage: SecondStage, channels: Mapping[str, Sequence[OrderRecord]]) -> list[bool]:
    """Return whether each interval from the first records holds the mean of the later ones."""
    parts = [
        {name: own[part] for name, own in channels.items()} for part in (slice(REFERENCES), slice(REFERENCES, None))
    ]
    first, later = (machine_multiples(part, PAIR)[stage.shaft] for part in parts)
    found = []
    for name in channels:
        truth = {one.name: one.level_db.value for one in stage_lines(stage, later[name])}
        for one in stage_lines(stage, first[name]):
            if one.name in truth:
                found.append(one.level_db.low <= truth[one.name] <= one.level_db.high)
    return found


def recorded(folder: Path) -> SecondStage | None:
    """Return what the recordings of a hidden machine show."""
    sources = [(folder / f"run{k}.npz", None) for k in range(REFERENCES)]
    blocks = healthy_blocks(sources, CHANNELS, RecordingFacts(FS_HZ, {}, tacho="tacho"), TEETH, None).blocks
    each = {name: [order_record(one.channels[name], FS_HZ, one.pulses_s, PAIR) for one in blocks] for name in CHANNELS}
    return second_stage(machine_multiples(each, PAIR), PAIR)


def told(stage: SecondStage | None) -> str:
    """Return teeth and shaft in words."""
    return "none" if stage is None else f"{stage.teeth} on the {stage.shaft}'s shaft (e^{stage.score:.0f})"


def main() -> None:
    """Print one row per machine."""
    print(
        "| machine | stage: teeth on the gear's shaft | force | found | found without the stage | intervals that hold |"
    )
    print("|---|---|---|---|---|---|")
    every: list[bool] = []
    right, wrong, invented = 0, 0, 0
    for seed in range(MACHINES):
        channels, labels = records_of(seed, REFERENCES + LATER, {})
        first = {name: own[:REFERENCES] for name, own in channels.items()}
        plain = records_of(seed, REFERENCES, NO_STAGE)[0]
        stage, without = (second_stage(machine_multiples(one, PAIR), PAIR) for one in (first, plain))
        inside = held(stage, channels) if stage else []
        every += inside
        teeth, force_n = labels["second_stage_order"] * TEETH[1] / TEETH[0], labels["second_stage_force_n"]
        found = f"{told(stage)} | {told(without)} | {sum(inside)} of {len(inside)}"
        print(f"| {seed} | {teeth:.0f} | {force_n:.0f} N | {found} |", flush=True)
        same = stage is not None and (stage.shaft, stage.teeth) == ("gear", round(teeth))
        right, wrong = right + same, wrong + (stage is not None and not same)
        invented += without is not None
    print(f"{MACHINES} machines: {right} right, {wrong} wrong, {invented} invented where there is none")
    print(f"{len(every)} intervals, {100 * np.mean(every):.0f} % hold")
    folders = sorted(Path(sys.argv[1]).glob("machine_*/run2.npz")) if len(sys.argv) > 1 else []
    false = [told(stage) for file in folders if (stage := recorded(file.parent)) is not None]
    print(f"{len(folders)} machines without a stage: {len(false)} found {', '.join(false)}")


if __name__ == "__main__":
    main()
