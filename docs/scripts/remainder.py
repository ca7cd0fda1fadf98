"""What the averages of both shafts leave of noiseless records of bench: `python docs/scripts/remainder.py [GEARBOXES]`.

Prints by how much the rms of that remainder differs between two healthy records, and grows with the largest spall. All
noise, sensors' and machine's, is switched off: what is left is the gearbox's own motion.
"""

from __future__ import annotations

import sys

import numpy as np

from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from diagnostics.signal.synchronous_average import asynchronous_part
from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.record.simulation import simulate

QUIET = ["background=null", "dynamics.bearing_tones={level: 0.0}"]
QUIET += [f"sensors.{i}.{part}=null" for i in range(2) for part in ("noise", "pink_noise", "mains")]
STEPS = 1024


def remainders(record: Record, fs_hz: float) -> list[float]:
    """Return the rms of the remainder of every channel [m/s²]."""
    order = int(record.labels["teeth_pinion"]) / int(record.labels["teeth_gear"])  # type: ignore[call-overload]
    grid = angle_grid(record.tacho_s, STEPS)
    turns = (resample_to_angle(signal, fs_hz, grid).reshape(-1, STEPS) for signal in record.channels.values())
    return [float(asynchronous_part(each, order).std()) for each in turns]


def main(gearboxes: int) -> None:
    """Print one row per gearbox."""
    config = load_config("configs/bench.yaml", [*QUIET, f"specimens={gearboxes}"])
    last = len(config.states) - 1
    print(f"| gearbox | healthy [m/s² rms] | measured again | {config.states[last].name} |\n|---|---|---|---|")
    for specimen in range(gearboxes):
        first = specimen * config.records_per_specimen
        rows = np.array([remainders(one, config.fs_hz) for one in simulate(config, [first, first + 1, first + last])])  # type: ignore[arg-type]
        change = [", ".join(f"{value:+.1%}" for value in row / rows[0] - 1.0) for row in rows[1:]]
        print(f"| {specimen} | {', '.join(f'{value:.2f}' for value in rows[0])} | {' | '.join(change)} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 6)
