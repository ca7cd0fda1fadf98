"""The load held softly at its mean speed, for responses to small forces, which would turn the shafts away (derived).

A spring and a damper on the rotation of the load make T_L = T_0 z_2/z_1 + D θ̇_L + K θ_L: the mean of θ̇_L is then zero
and θ_L settles at a constant angle. At 1 Hz it is far below every mode of the gearbox.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.dynamics.structure.shaft_lines import driven_and_loaded, rigid_rotation
from siggen.dynamics.structure.structure import Structure

LOCK_HZ = 1.0
"""Natural frequency of the whole inertia on the spring."""
LOCK_DAMPING_RATIO = 0.95
"""Just below critical: the state matrix keeps distinct eigenvalues."""


def locked_load(structure: Structure) -> Structure:
    """Return the structure with spring and damper on the rotation at which the load acts."""
    load = structure.coordinates.index(driven_and_loaded(structure)[1])
    rotation = rigid_rotation(structure)
    inertia = float(rotation @ structure.mass @ rotation) / rotation[load] ** 2
    omega = 2.0 * np.pi * LOCK_HZ
    stiffness, damping = structure.stiffness.copy(), structure.damping.copy()
    stiffness[load, load] += inertia * omega**2
    damping[load, load] += 2.0 * LOCK_DAMPING_RATIO * inertia * omega
    for matrix in (stiffness, damping):
        matrix.setflags(write=False)
    return replace(structure, stiffness=stiffness, damping=damping)
