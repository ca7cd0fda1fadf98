"""Both meshes of a planet in numbers that do not depend on its size: overlap of teeth, stiffness per face, phase."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, pi, radians

import numpy as np

from siggen.gears.geometry.gear_pair import GearPair, SpurGear, geometry_problems
from siggen.gears.geometry.internal_pair import internal_problems, ring_ahead_pitches, ring_round
from siggen.gears.stiffness.mesh_stiffness import mesh_stiffness
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

MODULE_M, FACE_M = 1e-3, 1e-3
STEEL = 206e9, 0.3
PER_UM = 1e-6
"""From N/m to N/um, of a face of 1 mm."""
PLACES = 100


def planetary_meshes(sun: int, planet: int, ring: int) -> dict[str, float]:
    """Return contact ratios, working pressure angle of the ring, mean stiffness, and the phase between both meshes.

    Stiffness in N/(mm um), angle in degrees, phase in pitches.

    Raises
    ------
    ValueError
        If the teeth do not mesh, with names.
    """
    pair = GearPair(_gear(sun), _gear(planet), FACE_M, *STEEL)
    if problems := geometry_problems(pair):
        raise ValueError("sun and planet: " + "; ".join(map(str, problems)))
    inner = ring_round(pair, ring)
    if problems := internal_problems(inner):
        raise ValueError("; ".join(map(str, problems)))
    options, places = StiffnessOptions(), np.arange(PLACES) / PLACES
    return {
        "contact_ratio_sun": pair.contact_ratio,
        "contact_ratio_ring": inner.contact_ratio,
        "ring_profile_shift": inner.gear.profile_shift,
        "ring_working_pressure_angle_deg": degrees(inner.working_pressure_angle_rad),
        "stiffness_sun_n_per_mm_um": PER_UM
        * float(mesh_stiffness(pair, 2.0 * pi / sun * places, options).mean()),
        "stiffness_ring_n_per_mm_um": PER_UM
        * float(mesh_stiffness(inner, 2.0 * pi / planet * places, options).mean()),
        "ring_ahead_pitches": ring_ahead_pitches(pair, inner),
    }  # fmt: skip


def _gear(teeth: int) -> SpurGear:
    gear = SpurGear(teeth, MODULE_M, radians(20.0), 0.0, 1.0, 0.25, MODULE_M)
    return replace(gear, bore_radius_m=0.5 * gear.root_radius_m)
