"""Figures of scores: values with intervals, the permutation control."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.judging.judgement import TITLES, Judged
from diagnostics.judging.of_split import Training
from diagnostics.page.style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ACCURACY_COLOUR, AREA_COLOUR, CHANCE_COLOUR = "#1f6f8b", "#b01e3c", "#8a97a3"


def score_figure(training: Training) -> Figure:
    """Return accuracy and macro-AUROC of every classifier with intervals; dashed lines are chance."""
    figure, axes = new_figure(1, 2, height_in=0.95 + 0.5 * len(training.judged), sharey=True)
    chance = training.judged[0].scores.guess
    panels = (("Accuracy [-]", ACCURACY_COLOUR, chance), ("Macro-AUROC [-]", AREA_COLOUR, 0.5))
    for axis, (title, colour, level) in zip(axes[0], panels, strict=True):
        axis.axvline(level, color=CHANCE_COLOUR, linestyle="--", linewidth=1.0)
        for row, judged in enumerate(training.judged):
            found = judged.scores.accuracy if axis is axes[0, 0] else judged.scores.macro_auroc
            axis.plot(
                [found.low, found.high], [row, row], color=colour, linewidth=2.5, alpha=0.5, solid_capstyle="butt"
            )
            axis.plot(found.value, row, marker="o", markersize=6, color=colour)
        axis.set_xlim(0.0, 1.03)
        axis.set_xlabel(title)
    axes[0, 0].set_yticks(range(len(training.judged)), [_name(judged) for judged in training.judged], fontsize=9)
    axes[0, 0].set_ylim(len(training.judged) - 0.5, -0.5)
    return figure


def _name(judged: Judged) -> str:
    return "\n".join(textwrap.wrap(TITLES[judged.name], 18))


def permutation_figure(training: Training) -> Figure:
    """Return macro-AUROC after training on permuted labels (dots) beside the true one (diamond)."""
    shown = [judged for judged in training.judged if judged.permuted_auroc.size]
    figure, axes = new_figure(height_in=1.2 + 0.55 * len(shown))
    axis = axes[0, 0]
    axis.axvline(0.5, color=CHANCE_COLOUR, linestyle="--", linewidth=1.0, label="chance")
    for row, judged in enumerate(shown):
        areas = judged.permuted_auroc
        spread = 0.35 * (np.arange(areas.size) / max(areas.size - 1, 1) - 0.5) if areas.size > 1 else np.zeros(1)
        label = ("permuted labels", "true labels") if row == 0 else (None, None)
        axis.plot(areas, row + spread, linestyle="none", marker="o", markersize=4, color=CHANCE_COLOUR, label=label[0])
        value = judged.scores.macro_auroc.value
        axis.plot(value, row, linestyle="none", marker="D", markersize=7, color=AREA_COLOUR, label=label[1])
    axis.set_xlim(0.0, 1.03)
    axis.set_ylim(len(shown) - 0.5, -0.5)
    axis.set_yticks(range(len(shown)), [_name(judged) for judged in shown], fontsize=9)
    axis.set_xlabel("Macro-AUROC on test specimens [-]")
    figure.legend(loc="outside upper center", ncols=3, fontsize=9)
    return figure
