"""The picture of `siggen inspect tvms`: mesh stiffness of all states, its loss, and the parts of one pair."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from siggen.views.picture_file import check_picture_file, save_figure
from siggen.views.stiffness_curves import StiffnessCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["check_picture_file", "save_stiffness_figure", "stiffness_figure"]

COLOURS, DASHES = 10, ("-", "--", ":")
"""Each ten states have a dash of their own, so that no two of thirty look alike."""
NOT_USED = "by potential energy,\nnot used by this set"
SHADES = ("Blues", "Greens")
"""Of the driver and of the driven gear."""


def stiffness_figure(
    curves: Sequence[StiffnessCurve], *, parts: bool = False, potential_energy: bool = False, title: str = ""
) -> Figure:
    """Return the figure; the loss is drawn against the first curve, which is the healthy one where there is one.

    Where damage acts as geometry, panels show sink and land of the first damaged tooth's pair, and `potential_energy`
    adds the dotted curves that the simulation does not use. With `parts` the last panel stacks the compliances of the
    pair that carries the first damaged tooth, in the last state.
    """
    from matplotlib.figure import Figure

    simulated = any(curve.simulated is not None for curve in curves)
    has_land = any(c.simulated is not None and np.isfinite(c.simulated.land_share).any() for c in curves)
    panels = {"stiffness": 3, "loss": 2} | ({"sink": 2} if simulated else {})
    panels |= ({"land": 2} if has_land else {}) | ({"parts": 3} if parts else {})
    figure = Figure(figsize=(8.0, 1.0 + sum(panels.values())), layout="constrained")
    axes = dict(
        zip(panels, figure.subplots(len(panels), 1, sharex=True, height_ratios=list(panels.values())), strict=True)
    )
    for depth, curve in enumerate(curves):  # milder states lie on top: where curves agree, the mildest is seen
        style: dict[str, Any] = {"color": f"C{depth % COLOURS}", "ls": DASHES[depth // COLOURS % len(DASHES)]}
        style |= {"lw": 1.2, "zorder": 2 + len(curves) - depth}
        _draw_curve(axes, curve, curves[0], style)
    axes["stiffness"].set_ylabel("mesh stiffness [10⁸ N/m]")
    axes["stiffness"].set_title(title, fontsize=10)
    figure.legend(
        *axes["stiffness"].get_legend_handles_labels(),
        loc="outside upper center", frameon=False, ncols=min(len(curves), 5),
    )  # fmt: skip
    if potential_energy and simulated:
        _draw_potential_energy(axes["stiffness"], curves)
    axes["loss"].set_ylabel(f"loss against {curves[0].state} [%]")
    axes["loss"].margins(x=0)
    if simulated:
        axes["sink"].set_ylabel("sink of the\ndamaged pair [µm]")
    if has_land:
        axes["land"].set_ylabel("land of the\ndamaged pair [% of face]")
    if parts:
        _stack(axes["parts"], curves[-1])
    list(axes.values())[-1].set_xlabel("angle of the driving gear since the first damaged tooth entered contact [°]")
    return figure


def _draw_potential_energy(axis: Axes, curves: Sequence[StiffnessCurve]) -> None:
    for depth, curve in enumerate(curves):
        if curve.simulated is not None:
            energy = curve.simulated.potential_energy_n_per_m / 1e8
            (line,) = axis.plot(
                np.degrees(curve.angle_rad), energy, color=f"C{depth % COLOURS}", ls=":", lw=0.9, zorder=1.9
            )
    axis.legend([line], [NOT_USED], loc="lower left", frameon=False, fontsize=8)


def _draw_curve(
    axes: Mapping[str, Axes], curve: StiffnessCurve, reference: StiffnessCurve, style: Mapping[str, Any]
) -> None:
    degrees = np.degrees(curve.angle_rad)
    axes["stiffness"].plot(degrees, curve.mesh_stiffness_n_per_m / 1e8, label=curve.state, **style)
    if curve is not reference:
        loss = 1.0 - curve.mesh_stiffness_n_per_m / reference.mesh_stiffness_n_per_m
        axes["loss"].plot(degrees, 100.0 * loss, **style)
    if curve.simulated is not None:
        axes["sink"].plot(degrees, curve.simulated.sink_um, **style)
        if "land" in axes:
            axes["land"].plot(degrees, 100.0 * curve.simulated.land_share, **style)


def _stack(axis: Axes, curve: StiffnessCurve) -> None:
    from matplotlib import colormaps

    inside = ~np.isnan(curve.parts_m_per_n["contact"])
    names = list(curve.parts_m_per_n)  # those of both teeth, and the contact
    shades = [0.75, 0.55, 0.4, 0.25]
    colours = [*(colormaps[colour](shade) for colour in SHADES for shade in shades), "C6"]
    layers = [1e9 * curve.parts_m_per_n[name][inside] for name in names]
    axis.stackplot(np.degrees(curve.angle_rad[inside]), layers, labels=names, colors=colours)
    axis.set_ylabel(f"compliance of the damaged\ntooth's pair, {curve.state} [10⁻⁹ m/N]")
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=8)


def save_stiffness_figure(curves: Sequence[StiffnessCurve], path: Path, **options: Any) -> None:
    """Draw the curves into a file; options as those of `stiffness_figure`.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: stiffness_figure(curves, **options), path)
