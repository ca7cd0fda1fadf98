"""Machines before and after `calibrate`, as its page judges them: the table of docs/understand/calibration.md.

`python docs/scripts/calibrated_machine.py FOLDER`, a new folder; two minutes of CPU time. A machine is one gearbox of
`quickstart`. Three recordings are fitted, three others judge.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from hidden_machine import CHANNELS, FS_HZ, TEETH, write_recording

import siggen
from diagnostics.calibration.calibrated_files import write_calibration
from diagnostics.calibration.calibration import calibrated
from diagnostics.calibration.healthy_blocks import HealthyBlocks, healthy_blocks
from diagnostics.calibration.likeness import Likeness, likeness, sample_of, simulated_blocks
from diagnostics.calibration.rig import read_rig
from diagnostics.calibration.source_library import at_recordings
from diagnostics.recordings.taken import RecordingFacts
from siggen.rig.rig import Rig
from siggen.rig.rig_text import rig_text

FITTED, JUDGED, GEARBOXES, PATHS = 3, 3, 8, 24
SEEDS = (4242, 1, 2)


def recordings(folder: Path, seed: int) -> HealthyBlocks:
    """Return the recordings of the machine, from files with a tacho."""
    folder.mkdir(parents=True)
    point = {"speed_hz": 34.0, "torque_nm": 40.0}
    base = {
        "extends": "quickstart",
        "seed": seed,
        "specimens": 1,
        "repeats": FITTED + JUDGED,
        "operating_points": [point],
    }
    gearbox = siggen.draw(siggen.load_config({**base, "states": {"others": None, "healthy": {}}}))
    records = siggen.runs(gearbox, gearbox.cases)
    files = [write_recording(one, folder / f"run{k}.npz") for k, one in enumerate(records)]
    return healthy_blocks(
        [(file, None) for file in files],
        CHANNELS,
        RecordingFacts(FS_HZ, {}, unit="m/s2", tacho="tacho", tacho_pulses=1),
        TEETH,
        None,
    )


def before_and_after(folder: Path, seed: int) -> tuple[Likeness, Likeness]:
    """Return how gearboxes of the rig and of the calibrated configuration lie against the recordings that judge."""
    blocks = recordings(folder, seed)
    rig, mine = folder / "rig.yaml", folder / "mine.yaml"
    rig.write_text(rig_text(Rig(TEETH, 3.0, 20.0, (33.0, 36.0), (20.0, 50.0)), "rig"), encoding="utf-8")
    fitted = HealthyBlocks(blocks.blocks[:FITTED], blocks.channels, blocks.fs_hz)
    found = calibrated(read_rig(rig), fitted, None, GEARBOXES, PATHS, 0, lambda: None)
    write_calibration(found, mine)
    real = sample_of(blocks.blocks[FITTED:], TEETH)
    sources = (at_recordings(found.rig, found.operating_point, FS_HZ), mine)
    each = [simulated_blocks(source, CHANNELS, GEARBOXES, lambda: None) for source in sources]
    before, after = (likeness(real, sample_of(one, TEETH), 0) for one in each)
    return before, after


def main() -> None:
    """Print one row per machine."""
    print("| machine | spectrum [dB] | features above 0.9, of 64 | values inside 95 % |")
    print("|---|---|---|---|")
    for seed in SEEDS:
        pairs = before_and_after(Path(sys.argv[1]) / f"machine_{seed}", seed)
        spectrum = " to ".join(" / ".join(f"{value:.1f}" for value in one.distance_db) for one in pairs)
        telling = " to ".join(str(one.features.telling) for one in pairs if one.features)
        inside = " to ".join(f"{100 * float(np.mean(one.features.inside)):.0f} %" for one in pairs if one.features)
        print(f"| {seed} | {spectrum} | {telling} | {inside} |", flush=True)


if __name__ == "__main__":
    main()
