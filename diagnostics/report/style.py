"""One look for all figures: narrow enough for a phone, one colour per state, light grid."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN = 5.6
"""At this width a phone shows 10-point text at a readable size."""

DOTS_PER_INCH = 170
HEALTHY_COLOUR = "#5b6b7b"
FAULT_COLOURS = ("#e3a21a", "#d9622b", "#b01e3c", "#6a1b6e", "#2c1e55")
PINION_COLOUR, GEAR_COLOUR = "#b01e3c", "#1f6f8b"
SETTINGS = {
    "font.size": 10,
    "axes.titlesize": 10,
    "axes.labelsize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dde3e8",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 0.9,
}


def state_colours(states: tuple[str, ...], healthy: set[str]) -> dict[str, str]:
    """Return a colour per state: grey for healthy ones, warmer and darker with the order of the others."""
    faulty = [state for state in states if state not in healthy]
    last = len(FAULT_COLOURS) - 1
    return dict.fromkeys(healthy, HEALTHY_COLOUR) | {
        state: FAULT_COLOURS[min(position, last)] for position, state in enumerate(faulty)
    }


def new_figure(rows: int = 1, columns: int = 1, height_in: float = 3.2, **shared: Any) -> tuple[Figure, Any]:
    """Return a figure of the common width and its axes as a (rows, columns) array."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH_IN, height_in), layout="constrained")
    return figure, figure.subplots(rows, columns, squeeze=False, **shared)


def styled() -> AbstractContextManager[None]:
    """Return a context in which figures are drawn and written in the common look."""
    import matplotlib as mpl

    return mpl.rc_context(SETTINGS)


def png_bytes(figure: Figure) -> bytes:
    """Return the figure as PNG."""
    stream = io.BytesIO()
    with styled():
        figure.savefig(stream, format="png", dpi=DOTS_PER_INCH)
    return stream.getvalue()


def state_ticks(axis: Axes, names: Sequence[str]) -> None:
    """Name the places 0, 1, ... along the bottom; many names stand slanted."""
    many = len(names) > 5
    axis.set_xticks(range(len(names)), names, rotation=50 if many else 0, ha="right" if many else "center")
