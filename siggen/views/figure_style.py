"""One look for all pictures of `siggen`: colours, grid, lines and letters; `save_figure` applies it."""

from __future__ import annotations

from typing import Any

PALETTE = (
    *("#5b6b7b", "#e3a21a", "#1f6f8b", "#b01e3c", "#6a1b6e"),
    *("#3c7d3e", "#d9622b", "#8a97a3", "#2c1e55", "#7fb3c8"),
)
"""C0 for what is healthy, then damage; C2 and C3 also stand for gear and pinion."""


def figure_style() -> dict[str, Any]:
    """Return the settings of matplotlib for a figure."""
    from cycler import cycler

    return {
        "font.size": 10,
        "axes.titlesize": 10,
        "axes.labelsize": 10,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "axes.prop_cycle": cycler(color=PALETTE),
        "grid.color": "#dde3e8",
        "grid.linewidth": 0.6,
        "lines.linewidth": 1.0,
        "legend.frameon": False,
        "text.color": "#1c2733",
        "axes.labelcolor": "#1c2733",
        "axes.edgecolor": "#566573",
        "xtick.color": "#566573",
        "ytick.color": "#566573",
        "xtick.labelcolor": "#1c2733",
        "ytick.labelcolor": "#1c2733",
        "savefig.facecolor": "white",
    }
