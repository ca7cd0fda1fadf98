"""What drawing the housing widely does to healthy records of bench: one thing taken back at a time.

`python docs/scripts/housing_draw.py FOLDER [GEARBOXES]` makes sets of healthy records in runs/ where they are missing,
has `siggen-diagnostics audit` compare them with the recordings in FOLDER (25.6 kHz where they do not say), and prints a
row per change. 24 gearboxes take a minute of CPU time each.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from report_pages import run

import siggen
from siggen.config.inheritance import inherited
from siggen.config.yaml_source import read_yaml

RUNS, CONFIGS = Path("runs"), Path("configs")
MASS = {"dynamics.casing.mass_kg": 20.0, "dynamics.casing.inertia_kg_m2": 0.25, "housing.modal_mass_kg": 20.0}
DAMPING = {
    "dynamics.casing.bolts.damping_ratio": {"kind": "uniform", "low": 0.03, "high": 0.05},
    "housing.damping_ratio": {"kind": "uniform", "low": 0.01, "high": 0.04},
}
LEVEL = {"background.floor.level_std": 0.0}
CHANGES: dict[str, dict[str, Any]] = {
    "bench": {},
    "one mass of 20 kg": MASS,
    "damping as before": DAMPING,
    "steady noise of bearings": LEVEL,
    "all three, as before": {**MASS, **DAMPING, **LEVEL},
}
ENOUGH, TELLING = 0.8, 0.9
"""Share inside that a quantity needs; AUC from which a feature gives a set away."""


def audited(name: str, changes: dict[str, Any], gearboxes: int, reference: str) -> dict[str, Any]:
    """Return audit.json of healthy gearboxes with changes."""
    path = RUNS / f"housing_{name.replace(' ', '_').replace(',', '')}"
    if not (path / "manifest.json").exists():
        raw = inherited(read_yaml(CONFIGS / "bench.yaml"), CONFIGS)
        raw = {**raw, "specimens": gearboxes, "states": raw["states"][:1]}
        overrides = [f"{key}={json.dumps(value)}" for key, value in changes.items()]
        siggen.generate(siggen.load_config(raw, overrides), path, workers=1)
    out = path.with_name(f"{path.name}_audit")
    if not (out / "audit.json").exists():
        run(f"siggen-diagnostics audit {path} --realism --reference {reference} --reference-fs 25600 --out {out}")
    found: dict[str, Any] = json.loads((out / "audit.json").read_text(encoding="utf-8"))
    return found


def row(name: str, found: dict[str, Any]) -> str:
    """Return the Markdown row of one change."""
    realism, reference = found["realism"], found["reference"]
    enough = sum(entry["inside"] >= ENOUGH for entry in realism["quantities"])
    inside = {entry["name"]: entry["inside"] for entry in realism["quantities"]}
    telling = sum(entry["auc"] >= TELLING for entry in reference["gaps"])
    within = sum(place["farther"] >= 0.05 for place in reference["places"])
    cells = (
        f"{telling} of {len(reference['gaps'])}",
        f"{reference['inside']:.0%}",
        f"{within} of {len(reference['places'])}",
        f"{enough} of {len(realism['quantities'])}",
        f"{inside['noise_density_db']:.0%}",
        f"{realism['background']['mean_share_inside']:.0%}",
    )
    return f"| {name} | {' | '.join(cells)} |"


def main(reference: str, gearboxes: int) -> None:
    """Print the table."""
    RUNS.mkdir(exist_ok=True)
    rows = [row(name, audited(name, changes, gearboxes, reference)) for name, changes in CHANGES.items()]
    head = "| one thing taken back | features with an AUC of 0.9 | values inside | channels within the spread"
    print(f"{head} | quantities with 80 % inside | noise at mesh 1 inside | beside the mesh lines inside |")
    print("|---|---|---|---|---|---|---|", *rows, sep="\n")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 24)
