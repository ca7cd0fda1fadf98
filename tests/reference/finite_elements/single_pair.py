"""c' of a pair, the largest stiffness of one tooth pair over the face width, by finite elements with resolved contact.

ISO 6336-1 defines c' so: the maximum of a single pair of spur teeth; cγ is the mean of the mesh. Secants are given.
The teeth of a real face lie between plane stress and plane strain; the contact is in plane strain. So the last
reference is the resolved pair in plane strain, whose teeth are replaced by those of the extruded body.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import radians

import numpy as np

from siggen.gears.geometry.gear_pair import GearPair, SpurGear
from siggen.gears.stiffness.mesh_stiffness import pair_stiffness
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from tests.reference.finite_elements.face_compliance import face_compliance
from tests.reference.finite_elements.resolved_contact import STRAIN, resolved_pair
from tests.reference.finite_elements.tooth_compliance_fem import PlaneElasticity

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


def single_positions(pair: GearPair) -> np.ndarray:
    """Return positions over single contact and the pitch point [m]."""
    low, high = pair.contact_end_m - pair.base_pitch_m, pair.contact_start_m + pair.base_pitch_m
    pitch = pair.line_of_action_m * pair.pinion.teeth / (pair.pinion.teeth + pair.gear.teeth)
    return np.sort(np.append(np.linspace(low, high, PLACES), pitch))


def library(pair: GearPair, at: np.ndarray, line_load: float | None) -> np.ndarray:
    """Return siggen's stiffness over the face width (k,) [N/(mm µm)]; None: with the linear contact."""
    options = StiffnessOptions()
    if line_load is not None:
        options = StiffnessOptions(hertz="weber_banaschek", hertz_force_n=line_load * pair.face_width_m)
    return pair_stiffness(pair, at, options) / pair.face_width_m / WIDTHS_PER_M


def extruded_teeth(pair: GearPair, at: np.ndarray) -> np.ndarray:
    """Return the compliance of both teeth under a uniform load, extruded body, times E b (k,)."""
    width = pair.face_width_m / pair.pinion.module_m
    rolls = (at / pair.pinion.base_radius_m, (pair.line_of_action_m - at) / pair.gear.base_radius_m)
    both = zip((pair.pinion, pair.gear), rolls, strict=True)
    return np.asarray(sum(face_compliance(gear, roll, width, 0.1, modes=1).uniform for gear, roll in both))


def single_pair_table() -> Iterator[str]:
    """Lines of c' by finite elements and by siggen [N/(mm µm)]."""
    pair = small_pair()
    at = single_positions(pair)
    teeth = extruded_teeth(pair, at)
    scale = pair.youngs_modulus_pa / WIDTHS_PER_M
    yield (
        "| load [N/mm] | resolved, plane strain | plane stress | extruded teeth | siggen, Weber and Banaschek "
        "| error of c' | over single contact | siggen, linear |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    linear = library(pair, at, None).max()
    for load in LINE_LOADS:
        strain, stress = (
            [resolved_pair(pair, float(x), load, plane) for x in at] for plane in (STRAIN, PlaneElasticity())
        )
        spatial = scale / (np.array([r.total - r.teeth for r in strain]) + teeth)
        ours = library(pair, at, load)
        plane = " | ".join(f"{max(scale / r.total for r in found):.2f}" for found in (strain, stress))
        errors = f"{ours.max() / spatial.max() - 1:+.1%} | {(ours / spatial).min() - 1:+.1%} to "
        errors += f"{(ours / spatial).max() - 1:+.1%}"
        yield f"| {load / 1e3:.0f} | {plane} | {spatial.max():.2f} | {ours.max():.2f} | {errors} | {linear:.2f} |"
