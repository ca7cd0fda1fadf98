"""The figure of work against precision: `python docs/scripts/work_precision.py FILE [PNG]`.

Draws the rows of the topic `precision` from a file of `python -m benchmarks precision --json FILE`, one panel per law.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from siggen.views.figure_style import figure_style

FIGURE = Path(__file__).resolve().parents[1] / "figures" / "work_precision.png"
OWN = {"exponential": "siggen, exponential", "product": "siggen, product"}
LOOKS = {
    **dict.fromkeys(OWN, ("C2", "o")),
    "Runge-Kutta, numba": ("C3", "s"),
    "Newmark, numpy": ("C1", "^"),
    "Newmark of ROSS": ("C5", "v"),
    "DOP853": ("C4", "D"),
    "DOP853, numba": ("C6", "X"),
    "LSODA": ("C0", "P"),
}


def figure(points: Sequence[Mapping[str, Any]]) -> Figure:
    """Return one panel per law: CPU time per second of signal over error, a line per method."""
    laws = list(dict.fromkeys(point["law"] for point in points))
    drawn = Figure(figsize=(3.7 * len(laws), 4.6), layout="constrained")
    all_axes = drawn.subplots(1, len(laws), sharex=True, sharey=True, squeeze=False).flat
    for law, axes in zip(laws, all_axes, strict=True):
        _panel(axes, [point for point in points if point["law"] == law])
        axes.set_title(law)
        axes.set_xlabel("relative rms error of the acceleration")
    drawn.axes[0].set_ylabel("CPU time per second of signal [s]")
    names = {name: line for axes in drawn.axes for line, name in zip(*axes.get_legend_handles_labels(), strict=True)}
    names = {name: names[name] for name in dict.fromkeys([*OWN.values(), *names])}
    drawn.legend(names.values(), names.keys(), loc="outside lower center", ncols=4)
    return drawn


def _panel(axes: Axes, points: Sequence[Mapping[str, Any]]) -> None:
    for method in dict.fromkeys(point["method"] for point in points):
        own = sorted((p for p in points if p["method"] == method), key=lambda p: p["cost_s"])
        near = [point for point in own if point["error"] < 1.0]  # farther off nothing is alike
        colour, marker = LOOKS[method]
        errors, costs = [point["error"] for point in near], [point["cost_s"] for point in near]
        axes.loglog(errors, costs, color=colour, marker=marker, markersize=5, label=OWN.get(method, method))
        for point in near:
            if point["rule"]:
                axes.plot(point["error"], point["cost_s"], "o", markersize=13, fillstyle="none", color=colour)
    axes.grid(visible=True, which="major")


def main(file: str, png: str = str(FIGURE)) -> None:
    """Write the figure."""
    topics = json.loads(Path(file).read_text(encoding="utf-8"))["topics"]
    if "precision" not in topics:
        sys.exit(f"{file}: received the topics {', '.join(topics)}; allowed: a file with `precision`")
    rows = [row["numbers"] for row in topics["precision"]["rows"] if row["numbers"] and "error" in row["numbers"]]
    with mpl.rc_context(figure_style()):
        figure(rows).savefig(png, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
