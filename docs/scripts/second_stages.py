"""Whether a second stage is found where there is one, and none where there is none.

`python docs/scripts/second_stages.py [FOLDER]`; 40 s of CPU time. Printed are 12 machines of `quickstart`, each with
the second stage that it draws and with none, from three healthy records; then the recordings of the machines in FOLDER,
which `hidden_machines.py` made and which have no stage.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from hidden_machine import CHANNELS, FS_HZ, REFERENCES, TEETH

import siggen
from diagnostics.calibration.healthy_blocks import healthy_blocks
from diagnostics.calibration.order_record import OrderRecord, order_record
from diagnostics.calibration.second_stage import SecondStage, machine_multiples, second_stage
from diagnostics.recordings.measured_recording import RecordingFacts

MACHINES = 12
POINT = {"speed_hz": 34.0, "torque_nm": 40.0}
NO_STAGE = {"background": {"second_stage": None}}


def found_in(channels: Mapping[str, Sequence[OrderRecord]]) -> SecondStage | None:
    """Return the stage that the records show."""
    return second_stage(machine_multiples(channels, TEETH), TEETH)


def simulated(seed: int, changes: Mapping[str, Any]) -> tuple[SecondStage | None, Mapping[str, Any]]:
    """Return what three healthy records of a machine show, and the labels of the last."""
    base = {"extends": "quickstart", "seed": seed, "specimens": 1, "repeats": REFERENCES, "operating_points": [POINT]}
    config = siggen.load_config({**base, "states": [{"name": "healthy"}], **changes})
    records: list[Any] = siggen.simulate(config, range(REFERENCES))
    each = {
        name: [
            order_record(np.asarray(one.channels[name], float), FS_HZ, np.asarray(one.tacho_s), TEETH)
            for one in records
        ]
        for name in records[0].channels
    }
    return found_in(each), records[-1].labels


def recorded(folder: Path) -> SecondStage | None:
    """Return what the recordings of a hidden machine show."""
    sources = [(folder / f"run{k}.npz", None) for k in range(REFERENCES)]
    blocks = healthy_blocks(sources, CHANNELS, RecordingFacts(FS_HZ, {}, tacho="tacho"), TEETH, None).blocks
    return found_in(
        {name: [order_record(one.channels[name], FS_HZ, one.pulses_s, TEETH) for one in blocks] for name in CHANNELS}
    )


def told(stage: SecondStage | None) -> str:
    """Return teeth and shaft in words."""
    return "none" if stage is None else f"{stage.teeth} on the {stage.shaft}'s shaft ({stage.score_db:.0f} dB)"


def main() -> None:
    """Print one row per machine."""
    print("| machine | stage: teeth on the gear's shaft | force | found | found without the stage |")
    print("|---|---|---|---|---|")
    for seed in range(MACHINES):
        (with_it, labels), (without, _) = simulated(seed, {}), simulated(seed, NO_STAGE)
        teeth, force_n = labels["second_stage_order"] * TEETH[1] / TEETH[0], labels["second_stage_force_n"]
        print(f"| {seed} | {teeth:.0f} | {force_n:.0f} N | {told(with_it)} | {told(without)} |", flush=True)
    folders = sorted(Path(sys.argv[1]).glob("machine_*/run2.npz")) if len(sys.argv) > 1 else []
    false = [told(stage) for file in folders if (stage := recorded(file.parent)) is not None]
    print(f"{len(folders)} machines without a stage: {len(false)} found {', '.join(false)}")


if __name__ == "__main__":
    main()
