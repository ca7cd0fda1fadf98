"""Compliance of the analytical tooth models in the same dimensionless form as the finite elements (times E L)."""

from __future__ import annotations

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.mesh.mesh_stiffness import StiffnessOptions, tooth_compliance

MODELS = {
    "base circle + profile": StiffnessOptions(beam="base_circle", foundation_angle="profile"),
    "root circle + profile": StiffnessOptions(beam="root_circle", foundation_angle="profile"),
    "rack trochoid + rack": StiffnessOptions(beam="rack_trochoid", foundation_angle="rack"),
}
CALIBRATED_MODEL = "rack trochoid + rack"


def model_compliance(gear: SpurGear, roll: np.ndarray, options: StiffnessOptions) -> np.ndarray:
    """Compliance of one tooth (bending, shear, axial, foundation) times E L.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : (k,) array
        Roll angles of the loaded flank points [rad].
    options : StiffnessOptions
        Beam and foundation.

    Returns
    -------
    (k,) array
        Dimensionless.
    """
    pair = GearPair(gear, gear, face_width_m=1.0, youngs_modulus_pa=1.0, poisson_ratio=0.3)
    parts = tooth_compliance(pair, "pinion", roll, options)
    return parts.bending + parts.shear + parts.axial + parts.foundation
