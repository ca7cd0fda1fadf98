"""Figures of the finite-element check: mesh, compliances against the models, calibration factor."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from siggen.gears.stiffness.calibration import calibration_factor
from tests.reference.finite_elements.calibration import ToothShape
from tests.reference.finite_elements.comparison import SIZE, active_rolls, model_ratios, paper_a_pair
from tests.reference.finite_elements.tooth_compliance_fem import tooth_compliance
from tests.reference.finite_elements.tooth_mesh import tooth_mesh

FOLDER = Path(__file__).resolve().parents[3] / "docs" / "figures"
STYLES = {
    "base circle + profile": "C0--",
    "root circle + profile": "C1-.",
    "rack trochoid + rack": "C2-",
    "calibrated": "k:",
}
MESH_IN_PICTURE = 0.08


def write_figures() -> list[Path]:
    """Write all figures to docs/figures and return their paths."""
    import matplotlib as mpl

    mpl.use("Agg")
    FOLDER.mkdir(parents=True, exist_ok=True)
    makers = {"mesh": mesh_figure, "models": model_figure, "factor": factor_figure}
    paths = []
    for name, make in makers.items():
        path = FOLDER / f"finite_elements_{name}.png"
        make().savefig(path, dpi=90, bbox_inches="tight", metadata={"Software": None})
        paths.append(path)
    return paths


def mesh_figure() -> Any:
    """Mesh of the 18-tooth gear, coarser than the one computed with, whole and at the tooth."""
    from matplotlib import pyplot as plt

    pair = paper_a_pair()
    gear, roll = pair.pinion, active_rolls(pair, 7)[0]
    mesh = tooth_mesh(gear, roll[None], MESH_IN_PICTURE)
    figure, axes = plt.subplots(1, 2, figsize=(10, 5))
    for axis in axes:
        axis.triplot(*mesh.points, mesh.triangles.T, color="0.55", linewidth=0.4)
        axis.set_aspect("equal")
        axis.set_xlabel("x / module")
    _draw_loads(axes[1], gear, roll, mesh.load_points[0])
    axes[0].set_ylabel("y / module")
    axes[0].set_title("one tooth on its ring (z = 18)")
    axes[1].set(xlim=(-1.7, 2.2), ylim=(7.2, 10.2), title="load points and where the displacement is read")
    return figure


def _draw_loads(axis: Any, gear: Any, roll: np.ndarray, points: np.ndarray) -> None:
    crossing = gear.base_radius_m / gear.module_m / np.cos(roll - gear.base_half_angle_rad)
    for (x, y), height in zip(points, crossing, strict=True):
        axis.plot([x + 0.35 * x, x, 0.0], [y + 0.35 * (y - height), y, height], "C3-", linewidth=0.8)
    axis.plot(*points.T, "C3o", markersize=4, label="unit force, node")
    axis.plot(np.zeros_like(crossing), crossing, "C0s", markersize=4, label="reading")
    axis.legend(loc="upper right", fontsize=8)


def model_figure() -> Any:
    """Model / finite elements over both active flanks."""
    from matplotlib import pyplot as plt

    pair = paper_a_pair()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    for axis, gear, roll in zip(axes, (pair.pinion, pair.gear), active_rolls(pair, 41), strict=True):
        elements = tooth_compliance(gear, roll, size=SIZE)
        for name, ratio in model_ratios(gear, roll, elements).items():
            axis.plot(gear.radius_m(roll) * 1e3, ratio, STYLES[name], label=name)
        axis.axhline(1.0, color="0.8", linewidth=0.6)
        axis.axvline(gear.pitch_radius_m * 1e3, color="0.8", linewidth=0.6)
        axis.set(title=f"z = {gear.teeth}, bore {gear.bore_radius_m * 1e3:g} mm", xlabel="radius of the contact [mm]")
    axes[0].set_ylabel("tooth compliance, model / finite elements")
    axes[0].legend(fontsize=8, loc="center right")
    return figure


def factor_figure() -> Any:
    """Calibration factor over the place on the flank, for several gears."""
    from matplotlib import pyplot as plt

    place = np.linspace(0.0, 1.0, 101)
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.8), sharey=True)
    for axis, ratio in zip(axes, (1.5, 3.0, 6.5), strict=True):
        for i, teeth in enumerate((18, 25, 40, 90)):
            gear = ToothShape(teeth, ratio).gear()
            roll = gear.involute_start_roll_rad + place * (gear.tip_roll_rad - gear.involute_start_roll_rad)
            axis.plot(place, calibration_factor(gear, roll), f"C{i}-", label=f"z = {teeth}")
        axis.axhline(1.0, color="0.8", linewidth=0.6)
        axis.set(title=f"root / bore radius {ratio:g}", xlabel="involute start .. tip (linear in roll)")
    axes[0].set_ylabel("finite elements / rack trochoid + Sainsot")
    axes[0].legend(fontsize=8)
    return figure
