"""c' of a pair, the largest stiffness of one tooth pair over the face width, by finite elements with resolved contact.

ISO 6336-1 defines c' so: the maximum of a single pair of spur teeth; cγ is the mean of the mesh. Secants are given.
The teeth of a real face lie between plane stress and plane strain; the contact is in plane strain. So the last
reference is the resolved pair in plane strain, whose teeth are replaced by those of the extruded body.
"""

from __future__ import annotations

from math import radians

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.mesh.mesh_stiffness import pair_stiffness
from siggen.mesh.stiffness_options import StiffnessOptions

TEETH, MODULE_M, FACE_M, YOUNG_PA = (17, 43), 1e-3, 10e-3, 206e9
RADIUS_RATIO = 1.4
"""Root over bore of both gears, assumed: the one with which the linear contact gives 18.95 N/(mm µm)."""
LINE_LOADS = (100e3, 300e3)
WIDTHS_PER_M = 1e9
"""N/m² in one N/(mm µm)."""
PLACES = 5


def small_pair() -> GearPair:
    """Return the 17/43 pair of module 1 mm, 10 mm wide."""
    gears = [
        SpurGear(z, MODULE_M, radians(20.0), 0.0, 1.0, 0.25, (z / 2 - 1.25) * MODULE_M / RADIUS_RATIO) for z in TEETH
    ]
    return GearPair(gears[0], gears[1], face_width_m=FACE_M, youngs_modulus_pa=YOUNG_PA, poisson_ratio=0.3)


def library(pair: GearPair, at: np.ndarray, line_load: float | None) -> np.ndarray:
    """Return siggen's stiffness over the face width (k,) [N/(mm µm)]; None: with the linear contact."""
    options = StiffnessOptions()
    if line_load is not None:
        options = StiffnessOptions(hertz="weber_banaschek", hertz_force_n=line_load * pair.face_width_m)
    return pair_stiffness(pair, at, options) / pair.face_width_m / WIDTHS_PER_M
