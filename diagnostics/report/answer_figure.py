"""The one figure that opens a report: AUC over the size of the damage, and from which size on nine of ten are found."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.page.style import WIDTH_IN, styled
from diagnostics.records.damage_kind import kind_name
from diagnostics.statistics.detector import Detector, FoundSize
from diagnostics.training.detectors import BOOSTED, CLASSIFIER, INDICATOR, NETWORKS, Detectors

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOOKS = {
    INDICATOR: ("indicator", "#1f6f8b", "s"),
    CLASSIFIER: ("logistic", "#b01e3c", "o"),
    BOOSTED: ("boosting", "#6a1b6e", "D"),
    NETWORKS: ("network", "#e3a21a", "^"),
}
"""Name in the legend, colour and marker of each family."""

DASHES = ("-", "--", ":", "-.")
SIDEWAYS = (0.92, 0.973, 1.027, 1.08)
"""Families stand beside each other at one size, so that their limits can be read."""

MOST_NAMES = 4
LEAST_RATIO = 1.7
"""Of neighbouring sizes whose names do not touch."""


def answer_figure(found: Detectors) -> Figure | None:
    """Return AUC by state over its damaged area above, sizes found in nine of ten below; None without any detector."""
    from matplotlib.figure import Figure

    sides = [("On an unseen gearbox", found.alone), ("With its healthy record", found.referenced)]
    panels = [(title, {family: side[family] for family in LOOKS if family in side}) for title, side in sides if side]
    if not panels:
        return None
    with styled():
        kinds = list(dict.fromkeys(s.kind for _, side in panels for one in side.values() for s in one.states.values()))
        figure = Figure(figsize=(WIDTH_IN, 3.5 + 0.35 * (len(kinds) - 1)), layout="constrained")
        heights = {"height_ratios": [3.4, 0.5 + 0.5 * len(kinds)]}
        axes = figure.subplots(2, len(panels), squeeze=False, sharex=True, sharey="row", gridspec_kw=heights)
        for column, (title, detectors) in enumerate(panels):
            _draw_areas(axes[0, column], detectors, kinds)
            _draw_sizes(axes[1, column], detectors, kinds)
            _name_states(axes[0, column], detectors)
            axes[0, column].set_title(title, loc="left", fontweight="bold")
        _scale(axes[1, 0], [detector for _, detectors in panels for detector in detectors.values()])
        axes[0, 0].set_ylabel("AUC against\nhealthy [-]")
        figure.supxlabel("Damaged area [mm²]", fontsize=10)
        figure.legend(*_legend(panels[0][1]), loc="outside upper center", ncols=4, fontsize=9, handletextpad=0.3)
    return figure


def _draw_areas(axis: Any, detectors: dict[str, Detector], kinds: Sequence[str]) -> None:
    axis.axhline(0.5, color="#8a97a3", linestyle="--", linewidth=0.9)
    for family, detector in detectors.items():
        place = list(LOOKS).index(family)
        _, colour, marker = LOOKS[family]
        for number, kind in enumerate(kinds):
            shown = sorted(
                (s for s in detector.states.values() if s.kind == kind and math.isfinite(s.auc.value)),
                key=lambda state: state.area_mm2,
            )
            size = SIDEWAYS[place] * np.array([state.area_mm2 for state in shown])
            dashes = DASHES[number % len(DASHES)]
            axis.plot(size, [state.auc.value for state in shown], dashes, color=colour, marker=marker, markersize=5)
            axis.vlines(size, *_limits(shown), color=colour, linewidth=1.4, alpha=0.6)
    axis.set_ylim(0.0, 1.04)
    axis.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "", "0.5", "", "1"])


def _name_states(axis: Any, detectors: dict[str, Detector]) -> None:
    """Write the names of the states over their sizes, where they are few enough to stand beside each other."""
    states = next(iter(detectors.values())).states
    sizes = np.sort([state.area_mm2 for state in states.values()])
    if len(states) > MOST_NAMES or (sizes[1:] < LEAST_RATIO * sizes[:-1]).any():
        return
    for name, state in states.items():
        axis.text(state.area_mm2, 0.03, name, ha="center", va="bottom", fontsize=9, color="#566573")


def _limits(states: Sequence[Any]) -> tuple[list[float], list[float]]:
    return [state.auc.low for state in states], [state.auc.high for state in states]


def _draw_sizes(axis: Any, detectors: dict[str, Detector], kinds: Sequence[str]) -> None:
    """Draw from which size on nine of ten are found: a line to the largest, limits as a bar, a cross where none is.

    Every kind of damage has a row of its own for every family, with the dashes that it has above.
    """
    families = [family for family in LOOKS if family in detectors]
    for group, kind in enumerate(kinds):
        for place, family in enumerate(families):
            if kind in detectors[family].sizes:
                row = group + 0.8 * ((place + 0.5) / len(families) - 0.5)
                _draw_size(axis, detectors[family].sizes[kind], row, LOOKS[family][1], DASHES[group % len(DASHES)])
    axis.set_ylim(len(kinds) - 0.4, -0.6)
    if len(kinds) == 1:
        axis.set_yticks([0.0], ["nine of\nten found"])
    else:
        names = [textwrap.fill(kind_name(kind, kinds), 17) for kind in kinds]
        axis.set_yticks(range(len(kinds)), names, fontsize=7.5)
        axis.set_title("nine of ten found", loc="left", fontsize=9)
    axis.tick_params(axis="y", length=0)
    axis.grid(visible=False, axis="y")


def _draw_size(axis: Any, size: FoundSize, row: float, colour: str, dashes: str) -> None:
    found = size.area_mm2
    if not size.reached:
        axis.plot(size.largest_mm2, row, marker="x", color=colour, markersize=6, markeredgewidth=1.8)
        return
    axis.plot([found.value, size.largest_mm2], [row, row], dashes, color=colour, linewidth=2.5)
    axis.plot(found.value, row, marker="|", color=colour, markersize=8, markeredgewidth=2.2)
    high = found.high if math.isfinite(found.high) else size.largest_mm2
    axis.plot([found.low, high], [row, row], color="#1c2733", linewidth=0.9)


def _scale(axis: Any, detectors: Sequence[Detector]) -> None:
    """Scale sizes logarithmically, with a few round numbers below them."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    sizes = [state.area_mm2 for detector in detectors for state in detector.states.values() if state.area_mm2 > 0.0]
    sizes += [end for one in detectors for size in one.sizes.values() for end in (size.smallest_mm2, size.largest_mm2)]
    if not sizes:
        return
    axis.set_xscale("log")
    low, high = min(sizes) / 1.3, max(sizes) * 1.3
    axis.set_xlim(low, high)
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,), numticks=99))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda size, _: f"{size:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())


def _legend(detectors: dict[str, Detector]) -> tuple[list[Any], list[str]]:
    from matplotlib.lines import Line2D

    shown = [LOOKS[family] for family in LOOKS if family in detectors]
    lines = [Line2D([], [], color=colour, marker=marker, markersize=6) for _, colour, marker in shown]
    return lines, [name for name, _, _ in shown]
