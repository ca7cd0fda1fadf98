"""Scores as rows, each with its limits, what chance gives and the difference to what it is compared with; as a figure.

The figure has a panel for every task, measure and part of the records, a line for every classifier.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from diagnostics.base.extras import require_packages
from diagnostics.judging.judgement import TITLES
from diagnostics.statistics.evaluation import Interval

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LINE_INCHES, HEAD_INCHES, WIDTH_INCHES = 0.22, 0.75, 7.0


@dataclass(frozen=True, slots=True)
class ScoreRow:
    """One score.

    Attributes
    ----------
    task, measure, records, name : str
        What was asked, how it was measured, on which records, and whose predictions they are.
    score : Interval
        With 95 % limits over gearboxes.
    chance : float
        What an answer without knowledge reaches.
    difference : Interval or None
        The first predictions minus these, on the same resampled gearboxes; None for the first themselves.
    falls : bool
        Whether less is better.
    """

    task: str
    measure: str
    records: str
    name: str
    score: Interval
    chance: float
    difference: Interval | None
    falls: bool = False


def score_figure(scores: Sequence[ScoreRow]) -> Figure:
    """Return the figure; chance is a dotted line.

    Raises
    ------
    UsageError
        If matplotlib is missing.
    """
    require_packages("a figure", "matplotlib")
    from matplotlib.figure import Figure

    blocks: dict[tuple[str, str, str], list[ScoreRow]] = {}
    for row in scores:
        blocks.setdefault((row.task, row.measure, row.records), []).append(row)
    heights = [HEAD_INCHES + LINE_INCHES * len(rows) for rows in blocks.values()]
    figure = Figure(figsize=(WIDTH_INCHES, sum(heights)), layout="constrained")
    panels = figure.subplots(len(blocks), 1, squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
    for axes, (title, rows) in zip(panels, blocks.items(), strict=True):
        _panel(axes, title, rows)
    return figure


def _panel(axes: Axes, title: tuple[str, str, str], rows: list[ScoreRow]) -> None:
    for place, row in enumerate(rows):
        colour = "C0" if row.difference is None else "0.4"
        axes.plot([row.score.low, row.score.high], [place, place], color=colour, linewidth=1.5)
        axes.plot(row.score.value, place, "o", color=colour, markersize=4)
    axes.axvline(rows[0].chance, color="0.6", linestyle=":", linewidth=1.0)
    axes.set_yticks(range(len(rows)), [TITLES.get(row.name, row.name) for row in rows], fontsize=8)
    axes.set_ylim(len(rows) - 0.5, -0.5)
    task, measure, records = title
    less = ", less is better" if rows[0].falls else ""
    axes.set_title(f"{task}: {measure}, {records}{less}", fontsize=9, loc="left")
    axes.tick_params(axis="x", labelsize=8)
