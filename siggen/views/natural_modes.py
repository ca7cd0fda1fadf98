"""Natural modes of one specimen of a set: frequencies, shapes and what share of their strain energy the teeth hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.config import Config
from siggen.dynamics.mesh.mesh_force import mean_mesh_stiffness
from siggen.dynamics.time.modes import Modes, natural_modes
from siggen.gears.stiffness.mesh_tables import mesh_tables
from siggen.planning.specimen import draw_specimen
from siggen.specimen.gears import gear_pair, stiffness_options
from siggen.specimen.structure import structure


@dataclass(frozen=True, slots=True)
class SpecimenModes:
    """Modes of a healthy specimen at its mean mesh stiffness, with the names of the degrees of freedom."""

    coordinates: tuple[str, ...]
    mesh_stiffness_n_per_m: float
    mass: FloatArray
    modes: Modes

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


def specimen_modes(config: Config, specimen_id: int = 0) -> SpecimenModes:
    """Return the modes of one specimen without damage, undamped, at the mean over the angle of its mesh stiffness."""
    specimen = draw_specimen(config, specimen_id)
    options = stiffness_options(specimen.stiffness)
    pairs = [gear_pair(gears) for gears in (specimen.gears, *(stage.gears for stage in specimen.stages))]
    stiffness = [mean_mesh_stiffness(mesh_tables(pair, (), options)) for pair in pairs]
    assembled = structure(config, specimen)
    return SpecimenModes(assembled.coordinates, stiffness[0], assembled.mass, natural_modes(assembled, stiffness))


def kinetic_shares(found: SpecimenModes) -> FloatArray:
    """Return the share of each degree of freedom in the kinetic energy of each mode, (modes, n)."""
    return found.modes.shapes**2 * np.diag(
        found.mass
    )  # mass-normalised shapes and a diagonal mass matrix: rows add to 1
