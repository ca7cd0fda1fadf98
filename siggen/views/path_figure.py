"""The picture of `siggen inspect path`: accelerance of every channel over frequency, mesh harmonics marked."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from siggen.drivetrain.makers import RING_TURNING
from siggen.views.path_curves import PathCurves
from siggen.views.picture_file import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOWEST_HZ = 50.0
POINT_COLOURS = ("C3", "C5", "tab:purple", "tab:brown", "tab:olive")


def path_figure(found: PathCurves) -> Figure:
    """Return the figure: one panel per channel, one curve per bearing force."""
    from matplotlib.figure import Figure

    count = len(found.channels)
    figure = Figure(figsize=(9.0, 2.0 * count + 1.2), layout="constrained")
    panels = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    shown = found.frequency_hz >= LOWEST_HZ
    for panel, channel in zip(panels, found.channels, strict=True):
        for name, row in zip(channel.forces, channel.accelerance, strict=True):  # type: ignore[arg-type]
            if name == RING_TURNING:  # per N m
                continue
            label = ", ".join(name.split("/"))
            panel.loglog(found.frequency_hz[shown], np.abs(row[shown]), lw=0.9, label=label)
        panel.set_title(channel.name, loc="left", fontsize="medium")
        panel.grid(alpha=0.3)
        _mark_mesh(panel, found)
    peak = max(found.peak(channel)[0] for channel in found.channels)
    panels[0].set_ylim(1e-5 * peak, 2.0 * peak)
    panels[0].set_xlim(LOWEST_HZ, found.frequency_hz[-1])
    panels[0].legend(ncols=4, fontsize="small", loc="lower right")
    panels[-1].set_xlabel("frequency [Hz]; dotted: mesh harmonics of each operating point")
    figure.supylabel("accelerance [m/s² per N]")
    return figure


def _mark_mesh(panel: Axes, found: PathCurves) -> None:
    for colour, meshes in zip(POINT_COLOURS, found.mesh_hz, strict=False):
        for mesh_hz, harmonic in product(meshes, range(1, found.mesh_harmonics + 1)):
            panel.axvline(harmonic * mesh_hz, color=colour, lw=0.6, ls=":", zorder=0)


def save_path_figure(found: PathCurves, path: Path) -> None:
    """Draw the paths into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: path_figure(found), path)
