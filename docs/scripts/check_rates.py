"""False alarms and hits of `check` by number of references: `python docs/scripts/check_rates.py FOLDER`.

One simulated machine at one speed and load, measured 26 times in each of three states: healthy, an irregular spall of
1 mm over 40 % of the face, and one through it. FOLDER is where the set is made, or was made before. References are
drawn from the healthy recordings; all others are judged against each draw.
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
from diagnostics.records.gear_train import Mesh
from diagnostics.statistics.change_score import change_score
from diagnostics.training.referenced import log_values

REPEATS, DRAWS = 26, 80
SPALL = {"kind": "irregular", "gear": "pinion", "teeth": 1, "profile_length_mm": 1.0}
MACHINE = {
    "extends": "quickstart",
    "name": "one_machine",
    "specimens": 1,
    "repeats": REPEATS,
    "operating_points": [{"speed_hz": 35.0, "torque_nm": 40.0}],
    "states": [
        {"name": "healthy"},
        {"name": "face_40", "severity": "slight", "damage": {**SPALL, "face_share": 0.4}},
        {"name": "through", "severity": "severe", "damage": {**SPALL, "face_share": 1.0}},
    ],
}


def features(folder: Path) -> np.ndarray:
    """Return the logarithms of the indicators of all recordings (3 REPEATS, features), state by state."""
    siggen.generate(siggen.load_config(MACHINE), folder)
    file = next((folder / "data").glob("*.parquet"))
    facts = RecordingFacts(fs_hz=25_600.0, tacho="tacho_s")
    channels = ("lid_vertical", "side_horizontal")
    sources = [(file, row) for row in range(3)]
    with silent_stage("references", 3) as advance:
        machine = healthy_state(sources, channels, facts, (Mesh("", (18, 47)),), None, (), 0.05, advance)
    return np.array([_row(machine, file, row) for row in range(3 * REPEATS)])


def _row(machine: Machine, file: Path, row: int) -> np.ndarray:
    recording = read_recording(file, machine.channels, replace(machine.facts, row=row))
    pieces, _ = pieces_of(recording, machine.fs_hz, machine.train, None, machine.duration_s)
    return np.asarray(log_values(pieces.medians(machine.names)[None])[0])


def rates(values: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return the share called changed in every state (DRAWS, states), each draw of references by itself."""
    healthy, *damaged = np.split(values, 3)
    found = []
    for _ in range(DRAWS):
        order = rng.permutation(REPEATS)
        references, others = healthy[order[:count]], healthy[order[count:]]
        judged = (others, *damaged)
        found.append([np.mean([change_score(references, row).changed for row in rows]) for rows in judged])
    return np.array(found)


def main() -> None:
    """Print the table."""
    values = features(Path(sys.argv[1]))
    rng = np.random.default_rng(0)
    print("| references | promised | false alarms, mean | worst twentieth of draws | 40 % of the face | through |")
    print("|---|---|---|---|---|---|")
    for count in (3, 5, 10, 20):
        found = rates(values, count, rng)
        promised, worst = max(0.05, 1.0 / (count + 1)), np.quantile(found[:, 0], 0.95)
        shown = (count, f"{promised:.0%}", f"{found[:, 0].mean():.1%}", f"{worst:.0%}")
        print("| " + " | ".join(map(str, (*shown, *(f"{share:.0%}" for share in found[:, 1:].mean(axis=0))))) + " |")


if __name__ == "__main__":
    main()
