"""The picture of `siggen tvms`: mesh stiffness of all states above, its relative loss against healthy below."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from siggen.errors import UsageError
from siggen.stiffness_curves import StiffnessCurve

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURE_ENDINGS = (".png", ".svg", ".pdf")


def stiffness_figure(curves: Sequence[StiffnessCurve]) -> Figure:
    """Return the figure; the loss is drawn against the first curve, which is the healthy one where there is one."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    reference = curves[0]
    for depth, curve in enumerate(curves):  # milder states lie on top: where curves agree, the mildest is seen
        degrees = np.degrees(curve.angle_rad)
        above.plot(degrees, curve.mesh_stiffness_n_per_m / 1e8, label=curve.state, lw=1.2, zorder=9 - depth)
        if curve is not reference:
            loss = 1.0 - curve.mesh_stiffness_n_per_m / reference.mesh_stiffness_n_per_m
            below.plot(degrees, 100.0 * loss, lw=1.2, zorder=9 - depth, color=above.lines[-1].get_color())
    above.set_ylabel("mesh stiffness [10⁸ N/m]")
    figure.legend(loc="outside upper center", frameon=False, ncols=len(curves))
    below.set_ylabel(f"loss against {reference.state} [%]")
    below.set_xlabel("pinion angle since the first damaged tooth entered contact [°]")
    below.margins(x=0)
    return figure


def save_stiffness_figure(curves: Sequence[StiffnessCurve], path: Path) -> None:
    """Draw the curves into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: stiffness_figure(curves), path)


def save_figure(drawn: Callable[[], Figure], path: Path) -> None:
    """Draw a figure into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    if path.suffix.lower() not in PICTURE_ENDINGS:
        raise UsageError(f"{path}: received the ending {path.suffix!r}; allowed are {', '.join(PICTURE_ENDINGS)}")
    try:
        figure = drawn()
    except ImportError:
        raise UsageError("drawing needs matplotlib: pip install 'siggen[diagnostics]'") from None
    figure.savefig(path, dpi=150)
