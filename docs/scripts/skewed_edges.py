"""What skew of its edges does to a spall of 1 mm through the face: `python docs/scripts/skewed_edges.py [GEARBOXES]`.

Makes runs/skewed (configs/bench.yaml with states of its own) where it is missing: healthy, and spalls 1 mm long along
the profile about the pitch line, whose two edges are turned together by SKEWS over the face. Prints the kurtosis of
Teager's energy operator of the pinion's averaged residual in every channel's geometric mean, gearbox by gearbox.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from high_order_probe import STEPS, auc, averaged

import siggen

SET = Path("runs/skewed")
SKEWS = (0.0, 0.2, 0.4, 0.8)
"""Millimetres of arc by which one end of the spall lies higher than the other."""
LENGTH_MM, DEPTH_MM = 1.0, 0.2


def spall(gears: dict[str, Any], skew_mm: float) -> dict[str, Any]:
    """Return the damage section of a spall with skewed edges; heights are arcs from the base circle."""
    angle = math.radians(gears["pressure_angle_deg"])
    base_mm = 0.5 * gears["module_mm"] * gears["pinion"]["teeth"] * math.cos(angle)
    middle = 0.5 * base_mm * math.tan(angle) ** 2  # involute's arc up to the pitch point
    corners = [(side, edge) for side, edge in ((0, -1), (0, 1), (1, 1), (1, -1))]
    vertices = [
        {
            "face_mm": side * gears["face_width_mm"],
            "height_mm": middle + 0.5 * edge * LENGTH_MM + (side - 0.5) * skew_mm,
        }
        for side, edge in corners
    ]
    return {"kind": "spall", "teeth": 1, "shape": "polygon", "vertices": vertices, "depth_mm": DEPTH_MM}


def teager_kurtosis(average: np.ndarray, teeth: int) -> float:
    """Return the kurtosis of x_i² - x_(i-1) x_(i+1) of an average without shaft orders 0 to 2 and mesh harmonics."""
    lines = np.fft.rfft(average)
    orders = np.arange(len(lines))
    lines[(orders <= 2) | (orders % teeth == 0)] = 0.0
    x = np.fft.irfft(lines, STEPS)
    energy = x**2 - np.roll(x, 1) * np.roll(x, -1)
    energy -= energy.mean()
    return float(np.mean(energy**4) / np.mean(energy**2) ** 2)


def values(dataset: Any) -> dict[str, np.ndarray]:
    """Return state -> kurtosis of every gearbox, the geometric mean over the channels."""
    found: dict[str, dict[int, float]] = {}
    for batch in dataset.records():
        for row in batch.to_pylist():
            tacho_s = np.asarray(row["tacho_s"])
            single = [
                teager_kurtosis(averaged(np.asarray(row[channel.column]), dataset.fs_hz, tacho_s), row["teeth_pinion"])
                for channel in dataset.channels
            ]
            found.setdefault(row["state"], {})[row["specimen_id"]] = float(np.exp(np.mean(np.log(single))))
    return {state: np.array([by[k] for k in sorted(by)]) for state, by in found.items()}


def main(gearboxes: int) -> None:
    """Print kurtosis by state and its AUC against healthy records of other gearboxes."""
    if not SET.exists():
        raw = yaml.safe_load(Path("configs/bench.yaml").read_text(encoding="utf-8"))
        states = [{"name": "healthy"}] + [
            {
                "name": f"skew_{100 * skew:03.0f}",
                "severity": "severe",
                "grows_from": "none",
                "damage": spall(raw["gears"], skew),
            }
            for skew in SKEWS
        ]
        siggen.generate(siggen.load_config({**raw, "specimens": gearboxes, "states": states}), SET, workers=1)
    found = values(siggen.open(SET))
    for state, each in sorted(found.items()):
        text = ", ".join(f"{q:.1f}" for q in np.quantile(each, (0.1, 0.5, 0.9)))
        against = "" if state == "healthy" else f"; AUC {auc(found['healthy'], each, np.arange(len(each))):.2f}"
        print(f"{state}: {text} (10 %, median, 90 %){against}, {len(each)} gearboxes")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 12)
