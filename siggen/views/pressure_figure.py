"""The picture of `siggen inspect pressure`: pressure over a flank with its damage, load per length across the face."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from siggen.views.face_pressure import FacePressure
from siggen.views.picture_file import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("C2", "C3", "tab:purple", "tab:brown", "tab:pink", "tab:cyan")
"""Of the positions that are drawn one by one; as many of them at most."""


def chosen_positions(pressure: FacePressure) -> list[int]:
    """Return a quarter of the engagement, three quarters, and where the pressure is largest."""
    worst = int(np.argmax(_finite(pressure).max(axis=1)))
    count = pressure.roll_deg.size
    return sorted({count // 4, worst, 3 * count // 4})


def pressure_figure(pressure: FacePressure, positions: Sequence[int]) -> Figure:
    """Return the figure; the lines across the face are those of the positions."""
    from matplotlib.figure import Figure

    view = pressure.view
    figure = Figure(figsize=(12.5, 7.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2.1, 1.0), height_ratios=(1.15, 1.0))
    flank = figure.add_subplot(grid[0, 0])
    along = figure.add_subplot(grid[0, 1], sharey=flank)
    across = figure.add_subplot(grid[1, 0], sharex=flank)
    course = figure.add_subplot(grid[1, 1])
    _draw_flank(figure, flank, pressure, positions)
    _draw_along(along, pressure, positions)
    _draw_across(across, pressure, positions)
    _draw_course(course, pressure, positions)
    figure.suptitle(
        f"{view.state}: {view.gear} tooth {view.tooth} at {pressure.point.torque_nm:.3g} N m, "
        f"{pressure.point.speed_hz:.3g} Hz\n{largest_text(pressure)}",
        fontsize=10,
    )
    return figure


def largest_text(pressure: FacePressure) -> str:
    """Return the largest elastic pressures in words: Hertz's, and that at the edges of damage with their radius."""
    plain = float(pressure.pressure_mpa[pressure.at_edge == 0.0].max(initial=0.0))
    text = f"largest Hertz pressure {plain:,.0f} MPa"
    if not pressure.at_edge.any():
        return text
    worst = float(pressure.pressure_mpa[pressure.at_edge > 0.0].max())
    if np.isinf(worst):
        return f"{text}; edges of damage are sharp, so elastic pressure has no bound there"
    return (
        f"{text}; largest elastic pressure at edges of {pressure.edge_radius_mm:.3g} mm radius {worst:,.0f} MPa "
        "(steel yields below)"
    )


def save_pressure_figure(pressure: FacePressure, positions: Sequence[int], path: Path) -> None:
    """Draw the pressure into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the file cannot be drawn.
    """
    save_figure(lambda: pressure_figure(pressure, positions), path, dpi=120)


def _finite(pressure: FacePressure) -> np.ndarray:
    return np.where(np.isfinite(pressure.pressure_mpa), pressure.pressure_mpa, 0.0)


def _draw_flank(figure: Figure, axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    from matplotlib.colors import PowerNorm
    from matplotlib.patches import Polygon

    view, values = pressure.view, _finite(pressure)
    # Edges press several times harder than land: the root keeps both readable.
    norm = PowerNorm(0.5, 0.0, values.max() or 1.0)
    loaded = np.ma.masked_equal(values, 0.0)
    image = axis.pcolormesh(
        pressure.face_mm, pressure.arc_mm, loaded, norm=norm, cmap="magma_r", shading="nearest", rasterized=True
    )
    figure.colorbar(image, ax=axis, label="largest pressure [MPa]", location="top", aspect=45, shrink=0.9)
    for corners in view.outlines_mm:
        axis.add_patch(Polygon(corners, closed=True, fc="none", ec="C5", lw=1.4))
    axis.axhline(view.pitch_mm, color="tab:cyan", lw=1.0, ls="-.")
    axis.annotate("pitch line", (0.1, view.pitch_mm), fontsize=8, color="C2", va="bottom")
    for colour, at in zip(COLOURS, positions, strict=False):
        axis.axhline(float(pressure.arc_mm[at]), color=colour, lw=1.0, ls="--")
    axis.set_xlim(0.0, view.face_width_mm)
    axis.set_ylim(float(pressure.arc_mm.min()), float(pressure.arc_mm.max()))
    axis.set_xlabel("across the face [mm]")
    axis.set_ylabel("arc above the base circle [mm]")
    axis.set_title("pressure while the tooth goes through mesh; white: no load; green: damage", fontsize=10)


def _draw_along(axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    values = _finite(pressure)
    axis.plot(np.where(pressure.at_edge > 0.0, 0.0, values).max(axis=1), pressure.arc_mm, color="0.3", label="Hertz")
    if pressure.at_edge.any():
        edges = np.where(pressure.at_edge > 0.0, values, np.nan)
        worst = np.where(pressure.at_edge.any(axis=1), np.nan_to_num(edges).max(axis=1), np.nan)
        label = f"edges of {pressure.edge_radius_mm:.3g} mm"
        axis.plot(worst, pressure.arc_mm, color="C6", label=label)
    for colour, at in zip(COLOURS, positions, strict=False):
        axis.axhline(float(pressure.arc_mm[at]), color=colour, lw=1.0, ls="--")
    axis.set_xlim(left=0.0)
    axis.set_xlabel("largest pressure across the face [MPa]")
    axis.set_ylabel("arc above the base circle [mm]")
    axis.locator_params(axis="x", nbins=5)
    axis.legend(fontsize=8, loc="best")


def _draw_across(axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    for colour, at in zip(COLOURS, positions, strict=False):
        label = f"{pressure.roll_deg[at]:.1f}°, {pressure.force_n[at]:,.0f} N"
        label += f", tilt {1e6 * pressure.tilt_rad[at]:+.1f} µrad" if np.any(pressure.tilt_rad) else ""
        axis.plot(pressure.face_mm, pressure.line_load_n_per_mm[at], color=colour, label=label)
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("across the face [mm]")
    axis.set_ylabel("load per length [N/mm]")
    axis.legend(fontsize=8, title_fontsize=8, title="angle of the driving gear since first contact, force of the pair")


def _draw_course(axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    axis.plot(pressure.roll_deg, pressure.force_n, color="0.3")
    for colour, at in zip(COLOURS, positions, strict=False):
        axis.axvline(float(pressure.roll_deg[at]), color=colour, lw=1.0, ls="--")
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("angle of the driving gear since first contact [°]")
    axis.set_ylabel("force of the pair in the record [N]")
