"""The picture of `siggen inspect modes`: who moves in each mode, beside its frequency and the share of the mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from siggen.views.natural_modes import SpecimenModes, kinetic_shares
from siggen.views.picture_file import save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def modes_figure(found: SpecimenModes) -> Figure:
    """Return the figure: kinetic energy by degree of freedom on the left, strain energy of the mesh on the right."""
    from matplotlib.figure import Figure

    count = len(found.coordinates)
    figure = Figure(figsize=(9.0, 0.4 * count + 1.8), layout="constrained")
    shapes, mesh = figure.subplots(1, 2, sharey=True, width_ratios=(4, 1))
    image = shapes.imshow(100.0 * kinetic_shares(found), aspect="auto", cmap="Blues", vmin=0.0, vmax=100.0)
    shapes.grid(visible=False)
    shapes.set_xticks(range(count), found.coordinates, rotation=45)
    shapes.set_yticks(range(count), [f"{f:.1f} Hz" for f in found.modes.frequency_hz])
    shapes.set_title("share of kinetic energy [%]")
    figure.colorbar(image, ax=shapes, location="left")
    mesh.barh(range(count), 100.0 * found.modes.mesh_share, color="C3")
    mesh.set_xlim(0.0, 100.0)
    mesh.set_title("strain energy in the mesh [%]", loc="right", fontsize="medium")
    return figure


def save_modes_figure(found: SpecimenModes, path: Path) -> None:
    """Draw the modes into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: modes_figure(found), path)
