"""False alarms and hits of `check` on many machines: `python docs/scripts/check_hidden_machines.py FOLDER`.

FOLDER is that of `hidden_machines.py`, whose users have 21 healthy recordings of one gearbox at one range of speed and
load, and six with each of three spalls. References are drawn from the healthy ones; all others are judged against each
draw, by the rule of `check` on the logarithms of all indicators. Printed are means over machines with 90 % intervals.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from hidden_machine import HEALTHY, SMALL, STATES
from hidden_machines import interval

from diagnostics.statistics.change_score import change_score

DRAWS = 20
COUNTS = (3, 5, 10, 20)
NAMES = [SMALL["name"], *(state["name"] for state in STATES[2:])]


def rates(rows: np.ndarray, states: np.ndarray, count: int, rng: np.random.Generator) -> np.ndarray:
    """Return the share called changed among other healthy recordings and with each damage, (1 + len(NAMES),)."""
    rows = rows[:, np.isfinite(rows).all(axis=0)]
    healthy, damaged = rows[states == HEALTHY], [rows[states == name] for name in NAMES]
    found = []
    for draw in range(len(healthy) if count == len(healthy) - 1 else DRAWS):
        # with all but one, each is left out once
        order = np.roll(np.arange(len(healthy)), draw) if count == len(healthy) - 1 else rng.permutation(len(healthy))
        references, others = healthy[order[:count]], healthy[order[count:]]
        found.append([np.mean([change_score(references, row).changed for row in each]) for each in (others, *damaged)])
    return np.mean(found, axis=0)


def main() -> None:
    """Print the table."""
    kept = [np.load(file) for file in sorted(Path(sys.argv[1]).glob("machine_*/own.npz"))]
    print(f"{len(kept)} machines")
    print("| references | promised | false alarms | " + " | ".join(NAMES) + " |")
    print("|" + "---|" * (3 + len(NAMES)))
    for count in COUNTS:
        rng = np.random.default_rng(0)
        found = np.array([rates(one["rows"], one["states"], count, rng) for one in kept])
        shown = " | ".join(interval(100.0 * column) for column in found.T)
        print(f"| {count} | {max(5.0, 100.0 / (count + 1)):.0f} % | {shown} |", flush=True)


if __name__ == "__main__":
    main()
