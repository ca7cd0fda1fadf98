"""The picture of `siggen tvms`: mesh stiffness of all states, its loss against healthy, and the parts of one pair."""

from __future__ import annotations

from collections.abc import Sequence
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
SHADES = {"pinion": "Blues", "gear": "Greens"}


def stiffness_figure(curves: Sequence[StiffnessCurve], *, parts: bool = False) -> Figure:
    """Return the figure; the loss is drawn against the first curve, which is the healthy one where there is one.

    With `parts` a third panel stacks the compliances of the pair that carries the first damaged tooth, in the last
    state.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 9.0 if parts else 6.0), layout="constrained")
    ratios = (3, 2, 3) if parts else (3, 2)
    axes = figure.subplots(len(ratios), 1, sharex=True, height_ratios=ratios)
    above, below = axes[0], axes[1]
    reference = curves[0]
    for depth, curve in enumerate(curves):  # milder states lie on top: where curves agree, the mildest is seen
        degrees = np.degrees(curve.angle_rad)
        style: dict[str, Any] = {"color": f"C{depth % COLOURS}", "ls": DASHES[depth // COLOURS % len(DASHES)]}
        style |= {"lw": 1.2, "zorder": 2 + len(curves) - depth}
        above.plot(degrees, curve.mesh_stiffness_n_per_m / 1e8, label=curve.state, **style)
        if curve is not reference:
            loss = 1.0 - curve.mesh_stiffness_n_per_m / reference.mesh_stiffness_n_per_m
            below.plot(degrees, 100.0 * loss, **style)
    above.set_ylabel("mesh stiffness [10⁸ N/m]")
    figure.legend(
        *above.get_legend_handles_labels(), loc="outside upper center", frameon=False, ncols=min(len(curves), 5)
    )
    below.set_ylabel(f"loss against {reference.state} [%]")
    below.margins(x=0)
    if parts:
        _stack(axes[2], curves[-1])
    axes[-1].set_xlabel("pinion angle since the first damaged tooth entered contact [°]")
    return figure


def _stack(axis: Axes, curve: StiffnessCurve) -> None:
    from matplotlib import colormaps

    inside = ~np.isnan(curve.parts_m_per_n["contact"])
    names = list(curve.parts_m_per_n)
    shades = [0.75, 0.55, 0.4, 0.25]
    colours = []
    for name in names:
        side, _, _ = name.partition("_")
        place = [n for n in names if n.startswith(side)].index(name)
        colours.append(colormaps[SHADES[side]](shades[place % 4]) if side in SHADES else "tab:orange")
    layers = [1e9 * curve.parts_m_per_n[name][inside] for name in names]
    axis.stackplot(
        np.degrees(curve.angle_rad[inside]), layers, labels=[n.replace("_", " ") for n in names], colors=colours
    )
    axis.set_ylabel(f"compliance of the damaged\ntooth's pair, {curve.state} [10⁻⁹ m/N]")
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=8)


def save_stiffness_figure(curves: Sequence[StiffnessCurve], path: Path, *, parts: bool = False) -> None:
    """Draw the curves into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: stiffness_figure(curves, parts=parts), path)
