"""One look for all figures: narrow enough for a phone, one colour per state, light grid, sidebands marked.

Labels of logarithmic axes are plain text: figures parse no formulas, so that a dollar sign in a name begins none.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import LogFormatterMathtext, LogFormatterSciNotation

from diagnostics.records.gear_train import GearMesh, Planets

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from diagnostics.signal.spectrum import OrderSpectrum

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

    from diagnostics.page.style import write_powers

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


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


LABELLED = (1, 2, 4, 10)
"""Multiples of a power that have labels, where matplotlib gives some: all of its own overlap in flat panels."""


class PowerLabels(LogFormatterSciNotation):
    """Powers of ten with raised digits, at the places where matplotlib would write a formula."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return the label of one tick: 10⁻², 2×10³, or nothing."""
        if x > 0.0 and round(x / 10.0 ** math.floor(math.log10(x))) not in LABELLED:
            return ""
        formula = super().__call__(x, pos)
        text = re.sub(r"\^\{(-?\d+)\}", lambda power: power[1].translate(RAISED), formula)
        return re.sub(r"\\mathdefault|[${}]", "", text.replace(r"\times", "×"))


def write_powers(figure: Figure) -> None:
    """Replace the formulas that logarithmic axes are labelled with by default; labels of one's own stay."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_formatter(), LogFormatterMathtext):
                axis.set_major_formatter(PowerLabels())
            if isinstance(axis.get_minor_formatter(), LogFormatterMathtext):
                axis.set_minor_formatter(PowerLabels(labelOnlyBase=False))


PASSING = "passing planets"
MARKS = (("v", PINION_COLOUR), ("|", GEAR_COLOUR), ("^", "#6a1b6e"))
"""Marker and colour of the first, the second and the third kind of sidebands."""
ABOVE = 1.9
"""Marks stand so many times as high as their lines."""


def order_words(mesh: GearMesh) -> str:
    """Return what the orders of a mesh's spectra count."""
    return (
        f"{mesh.names.gears[0]} orders"
        if mesh.planets is None
        else f"orders of the {mesh.names.gears[0]} against the carrier"
    )


def sideband_places(mesh: GearMesh, harmonic: int, count: int) -> dict[str, np.ndarray]:
    """Return the sidebands 1 ... count on both sides of a mesh harmonic by what has them, as offsets in orders.

    Of a planetary set: lines of healthy planets, and those that a tooth of the sun or of one planet adds, through the
    path's mean and the orders of the carrier that are next to it.
    """
    steps = np.array([k for k in range(-count, count + 1) if k], dtype=np.float64)
    if mesh.planets is None:
        driver, driven = mesh.names.gears
        return {driver: steps, driven: steps * (mesh.teeth[0] / mesh.teeth[1])}
    return _of_planets(mesh.names.gears, mesh.planets, harmonic, steps)


def _of_planets(gears: tuple[str, ...], planets: Planets, harmonic: int, steps: np.ndarray) -> dict[str, np.ndarray]:
    sun, planet, ring = planets.teeth
    step, carrier = planets.passing, sun / ring
    of_sun = harmonic * sun + steps
    through = of_sun - np.round(of_sun / step) * step  # the order of the path that equal planets leave
    nearest = np.round(harmonic * ring / step) * step - harmonic * ring
    paths = np.arange(-(len(planets.places) // 2), len(planets.places) // 2 + 1)
    of_planet = (steps[:, None] * (ring / planet) + paths).ravel()
    passing = nearest + step * np.concatenate([[0.0], steps])
    return {gears[0]: steps + through * carrier, PASSING: passing * carrier, gears[1]: of_planet * carrier}


ORDERS_SHOWN, SIDEBANDS, DECADES_SHOWN = 4.6, 4, 5.0
"""On each side of a mesh line, and of amplitudes below the largest."""
BEHIND_COLOUR, LOWEST = "#b9c4cd", 1e-12
"""Of the healthy record behind a damaged one, and where its area begins, below every figure."""


def draw_mesh_line(
    axis: Any, spectrum: OrderSpectrum, mesh: GearMesh, harmonic: int, colour: str, behind: OrderSpectrum | None = None
) -> float:
    """Draw a spectrum about a mesh harmonic, over another one, its sidebands marked; return the largest amplitude."""
    axis.set_yscale("log")
    largest = 0.0
    if behind is not None:
        offset, amplitude = _around(behind, mesh, harmonic)
        largest = float(amplitude.max())
        axis.fill_between(offset, amplitude, np.full_like(amplitude, LOWEST), color=BEHIND_COLOUR, linewidth=0)
    offset, amplitude = _around(spectrum, mesh, harmonic)
    axis.semilogy(offset, amplitude, color=colour)
    reach = 1.5 / spectrum.revolutions
    for (marker, shade), lines in zip(MARKS, sideband_places(mesh, harmonic, SIDEBANDS).values(), strict=False):
        height = np.array([amplitude[np.abs(offset - line) <= reach].max(initial=1e-30) for line in lines])
        axis.plot(lines, ABOVE * height, linestyle="none", marker=marker, markersize=4.5, color=shade)
    return max(largest, float(amplitude.max(initial=1e-30)))


def _around(spectrum: OrderSpectrum, mesh: GearMesh, harmonic: int) -> tuple[np.ndarray, np.ndarray]:
    """Return offset from a mesh harmonic [orders] and amplitude, (n,) each."""
    centre = harmonic * mesh.teeth[0]
    near = np.abs(spectrum.order - centre) <= ORDERS_SHOWN
    return spectrum.order[near] - centre, spectrum.amplitude_m_s2[near]


def frame_mesh_lines(axis: Any, largest: float) -> None:
    """Limit the axes of drawn mesh lines, by the largest amplitude of all."""
    axis.set_ylim(2.0 * largest / 10**DECADES_SHOWN, 4.0 * largest)
    axis.set_xlim(-ORDERS_SHOWN, ORDERS_SHOWN)


def mark_handles(mesh: GearMesh) -> list[Any]:
    """Return what a legend shows of the marks."""
    from matplotlib.lines import Line2D

    names = sideband_places(mesh, 1, 1)
    return [
        Line2D(
            [], [], linestyle="none", marker=marker, markersize=4.5 if marker != "|" else 6, color=colour,
            label=name if name == PASSING else f"{name} sidebands",
        )
        for (marker, colour), name in zip(MARKS, names, strict=False)
    ]  # fmt: skip
