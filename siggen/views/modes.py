"""Natural modes of one specimen of a set: frequencies, shapes and what share of their strain energy the teeth hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.gearbox.specimen import Specimen
from siggen.mesh.mesh_force import mean_mesh_stiffness
from siggen.mesh.mesh_tables import mesh_tables
from siggen.motion.modes import MotionModes, natural_modes
from siggen.record.structure import structure
from siggen.views.pictures import save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


FIRST = "first"
"""The mesh without a name."""


@dataclass(frozen=True, slots=True)
class SpecimenModes:
    """Modes of a healthy specimen at the mean stiffness of each mesh, with the names of the degrees of freedom."""

    coordinates: tuple[str, ...]
    mesh_stiffness_n_per_m: Mapping[str, float]
    mass: FloatArray
    modes: MotionModes

    @property
    def table(self) -> pa.Table:
        """One row per mode: number, frequency, mesh share and the mass-normalised shape."""
        columns = {
            "mode": np.arange(len(self.coordinates)),
            "frequency_hz": self.modes.frequency_hz,
            "mesh_share": self.modes.mesh_share,
            **{f"shape_{name}": self.modes.shapes[:, i] for i, name in enumerate(self.coordinates)},
        }
        return pa.table(columns)


def specimen_modes(specimen: Specimen) -> SpecimenModes:
    """Return the modes of one specimen without damage, undamped, at the mean over the angle of its mesh stiffness."""
    stiffness, assembled = _mean_stiffness(specimen), structure(specimen)
    of_mesh = dict(zip((mesh.name or FIRST for mesh in assembled.meshes), stiffness, strict=True))
    return SpecimenModes(assembled.coordinates, of_mesh, assembled.mass, natural_modes(assembled, stiffness))


def _mean_stiffness(specimen: Specimen) -> list[float]:
    """Return the mean stiffness of every healthy mesh of a gearbox, in the order of its structure."""
    count = 1 if specimen.planets is None else len(specimen.planets.teeth.places)
    each = [mean_mesh_stiffness(mesh_tables(mesh.pair, (), mesh.teeth.options)) for mesh in specimen.meshes]
    return [stiffness for stiffness in each for _ in range(count)]


def kinetic_shares(found: SpecimenModes) -> FloatArray:
    """Return the share of each degree of freedom in the kinetic energy of each mode, (modes, n)."""
    # Mass-normalised shapes: rows add to 1; bodies that move with others, such as planets, make the mass no diagonal.
    return np.asarray(found.modes.shapes * (found.modes.shapes @ found.mass))


# The picture of `siggen inspect modes`: who moves in each mode, beside its frequency and the share of the mesh.


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
