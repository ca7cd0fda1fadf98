"""One look for all figures: narrow enough for a phone, one colour per state, light grid."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH_IN = 4.8
"""At this width a phone shows 10-point text at the size of the captions, and half a printed page at 7 points."""

DOTS_PER_INCH = 200
PALETTE = 128
"""Colours of a picture, chosen to cover those of heat maps within 8 % too; a quarter of the bytes of all colours."""

SLANTED = 6
"""From so many names on they stand slanted below an axis."""

HEALTHY_COLOUR = "#5b6b7b"
FAULT_COLOURS = ("#e3a21a", "#d9622b", "#b01e3c", "#6a1b6e", "#2c1e55")
PINION_COLOUR, GEAR_COLOUR = "#b01e3c", "#1f6f8b"
SETTINGS = {
    "font.size": 10,
    "text.parse_math": False,  # a dollar sign in a name begins no formula
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
    return dict.fromkeys(healthy, HEALTHY_COLOUR) | dict(zip(faulty, fault_colours(len(faulty)), strict=True))


def fault_colours(count: int) -> tuple[str, ...]:
    """Return colours from light to dark, an order that is seen without colour too; blends where many."""
    if count <= len(FAULT_COLOURS):
        return FAULT_COLOURS[:count]
    known = np.array([[int(colour[start : start + 2], 16) for start in (1, 3, 5)] for colour in FAULT_COLOURS])
    places = np.linspace(0.0, len(FAULT_COLOURS) - 1.0, count)
    blends = np.stack([np.interp(places, np.arange(len(FAULT_COLOURS)), channel) for channel in known.T], axis=1)
    return tuple("#" + "".join(f"{round(value):02x}" for value in blend) for blend in blends)


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
    """Return the figure as PNG with a palette of its own colours."""
    from PIL import Image

    from diagnostics.page.power_labels import write_powers

    write_powers(figure)
    drawn = io.BytesIO()
    stream = io.BytesIO()
    with styled():
        # packed once, with its palette
        figure.savefig(drawn, format="png", dpi=DOTS_PER_INCH, pil_kwargs={"compress_level": 0})
    picture = Image.open(drawn).convert("RGB")
    small = picture.quantize(PALETTE, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    small.save(stream, format="png", optimize=True)
    return stream.getvalue()


def state_ticks(axis: Axes, names: Sequence[str], **text: Any) -> None:
    """Name the places 0, 1, ... along the bottom; many or long names stand slanted."""
    slanted = len(names) >= SLANTED or sum(map(len, names)) > 40
    turned: dict[str, Any] = {"rotation": 50, "rotation_mode": "anchor"} if slanted else {}
    axis.set_xticks(range(len(names)), names, ha="right" if slanted else "center", **turned, **text)
