"""Numerical error of a configuration: `python docs/scripts/step_error.py [CONFIG] [GEARBOXES]`.

Simulates the records of the first gearboxes as the file says and with STEPS Runge-Kutta steps per sample, and prints
how much the delivered channels differ (rms of the difference over rms), by state.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

import siggen
from siggen.config import by_reference

STEPS = 32


def difference(coarse: Any, fine: Any) -> float:
    """Return the largest relative rms difference of the channels of one record."""
    pairs = [(coarse.channels[name].astype(float), signal.astype(float)) for name, signal in fine.channels.items()]
    return max(float(np.sqrt(np.mean((a - b) ** 2) / np.mean(b**2))) for a, b in pairs)


def main(path: str, gearboxes: int) -> None:
    """Print the differences by state: those of every gearbox."""
    config = siggen.load_config(path)
    finer = config.model_copy(update={"dynamics": by_reference(config.dynamics, STEPS)})
    ids = range(gearboxes * config.records_per_specimen)
    found: dict[str, list[float]] = {state.name: [] for state in config.states}
    for coarse, fine in zip(siggen.simulate(config, ids), siggen.simulate(finer, ids), strict=True):
        found[str(coarse.labels["state"])].append(difference(coarse, fine))
    print(f"{path}: {config.dynamics.method} against runge_kutta with {STEPS} steps per sample")
    for name, values in found.items():
        print(f"{name}: {', '.join(f'{100.0 * value:.2f} %' for value in values)}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "configs/quickstart.yaml", int(sys.argv[2]) if len(sys.argv) > 2 else 3)
