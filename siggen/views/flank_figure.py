"""The picture of `siggen inspect flank`: damaged flanks to scale, pitch line, ends of the active profile, zones."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING

from siggen.views.flank_views import FlankView
from siggen.views.picture_file import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

MOST_FLANKS = 12
"""Flanks of one picture; more would be too small to see a pit."""
MARGIN_MM = 0.4
INCHES_PER_MM = 0.16


def flank_figure(views: Sequence[FlankView]) -> Figure:
    """Return the figure of the first flanks, at most `MOST_FLANKS`; says how many are left out."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    shown = list(views[:MOST_FLANKS])
    columns = 1 if len(shown) <= 4 else 2
    rows = ceil(len(shown) / columns)
    width_mm = max(view.face_width_mm for view in shown)
    height_mm = max(view.tip_mm - view.foot_mm for view in shown)
    size = (
        columns * (INCHES_PER_MM * width_mm * 1.5 + 2.2) + 1.0,
        rows * (INCHES_PER_MM * 1.5 * height_mm + 0.9) + 0.4,
    )
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    colours = ScalarMappable(
        Normalize(0.0, max((depth for view in shown for depth in view.depths_mm), default=0.0) or 1.0), "YlOrRd"
    )
    for axis, view in zip(axes, shown, strict=False):
        draw_flank(axis, view, colours)
    for axis in axes[len(shown) :]:
        axis.set_axis_off()
    figure.colorbar(colours, ax=list(axes), label="depth [mm]", shrink=0.8, aspect=30)
    if len(views) > len(shown):
        figure.suptitle(f"{len(shown)} of {len(views)} damaged flanks; choose others with --state")
    return figure


def draw_flank(axis: Axes, view: FlankView, colours: ScalarMappable) -> None:
    """Draw one flank on axes."""
    import numpy as np
    from matplotlib.patches import Polygon, Rectangle

    axis.set_aspect("equal")
    axis.set_xlim(-MARGIN_MM, view.face_width_mm + MARGIN_MM)
    axis.set_ylim(view.foot_mm - MARGIN_MM, view.tip_mm + MARGIN_MM)
    fewest = min(zone.pairs for zone in view.zones)
    for zone in view.zones:
        shade = "0.84" if zone.pairs == fewest else "0.94"
        axis.add_patch(Rectangle((0, zone.low_mm), view.face_width_mm, zone.high_mm - zone.low_mm, fc=shade, ec="none"))
    outline = Rectangle(
        (0, view.foot_mm), view.face_width_mm, view.tip_mm - view.foot_mm, fc="none", ec="black", lw=1.0
    )
    axis.add_patch(outline)
    # The deepest damage lies on top: where pits overlap, the union has the larger depth.
    for depth_mm, corners in sorted(zip(view.depths_mm, view.outlines_mm, strict=True), key=lambda item: item[0]):
        patch = Polygon(corners, closed=True, fc=colours.to_rgba(np.array([depth_mm]))[0], ec="0.25", lw=0.4)
        axis.add_patch(patch)
        patch.set_clip_path(outline)
    axis.hlines(view.pitch_mm, 0, view.face_width_mm, color="C2", lw=1.0, ls="-.")
    axis.hlines(view.start_mm, 0, view.face_width_mm, color="C5", lw=1.0, ls="--")
    _name_heights(axis, view)
    axis.set_xlabel("across the face [mm]")
    axis.set_ylabel("arc above the\nbase circle [mm]")
    axis.set_title(
        f"{view.state}: {view.gear} tooth {view.tooth}, {len(view.depths_mm)} "
        f"{'spot' if len(view.depths_mm) == 1 else 'spots'}, union {view.area_mm2:.2f} mm² ({view.area_share:.1%})",
        fontsize=10,
    )


def _name_heights(axis: Axes, view: FlankView) -> None:
    """Write what the lines and zones are beside the flank."""
    names = [(view.tip_mm, "tip", "black"), (view.pitch_mm, "pitch line", "C2")]
    names += [(view.start_mm, "start of active profile", "C5")]
    for zone in view.zones:
        names.append((0.5 * (zone.low_mm + zone.high_mm), f"{_NUMBERS.get(zone.pairs, zone.pairs)} contact", "0.45"))
    room = 0.075 * (view.tip_mm - view.foot_mm + 2 * MARGIN_MM)
    last = -float("inf")
    for height, text, colour in sorted(names):
        last = max(height, last + room)
        axis.annotate(
            text,
            (view.face_width_mm + MARGIN_MM, last),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
            color=colour,
            annotation_clip=False,
        )


_NUMBERS = {1: "single", 2: "double", 3: "triple"}


def save_flank_figure(views: Sequence[FlankView], path: Path) -> None:
    """Draw the flanks into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the file cannot be drawn.
    """
    save_figure(lambda: flank_figure(views), path, dpi=120)
