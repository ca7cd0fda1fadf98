"""False alarms and hits of `check` by number of references: `python docs/scripts/check_rates.py FOLDER`.

One simulated machine, measured 26 times healthy and 26 times with a spall of 1 mm through the face, at one speed and
load; FOLDER is where the set is made, or was made before. References are drawn from the healthy recordings.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import siggen
from diagnostics.base.progress import silent_stage
from diagnostics.machine.healthy_state import healthy_state, pieces_of
from diagnostics.machine.machine import Machine
from diagnostics.recordings.measured_recording import RecordingFacts, read_recording
from diagnostics.statistics.change_score import change_score
from diagnostics.training.log_features import log_values

REPEATS, DRAWS = 26, 400
SPALL = {
    "kind": "spall",
    "gear": "pinion",
    "teeth": 1,
    "shape": "rectangle",
    "face_length_mm": 20.0,
    "profile_length_mm": 1.0,
    "depth_mm": 0.2,
}
MACHINE = {
    "extends": "quickstart",
    "name": "one_machine",
    "specimens": 1,
    "repeats": REPEATS,
    "operating_points": [{"speed_hz": 35.0, "torque_nm": 40.0}],
    "states": [{"name": "healthy"}, {"name": "spalled", "severity": "severe", "damage": SPALL}],
}


def features(folder: Path) -> np.ndarray:
    """Return the logarithms of the indicators of all recordings (2 REPEATS, features), healthy ones first."""
    siggen.generate(siggen.load_config(MACHINE), folder)
    file = next((folder / "data").glob("*.parquet"))
    facts = RecordingFacts(fs_hz=25_600.0, tacho="tacho_s")
    channels = ("lid_vertical", "side_horizontal")
    sources = [(file, row) for row in range(3)]
    with silent_stage("references", 3) as advance:
        machine = healthy_state(sources, channels, facts, (18, 47), None, (), 0.05, advance)
    return np.array([_row(machine, file, row) for row in range(2 * REPEATS)])


def _row(machine: Machine, file: Path, row: int) -> np.ndarray:
    recording = read_recording(file, machine.channels, replace(machine.facts, row=row))
    pieces, _ = pieces_of(recording, machine.fs_hz, machine.teeth, None, machine.duration_s)
    return np.asarray(log_values(pieces.medians(machine.names)[None])[0])


def main() -> None:
    """Print the table."""
    values = features(Path(sys.argv[1]))
    healthy, spalled = values[:REPEATS], values[REPEATS:]
    rng = np.random.default_rng(0)
    print("| references | promised | false alarms | spall found |\n|---|---|---|---|")
    for count in (3, 5, 10, 20):
        alarms, hits = [], []
        for _ in range(DRAWS):
            chosen = rng.permutation(REPEATS)[: count + 1]
            references = healthy[chosen[:-1]]
            alarms.append(change_score(references, healthy[chosen[-1]]).changed)
            hits.append(change_score(references, spalled[rng.integers(REPEATS)]).changed)
        promised = max(0.05, 1.0 / (count + 1))
        print(f"| {count} | {100 * promised:.0f} % | {100 * np.mean(alarms):.1f} % | {100 * np.mean(hits):.0f} % |")


if __name__ == "__main__":
    main()
