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
from diagnostics.training.detectors import BOOSTED, CHOSEN, CLASSIFIER, INDICATOR, NETWORKS, Detectors

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOOKS = {
    CHOSEN: ("chosen", "#111820", "o"),
    INDICATOR: ("indicator", "#1f6f8b", "s"),
    CLASSIFIER: ("logistic", "#b01e3c", "v"),
    BOOSTED: ("boosting", "#8e44ad", "D"),
    NETWORKS: ("network", "#e3a21a", "^"),
}
"""Name in the legend, colour and marker of each family; the answer itself in black."""

DASHES = ("-", "--", ":", "-.")
"""By kind of damage."""

SIDEWAYS = (1.0, 0.92, 0.96, 1.04, 1.08)
"""Families stand beside each other at one size, so that all can be seen."""

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
        figure = Figure(figsize=(WIDTH_IN, 3.3 + 0.4 * (len(kinds) - 1)), layout="constrained")
        heights = {"height_ratios": [3.4, 0.6 + 0.65 * len(kinds)]}
        axes = figure.subplots(2, len(panels), squeeze=False, sharex=True, sharey="row", gridspec_kw=heights)
        for column, (title, detectors) in enumerate(panels):
            _draw_areas(axes[0, column], detectors, kinds)
            _draw_sizes(axes[1, column], detectors, kinds)
            _name_states(axes[0, column], detectors)
            axes[0, column].set_title(title, loc="left", fontweight="bold")
        _scale(axes[1, 0], [detector for _, detectors in panels for detector in detectors.values()])
        axes[0, 0].set_ylabel("AUC against\nhealthy [-]")
        figure.supxlabel("Damaged area [mm²]", fontsize=10)
        _show_dashes(axes[1, 0], kinds, 0.15 * len(panels))
        shown = [family for family in LOOKS if any(family in detectors for _, detectors in panels)]
        figure.legend(
            *_legend(shown), loc="outside upper left", ncols=5, fontsize=9, handletextpad=0.3, columnspacing=1.2
        )
    return figure


def _draw_areas(axis: Any, detectors: dict[str, Detector], kinds: Sequence[str]) -> None:
    axis.axhline(0.5, color="#8a97a3", linewidth=0.9)
    for family, detector in detectors.items():
        place = list(LOOKS).index(family)
        _, colour, marker = LOOKS[family]
        answer = family == CHOSEN
        for number, kind in enumerate(kinds):
            shown = sorted(
                (s for s in detector.states.values() if s.kind == kind and math.isfinite(s.auc.value)),
                key=lambda state: state.area_mm2,
            )
            size = SIDEWAYS[place] * np.array([state.area_mm2 for state in shown])
            axis.plot(
                size,
                [state.auc.value for state in shown],
                DASHES[number % len(DASHES)],
                color=colour,
                marker=marker,
                markersize=5.5 if answer else 3.5,
                linewidth=1.8 if answer else 0.8,
                zorder=3 if answer else 2,
            )
            if answer:
                axis.vlines(size, *_limits(shown), color=colour, linewidth=1.2, zorder=3)
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
    """Draw from which size on nine of ten are found; every kind of damage has a row of its own for every family."""
    families = [family for family in LOOKS if family in detectors and detectors[family].sizes]
    for group, kind in enumerate(kinds):
        for place, family in enumerate(families):
            if kind in detectors[family].sizes:
                row = group + 0.8 * ((place + 0.5) / len(families) - 0.5)
                _draw_size(axis, detectors[family].sizes[kind], row, family)
        if not any(kind in detectors[family].sizes for family in families):
            axis.text(0.03, group, "too few sizes", transform=axis.get_yaxis_transform(), va="center", fontsize=8)
    axis.set_ylim(len(kinds) - 0.5, -0.5)
    if len(kinds) == 1:
        axis.set_yticks([0.0], ["nine of\nten found"])
    else:
        names = [textwrap.fill(kind_name(kind, kinds), 17) for kind in kinds]
        axis.set_yticks(range(len(kinds)), names, fontsize=7.5)
        axis.set_title("nine of ten found", loc="left", fontsize=9)
    axis.tick_params(axis="y", length=0)
    axis.grid(visible=False, axis="y")


def _draw_size(axis: Any, size: FoundSize, row: float, family: str) -> None:
    """Draw a point with limits, and broadly what lies above it; a cross at the largest where it is not found."""
    _, colour, marker = LOOKS[family]
    answer = family == CHOSEN
    if not size.reached:
        axis.plot(size.largest_mm2, row, marker="x", color=colour, markersize=6, markeredgewidth=2.2 if answer else 1.4)
        return
    found = size.area_mm2
    axis.plot([found.value, size.largest_mm2], [row, row], color=colour, linewidth=4.5, alpha=0.35)
    high = found.high if math.isfinite(found.high) else size.largest_mm2
    axis.plot([found.low, high], [row, row], color=colour, linewidth=1.1)
    axis.plot(found.value, row, marker=marker, color=colour, markersize=5.5 if answer else 4)


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


def _show_dashes(axis: Any, kinds: Sequence[str], length: float) -> None:
    """Underline the name of every kind of damage with the dashes that its line has in the figure above."""
    from matplotlib.transforms import blended_transform_factory

    if len(kinds) == 1:
        return
    place = blended_transform_factory(axis.transAxes, axis.transData)
    for group in range(len(kinds)):
        dashes = DASHES[group % len(DASHES)]
        ends, height = [-0.03 - length, -0.03], [group + 0.42] * 2
        axis.plot(ends, height, dashes, color="#111820", linewidth=1.6, transform=place, clip_on=False)


def _legend(families: Sequence[str]) -> tuple[list[Any], list[str]]:
    from matplotlib.lines import Line2D

    looks = [LOOKS[family] for family in families]
    lines = [Line2D([], [], color=colour, marker=marker, markersize=5) for _, colour, marker in looks]
    return lines, [name for name, _, _ in looks]
