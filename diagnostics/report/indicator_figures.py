"""Figures of the evaluation of indicators: curves over severity and size of damage.

Indicators as people call them, with their definitions on hover and a link to the table of definitions.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.indicators.indicator import OF_CHANNEL
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.registry import IndicatorColumn, column_title, indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.page.html import Cell
from diagnostics.page.style import new_figure, state_ticks
from diagnostics.records.channel_quantities import ShownQuantity
from diagnostics.records.gear_train import GearNames
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.assessment import SIZES
from diagnostics.statistics.detectable_size import detection_curve
from diagnostics.statistics.indicator_result import IndicatorResult
from diagnostics.statistics.judged_records import JudgedRecords

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CROWDED = 8
"""States beyond which their names are small."""
ROWS_SHOWN = 36
CURVE_COLOURS = ("#b01e3c", "#1f6f8b", "#e3a21a", "#6a1b6e", "#3c7d3e", "#5b6b7b")
MARKERS = "osD^vP"
LEGEND_SIGNS = 66


def known_column(column: str, gears: GearNames) -> IndicatorColumn | None:
    """Return what a column with its channel holds; None of the user's own."""
    return indicator_columns(IndicatorSettings(), gears).get(column.partition("__")[0])


def in_words(column: str, gears: GearNames) -> str:
    """Return what people call a column with its channel; the user's own indicators keep their names."""
    return column_title(column.partition("__")[0], gears)


def term_cell(column: str, gears: GearNames) -> Cell:
    """Return the cell that names a column: its title, which leads to the definition, its channel and its own name."""
    known = known_column(column, gears)
    channel = column.partition("__")[2]
    small = f"{channel}; {column.partition('__')[0]}" if channel else column
    return Cell(in_words(column, gears), small, link=f"#term-{known.entry.name}" if known else "")


def in_a_sentence(column: str, gears: GearNames) -> str:
    """Return a column as a sentence names it: its title in small letters where it is no acronym, and its channel."""
    title, channel = in_words(column, gears), column.partition("__")[2]
    if title[1:2].islower():
        title = title[:1].lower() + title[1:]
    return f"{title} at {channel}" if channel else title


def panel_title(column: str, gears: GearNames, width: int = 38) -> str:
    """Return title and channel of a column for a figure, in lines of at most so many signs."""
    title, channel = in_words(column, gears), column.partition("__")[2]
    return "\n".join(textwrap.wrap(f"{title} ({channel})" if channel else title, width))


def separation_rows(found: Sequence[IndicatorResult], states: tuple[str, ...]) -> dict[str, list[float]]:
    """Return the separations in both designs by indicator, median over channels, best first: `others` then `same`."""
    names = list(dict.fromkeys(result.indicator for result in found)) if states else []
    values = {name: _medians(found, name, states) for name in names}
    shown = sorted(names, key=lambda name: -_mean(values[name][: len(states)]))[:ROWS_SHOWN]
    return {name: values[name] for name in shown}


def _medians(found: Sequence[IndicatorResult], name: str, states: tuple[str, ...]) -> list[float]:
    """Return the median over channels of the separations, turned so that 1 is perfect."""
    rows = [result for result in found if result.indicator == name]
    medians = []
    for design in ("others", "same"):
        for state in states:
            turned = [0.5 + r.direction * (getattr(r, design)[state].separation.value - 0.5) for r in rows]
            defined = [value for value in turned if math.isfinite(value)]
            medians.append(float(np.median(defined)) if defined else math.nan)
    return medians


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if all(map(math.isfinite, values)) else -math.inf


def severity_figure(
    matrix: FeatureMatrix,
    shown: Sequence[IndicatorResult],
    states: tuple[str, ...],
    healthy: tuple[str, ...],
    channels: Mapping[str, ShownQuantity],
) -> Figure:
    """Return each indicator over the states: median and 5 to 95 % of the records, and every specimen as a thin line.

    `channels` says what channels hold; the unit of each indicator stands at its axis.
    """
    rows = (len(shown) + 1) // 2
    figure, axes = new_figure(rows, 2, height_in=0.8 + 1.6 * rows, sharex=True)
    ladder = (*healthy, *states)
    for axis, result in zip(axes.ravel(), shown, strict=False):
        values = matrix.values[:, matrix.names.index(result.column)]
        _draw_ladders(axis, matrix.labels, values, ladder)
        position = [k for k, state in enumerate(ladder) if np.isfinite(values[matrix.labels["state"] == state]).any()]
        limits = [np.nanquantile(values[matrix.labels["state"] == ladder[k]], [0.05, 0.5, 0.95]) for k in position]
        low, middle, high = np.array(limits).T
        axis.fill_between(position, low, high, color="#1f6f8b", alpha=0.18, linewidth=0)
        axis.plot(position, middle, color="#b01e3c", linewidth=1.8, marker="o", markersize=4)
        if np.nanmin(values) > 0 and np.nanmax(values) > 30 * np.nanmin(values):
            axis.set_yscale("log")
        axis.set_title(panel_title(result.column, result.gears), loc="left", fontsize=7)
        axis.set_ylabel(f"[{_unit(result, channels)}]", fontsize=7)
        state_ticks(axis, ladder, fontsize=8 if len(ladder) <= CROWDED else 7)
    for axis in axes.ravel()[len(shown) :]:
        axis.set_visible(False)
    return figure


def _unit(result: IndicatorResult, channels: Mapping[str, ShownQuantity]) -> str:
    """Return the unit of an indicator: that of its channel for levels and amplitudes, - for ratios."""
    known = known_column(result.column, result.gears)
    if known is None or not known.entry.unit:
        return "-"
    return channels[result.channel].unit if known.entry.unit == OF_CHANNEL else known.entry.unit


def _draw_ladders(axis: Any, labels: dict[str, np.ndarray], values: np.ndarray, ladder: tuple[str, ...]) -> None:
    """Draw the mean of every specimen over the states."""
    for specimen in np.unique(labels["specimen_id"])[:60]:
        own = labels["specimen_id"] == specimen
        means = []
        for state in ladder:
            chosen = values[own & (labels["state"] == state)]
            defined = chosen[np.isfinite(chosen)]
            means.append(float(defined.mean()) if defined.size else np.nan)
        axis.plot(range(len(ladder)), means, color="#8a97a3", linewidth=0.5, alpha=0.7)


def detection_figure(
    matrix: FeatureMatrix, records: JudgedRecords, shown: Sequence[IndicatorResult], false_alarms: float
) -> Figure | None:
    """Return the share of alarms over the damaged area, between other specimens, with intervals; None without data."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    figure, axes = new_figure(height_in=3.4)
    axis, drawn = axes[0, 0], 0
    healthy = matrix.labels["fault"] == HEALTHY
    for colour, marker, result in zip(CURVE_COLOURS, MARKERS, shown, strict=False):
        values = result.direction * matrix.values[:, matrix.names.index(result.column)]
        kept = np.isfinite(values)
        area = matrix.labels[SIZES["area_mm2"]]
        curve = detection_curve(values[kept], healthy[kept], area[kept], records.weights[:, kept], false_alarms)
        if curve is None:
            continue
        drawn += 1
        low, high = np.quantile(curve.share[1:], [0.025, 0.975], axis=0)
        axis.fill_between(curve.size, low, high, color=colour, alpha=0.12, linewidth=0)
        axis.plot(
            curve.size,
            curve.share[0],
            color=colour,
            marker=marker,
            markersize=4,
            label=panel_title(result.column, result.gears, LEGEND_SIGNS),
        )
    if not drawn:
        return None
    for level in (0.5, 0.9):
        axis.axhline(level, color="#8a97a3", linestyle=":", linewidth=0.9)
    axis.axhline(false_alarms, color="#8a97a3", linestyle="--", linewidth=0.9)
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda size, _: f"{size:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_ylim(0.0, 1.03)
    axis.set_xlabel("Damaged area [mm²]")
    axis.set_ylabel("Share of alarms [-]")
    figure.legend(loc="outside lower center", ncols=1, fontsize=8)
    return figure
