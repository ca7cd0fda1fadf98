"""One gearbox over its life as a figure: its flank in pictures, what shows damage, remaining life beside the truth."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from diagnostics.page.style import WIDTH_IN, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = 5
HEIGHT_IN = 4.6
COLOURS = ("#1f6f8b", "#b01e3c", "#e3a21a", "#6a1b6e")
TRUTH_COLOUR, BAND_COLOUR, MARK_COLOUR = "#1c2733", "#8a97a3", "#5b6b7b"
LOWEST = 0.1
"""Of an index over its limit that is drawn; below it nothing is told apart."""


@dataclass(frozen=True, slots=True)
class FlankPicture:
    """The flank of the tooth that fails, as a camera saw it."""

    age_h: float
    share: float
    png: bytes


@dataclass(frozen=True, slots=True)
class UnitLife:
    """One gearbox at its inspections.

    Attributes
    ----------
    specimen : int
    age_h : (n,) float64
    watches : mapping of str to ((n,) float64, float)
        What shows damage: its index over its limit, and the age at which it is detected; NaN where it is not.
    marks_h : mapping of str to float
        Ages of its ends.
    pictures : sequence of FlankPicture
    end_h : float
        At which it fails, or would have.
    predicted_h : mapping of str to (n, 3) float64
        Quantiles of the remaining life, by what is known.
    """

    specimen: int
    age_h: np.ndarray
    watches: Mapping[str, tuple[np.ndarray, float]]
    marks_h: Mapping[str, float]
    pictures: Sequence[FlankPicture]
    end_h: float
    predicted_h: Mapping[str, np.ndarray]


def life_figure(unit: UnitLife) -> Figure:
    """Return the figure: pictures above, indices over age, remaining life over age."""
    from matplotlib.figure import Figure

    with styled():
        figure = Figure(figsize=(WIDTH_IN, HEIGHT_IN), layout="constrained")
        grid = figure.add_gridspec(3, PICTURES, height_ratios=[0.75, 1.2, 1.2])
        _draw_pictures(figure, grid, unit)
        indices = figure.add_subplot(grid[1, :])
        remaining = figure.add_subplot(grid[2, :], sharex=indices)
        _draw_indices(indices, unit)
        _draw_remaining(remaining, unit)
    return figure


def _draw_pictures(figure: Figure, grid: Any, unit: UnitLife) -> None:
    from matplotlib.image import imread

    count = len(unit.pictures)
    chosen = np.unique(np.linspace(0, count - 1, min(count, PICTURES)).round().astype(int)).tolist()
    for place, number in enumerate(chosen):
        one, axis = unit.pictures[number], figure.add_subplot(grid[0, place])
        axis.imshow(imread(io.BytesIO(one.png), format="png"), cmap="gray", vmin=0.0, vmax=1.0)
        axis.set_title(f"{one.age_h:.0f} h, {100.0 * one.share:.1f} %", fontsize=8)
        axis.set_xticks([])
        axis.set_yticks([])
        axis.grid(visible=False)


def _draw_indices(axis: Any, unit: UnitLife) -> None:
    axis.axhline(1.0, color=MARK_COLOUR, linestyle=":", linewidth=1.0)
    for colour, (name, (index, detected_h)) in zip(COLOURS, unit.watches.items(), strict=False):
        axis.plot(unit.age_h, np.maximum(index, LOWEST), color=colour, marker="o", markersize=3, label=name)
        if np.isfinite(detected_h):
            at = float(np.maximum(index[unit.age_h == detected_h], LOWEST)[0])
            axis.plot(detected_h, at, color=colour, marker="D", markersize=8, fillstyle="none", linestyle="none")
    axis.set_yscale("log")
    axis.set_ylabel("Index / limit [-]")
    axis.tick_params(labelbottom=False)
    axis.legend(loc="upper left", fontsize=7)
    _draw_marks(axis, unit, named=True)


def _draw_remaining(axis: Any, unit: UnitLife) -> None:
    for (name, values), colour in zip(unit.predicted_h.items(), (COLOURS[0], BAND_COLOUR), strict=False):
        low, middle, high = np.maximum(values, 0.0).T
        axis.fill_between(unit.age_h, low, high, color=colour, alpha=0.2, linewidth=0)
        axis.plot(unit.age_h, middle, color=colour, marker="o", markersize=3, label=name)
    axis.plot([0.0, unit.end_h], [unit.end_h, 0.0], color=TRUTH_COLOUR, linestyle="--", label="true")
    axis.set_ylim(bottom=0.0)
    axis.set_xlim(left=0.0)
    axis.set_xlabel("Age [h]")
    axis.set_ylabel("Remaining life [h]")
    axis.legend(loc="upper right", fontsize=7)
    _draw_marks(axis, unit, named=False)


def _draw_marks(axis: Any, unit: UnitLife, *, named: bool) -> None:
    for name, age_h in unit.marks_h.items():
        axis.axvline(age_h, color=MARK_COLOUR, linewidth=0.8)
        if named:
            axis.text(
                age_h, 1.01, name, transform=axis.get_xaxis_transform(), fontsize=7, ha="center", va="bottom",
                color=MARK_COLOUR,
            )  # fmt: skip
