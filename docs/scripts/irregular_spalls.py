"""Teager's operator over the edges of a spall of 1 mm: `python docs/scripts/irregular_spalls.py [GEARBOXES]`.

Makes runs/irregular (configs/bench.yaml with states of its own) where it is missing: healthy, and spalls of kind
irregular through the whole face, 1 mm long about the pitch line, with both edges turned together by SKEWS over the
face, and one with the default skews and waves. Prints two numbers, geometric means over the channels: the kurtosis of
Teager's operator of the pinion's averaged residual (the best shipped indicator) and that of the average in high orders
(`high_order_probe.py`, the stronger probe), each with its AUC against healthy records of other gearboxes. Draws
docs/figures/irregular_flanks.png: three severities of one spall on two gearboxes.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from high_order_probe import auc, probes

import siggen
from diagnostics.indicators.classifier_table import classifier_table, feature_matrix
from diagnostics.indicators.table import record_table
from siggen.views.flank_figure import save_flank_figure
from siggen.views.flank_views import flank_views

SET = Path("runs/irregular")
SKEWS = (0.0, 0.2, 0.4, 0.8)
"""Millimetres of arc by which one end of both edges lies higher than the other, over a face of 20 mm."""
SPALL = {"kind": "irregular", "profile_length_mm": 1.0, "face_share": 1.0, "centre_height_mm": "pitch", "depth_mm": 0.2}
STRAIGHT = {"waviness": 0.0, "floor": "flat", "floor_roughness": 0.0, "edge_radius_mm": 0.1}
GROWN = {"slight": (0.6, 0.25), "moderate": (1.0, 0.6), "severe": (1.6, 1.0)}
"""State of the picture: length along the profile [mm] and share of the face."""
FIGURE = Path("docs/figures/irregular_flanks.png")
INDICATOR = "energy_operator_teager_pinion"


def states() -> list[dict[str, Any]]:
    """Return the states: every spall begins with an intact gear."""
    found: dict[str, dict[str, Any]] = {}
    for skew in SKEWS:
        slopes = dict.fromkeys(("leading_skew_mm_per_10mm", "trailing_skew_mm_per_10mm"), 0.5 * skew)
        found[f"skew_{100 * skew:03.0f}"] = {**SPALL, **STRAIGHT, **slopes}
    found["irregular"] = SPALL
    damaged = [{"name": n, "severity": "severe", "grows_from": "none", "damage": d} for n, d in found.items()]
    return [{"name": "healthy"}, *damaged]


def draw_growth(raw: dict[str, Any]) -> None:
    """Draw the flanks of two gearboxes in all states of `GROWN`."""
    grown = [
        {"name": name, "damage": {"kind": "irregular", "profile_length_mm": length, "face_share": share}}
        for name, (length, share) in GROWN.items()
    ]
    config = siggen.load_config({**raw, "states": [{"name": "healthy"}, *grown]})
    save_flank_figure([view for specimen in range(2) for view in flank_views(config, specimen)], FIGURE)


def teager(dataset: Any) -> dict[str, dict[int, float]]:
    """Return state -> gearbox -> kurtosis of Teager's operator."""
    matrix = feature_matrix(classifier_table(record_table(dataset)))
    columns = [i for i, name in enumerate(matrix.names) if name.startswith(INDICATOR)]
    value = np.exp(np.mean(np.log(matrix.values[:, columns]), axis=1))
    found: dict[str, dict[int, float]] = {}
    for state, specimen, each in zip(matrix.labels["state"], matrix.labels["specimen_id"], value, strict=True):
        found.setdefault(str(state), {})[int(specimen)] = float(each)
    return found


def show(title: str, found: dict[str, dict[int, float]]) -> None:
    """Print quantiles, AUC and the first gearboxes of every state."""
    values = {state: np.array([by[k] for k in sorted(by)]) for state, by in found.items()}
    for state, each in values.items():
        spread = ", ".join(f"{q:.1f}" for q in np.quantile(each, (0.1, 0.5, 0.9)))
        found_by = "" if state == "healthy" else f"; AUC {auc(values['healthy'], each, np.arange(each.size)):.2f}"
        first = ", ".join(f"{value:.1f}" for value in each[:2])
        print(f"{title}, {state}: {spread} (10 %, median, 90 %){found_by}; gearboxes 0 and 1: {first}")


def main(gearboxes: int) -> None:
    """Draw the picture and print one row per state."""
    raw = yaml.safe_load(Path("configs/bench.yaml").read_text(encoding="utf-8"))
    draw_growth(raw)
    if not SET.exists():
        siggen.generate(siggen.load_config({**raw, "specimens": gearboxes, "states": states()}), SET, workers=1)
    dataset = siggen.open(SET)
    show("Teager's operator", teager(dataset))
    show("high orders", probes(dataset))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 12)
