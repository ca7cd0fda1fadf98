"""Table of docs/understand/phm_2026.md: growing spalls on a 28/28 gearbox beside the PHM North America 2026 challenge.

`python docs/scripts/phm_2026.py [GEARBOXES]`; 6 gearboxes by default. Makes runs/phm_2026_one and runs/phm_2026_three
where they are missing: configs/bench.yaml with the teeth, speed and torque of the challenge, assumed module and
face, and irregular spalls that grow on one tooth and on three. Prints FM4, M6A and NA4 of the driving shaft at every
stage. NA4 has the gearbox's earlier stages as its history.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import yaml

import siggen
from diagnostics.indicators.ranking_table import ranking_table
from diagnostics.indicators.table import record_table

GEARBOXES = 6
GEAR = {"teeth": 28, "bore_radius_mm": 15.0}
PUBLISHED = {"fm4_pinion": ("FM4", "3.0-4.0"), "m6a_pinion": ("M6A", "15-30"), "na4_pinion": ("NA4", "2.7-3.3")}
STAGES = {"20 %": (0.5, 0.2), "40 %": (1.0, 0.4), "60 %": (1.5, 0.6), "80 %": (2.0, 0.8), "100 %": (2.5, 1.0)}
"""Share of the face -> mean length along the profile [mm] and that share."""
DAMAGED_TEETH = {"one": 1, "three": 3}


def config(teeth: int, gearboxes: int) -> dict[str, Any]:
    """Return the configuration of a machine whose spalls grow on neighbouring teeth."""
    raw = yaml.safe_load(Path("configs/bench.yaml").read_text(encoding="utf-8"))
    raw |= {"name": f"phm_2026_{teeth}", "seed": 20250704, "specimens": gearboxes}
    # Nothing is known of its shafts, nor of its gears across the face: stiff, and parallel.
    del raw["dynamics"]["shafts"]
    for key in ("helix", "crowning_um", "lead_misalignment_um"):
        del raw["manufacture"][key]
    raw["gears"] |= {"module_mm": 3.175, "face_width_mm": 6.35, "pinion": GEAR, "gear": GEAR}
    # Discs of the assumed gears stand for the masses.
    for gear in ("pinion", "gear"):
        raw["dynamics"][gear] |= {"mass_kg": None, "inertia_kg_m2": None}
    raw["operating_points"] = [{"speed_hz": 1400 / 60, "torque_nm": 162.7}]
    del raw["background"]["second_stage"]
    growing = [
        {"name": f"spall_{share[:-2]}", "severity": "severe", "damage": _spall(teeth, *size)}
        for share, size in STAGES.items()
    ]
    raw["states"] = [{"name": "healthy"}, *growing]
    del raw["splits"]
    return raw


def _spall(teeth: int, length_mm: float, share: float) -> dict[str, Any]:
    return {"kind": "irregular", "teeth": teeth, "profile_length_mm": length_mm, "face_share": share}


def quantiles(teeth: str, gearboxes: int) -> Iterator[tuple[str, dict[str, np.ndarray]]]:
    """Yield every stage with 10 %, median and 90 % of the indicators over gearboxes and channels."""
    folder = Path(f"runs/phm_2026_{teeth}")
    if not folder.exists():
        siggen.generate(siggen.load_config(config(DAMAGED_TEETH[teeth], gearboxes)), folder, workers=1)
    dataset = siggen.open(folder)
    matrix = ranking_table(record_table(dataset), dataset).matrix
    for state in ("healthy", *(f"spall_{share[:-2]}" for share in STAGES)):
        rows = matrix.labels["state"] == state
        columns = {name: [k for k, n in enumerate(matrix.names) if n.startswith(f"{name}__")] for name in PUBLISHED}
        yield state, {n: np.nanquantile(matrix.values[rows][:, c], (0.5, 0.1, 0.9)) for n, c in columns.items()}


def main(gearboxes: int) -> None:
    """Print one table per number of spalled teeth."""
    for teeth in DAMAGED_TEETH:
        print(f"\nspalls on {teeth} of 28 teeth\n")
        print("| stage | " + " | ".join(name for name, _ in PUBLISHED.values()) + " |")
        print("|---" * (1 + len(PUBLISHED)) + "|")
        print("| published, healthy and late | " + " | ".join(span for _, span in PUBLISHED.values()) + " |")
        for state, found in quantiles(teeth, gearboxes):
            cells = (f"**{m:.1f}** ({low:.1f}-{high:.1f})" for m, low, high in found.values())
            print(f"| {state} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else GEARBOXES)
