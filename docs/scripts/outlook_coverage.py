"""How often the true remaining life lies in the 80 % interval of `life/outlook`: docs/understand/run_to_failure.md.

`python docs/scripts/outlook_coverage.py [UNITS] [CONFIG]`; 500 gearboxes of `fleet` by default, of which no record is
made. Truth is the functional end of every gearbox, of those too that are taken out before it: who leaves out these
keeps the short lives. Limits (95 %) are over gearboxes, since inspections of one share their fate.
"""

from __future__ import annotations

import sys

import numpy as np

import siggen
from siggen.planning.lived import PHASES
from siggen.record.life_rows import life_rows

Z_95 = 1.96


def shown(name: str, owner: np.ndarray, early: np.ndarray, late: np.ndarray) -> None:
    """Print the share of inspections inside their intervals, and on either side."""
    inside = (~early & ~late).astype(float)
    _, number = np.unique(owner, return_inverse=True)
    of_units = np.bincount(number, inside - inside.mean())
    limit = Z_95 * np.sqrt((of_units**2).sum()) / inside.size
    sides = f"{early.mean():.1%} earlier, {late.mean():.1%} later"
    print(f"{name}: {inside.mean():.1%} +- {limit:.1%} of {inside.size} inspections inside; {sides}")


def main(units: int, preset: str) -> None:
    """Print the coverage of all inspections and of each phase of life."""
    config = siggen.load_config(preset, overrides=[f"specimens={units}"])
    found = []
    for specimen in range(units):
        rows = life_rows(config, specimen)
        failure_h = rows["units"][0]["failure_h"]
        for inspection, outlook in zip(rows["inspections"], rows["outlook"], strict=True):
            left_h = failure_h - inspection["age_h"]
            early, late = left_h < outlook["rul_q10_h"], left_h > outlook["rul_q90_h"]
            found.append((specimen, early, late, PHASES.index(inspection["phase"])))
    owner, early, late, phase = np.array(found).T
    shown("all", owner, early > 0, late > 0)
    for number, name in enumerate(PHASES):
        own = phase == number
        shown(name, owner[own], early[own] > 0, late[own] > 0)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 500, sys.argv[2] if len(sys.argv) > 2 else "fleet")
