"""Natural frequencies without their modes."""

from __future__ import annotations

import numpy as np

from siggen.drivetrain.structure import Structure
from siggen.motion.modes import natural_modes


def natural_frequencies_hz(structure: Structure, mesh_stiffness_n_per_m: float) -> np.ndarray:
    """Return the undamped natural frequencies (n,) [Hz], ascending, at a constant mesh stiffness; rigid ones are 0."""
    return natural_modes(structure, mesh_stiffness_n_per_m).frequency_hz
