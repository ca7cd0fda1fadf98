"""How many slices skewed and wavy edges need: `python docs/scripts/irregular_slices.py`.

A spall of kind irregular, 1 mm long and through the face, on the pinion of configs/bench.yaml. For 3, 5, 8 and 45 µm of
approach and 2,048 positions, in 1e-3 of the healthy force: largest and rms difference to 3,200 slices, the rms over
positions at which the spall acts; then the largest error of the table's groups against all of its 200 slices.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml

import siggen
from siggen.dynamics.mesh.slice_law import SliceLaw, SliceOptions, slice_law, slice_law_error, slice_pair_force
from siggen.planning.specimen import draw_specimen
from siggen.specimen.contact import mean_line_load_n_per_m
from siggen.specimen.damage import state_damage
from siggen.specimen.gears import gear_pair, stiffness_options

SLICES = (50, 100, 200, 400, 800)
FINEST = 3200
DEPTHS_M = np.array([3e-6, 5e-6, 8e-6, 45e-6])
SPALL = {"kind": "irregular", "profile_length_mm": 1.0, "face_share": 1.0, "centre_height_mm": "pitch", "depth_mm": 0.2}
STRAIGHT = {"waviness": 0.0, "floor": "flat", "floor_roughness": 0.0, "edge_radius_mm": 0.1}
EDGES = ("leading_skew_mm_per_10mm", "trailing_skew_mm_per_10mm")
CASES = {f"skew {skew} mm": {**STRAIGHT, **dict.fromkeys(EDGES, 0.5 * skew)} for skew in (0.0, 0.2, 0.4, 0.8)}
CASES["waves of 15 %"] = {**dict(zip(EDGES, (0.1, -0.05), strict=True)), "waviness": 0.15, "edge_radius_mm": 0.1}


def forces(law: SliceLaw, row: int, position_m: np.ndarray) -> np.ndarray:
    """Return forces (depths, positions) of a kind of pair [N]."""
    return np.array([[slice_pair_force(law, row, p, depth) for p in position_m] for depth in DEPTHS_M])


def main() -> None:
    """Print one row per case."""
    raw = yaml.safe_load(Path("configs/bench.yaml").read_text(encoding="utf-8"))
    names = [f"case_{i}" for i in range(len(CASES))]
    states = [
        {"name": name, "severity": "severe", "grows_from": "none", "damage": {**SPALL, **case}}
        for name, case in zip(names, CASES.values(), strict=True)
    ]
    config = siggen.load_config({**raw, "states": [{"name": "healthy"}, *states]})
    specimen = draw_specimen(config, 0)
    pair, stiffness = gear_pair(specimen.gears), stiffness_options(specimen.stiffness)
    load = mean_line_load_n_per_m(config.operating_points, pair)
    print("| edges | " + " | ".join(f"{n}: largest, rms" for n in SLICES) + " | groups |\n" + "|---" * 7 + "|")
    for state, name in enumerate(CASES, start=1):
        damage = state_damage(config, 0, pair, state)
        laws = {n: slice_law(pair, damage, stiffness, SliceOptions(load, slices=n)) for n in (*SLICES, FINEST)}
        fine = laws[FINEST]
        position = fine.start_m + (np.arange(2048) + 0.5) / fine.per_m
        healthy, finest = forces(fine, 0, position), forces(fine, 1, position)
        acts = np.any(np.abs(finest - healthy) > 1e-6 * healthy, axis=0)
        error = {n: 1e3 * (forces(laws[n], 1, position) - finest) / healthy for n in SLICES}
        cells = [f"{np.abs(e).max():.2f}, {np.sqrt(np.mean(e[:, acts] ** 2)):.2f}" for e in error.values()]
        groups = 1e3 * slice_law_error(pair, damage, stiffness, SliceOptions(load), laws[200], DEPTHS_M)
        print(f"| {name} | " + " | ".join(cells) + f" | {groups:.2f} |")


if __name__ == "__main__":
    main()
