"""How healthy recordings have to lie over a recording: `python docs/scripts/laid_over.py runs/quickstart`.

Each record is asked beside the healthy one of its gearbox, as `siggen-diagnostics predict --reference` asks. Prints the
answers by state; then those of the sham, which is sound, with a mark of the tacho, a sign or a gain that the healthy
record has not, and beside that of another gearbox.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np

import siggen
from diagnostics.prediction.gearbox_answer import DAMAGE, NOTHING, UNTOLD, gearbox_answer
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.records.recording import one_recording
from diagnostics.records.state_classes import HEALTHY, SHAM
from siggen.dataset.reading import Dataset

CHANGED = {
    "sham, tacho 78 µs late": {"late_s": 78e-6},
    "sham, mark 0.001 turns late": {"late_turns": 1e-3},
    "sham, other sign": {"gain": -1.0},
    "sham, gain 1.26": {"gain": 1.26},
    "sham, gain 1.5": {"gain": 1.5},
}


def recording(
    dataset: Dataset, number: int, *, late_s: float = 0.0, late_turns: float = 0.0, gain: float = 1.0
) -> MeasuredRecording:
    """Return a record as a recording, changed."""
    record = one_recording(dataset, number)
    late_s += late_turns * float(np.median(np.diff(record.tacho_s)))
    channels = {name: gain * signal.astype(np.float64) for name, signal in record.channels.items()}
    return MeasuredRecording(Path(f"{number}"), channels, record.fs_hz, record.tacho_s + late_s)


def main() -> None:
    """Print the table."""
    dataset = siggen.open(sys.argv[1])
    rows = dataset.labels(columns=["record_id", "specimen_id", "state"]).to_pylist()
    place = {(row["specimen_id"], row["state"]): row["record_id"] for row in rows}
    owners = sorted({owner for owner, _ in place})
    teeth = one_recording(dataset, rows[0]["record_id"]).teeth

    def line(title: str, state: str, step: int = 0, **change: float) -> None:
        others = owners[step:] + owners[:step]
        said = Counter(
            gearbox_answer(
                recording(dataset, place[owner, state], **change), teeth,
                references=[recording(dataset, place[other, HEALTHY])],
            ).verdict
            for owner, other in zip(owners, others, strict=True)
        )  # fmt: skip
        print(f"| {title} | {said[DAMAGE]} | {said[NOTHING]} | {said[UNTOLD]} |", flush=True)

    print(f"| of {len(owners)} gearboxes | {DAMAGE} | {NOTHING} | {UNTOLD} |\n|---|---|---|---|")
    for state in dict.fromkeys(state for _, state in place if state != HEALTHY):
        line(state, state)
    for title, change in CHANGED.items():
        line(title, SHAM, **change)
    line("sham, beside another gearbox", SHAM, step=1)


if __name__ == "__main__":
    main()
