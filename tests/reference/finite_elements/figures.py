"""Figure of the finite-element check: compliances of the models over it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.reference.finite_elements.comparison import SIZE, active_rolls, model_ratios, paper_a_pair
from tests.reference.finite_elements.tooth_compliance_fem import tooth_compliance

FOLDER = Path(__file__).resolve().parents[3] / "docs" / "figures"
STYLES = {
    "base circle + profile": "C0--",
    "root circle + profile": "C1-.",
    "rack trochoid + rack": "C2-",
    "calibrated": "k:",
}


def write_figures() -> list[Path]:
    """Write the figure of the models to docs/figures and return its path."""
    import matplotlib as mpl

    mpl.use("Agg")
    path = FOLDER / "finite_elements_models.png"
    model_figure().savefig(path, dpi=90, bbox_inches="tight", metadata={"Software": None})
    return [path]


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
