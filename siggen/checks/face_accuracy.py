"""The flank tolerance classes with which the whole face of a rig's gears carries at full load.

ISO 6336-1, method C: a pair whose flanks are F_βy apart at one end touches over the whole face, and its load there is
at most twice the mean (K_Hβ <= 2), where F_βy c_γβ <= 2 F/b. F_βy is here what helix slopes of both gears and the
parallelism of the shafts make at their largest; c_γβ = 0.85 c' (0.75 ε + 0.25).
"""

from __future__ import annotations

from siggen.errors import UsageError
from siggen.gears.errors.iso_1328 import flank_tolerances
from siggen.gears.geometry.gear_pair import GearPair
from siggen.rig.rig import Rig
from siggen.rig.rig_numbers import single_stiffness_n_um_mm

FINEST, COARSEST = 3, 7
"""Classes that are proposed: from gears ground with the greatest care to the preset's coarsest (assumed)."""
CHOICES = 3
LARGEST_SHARE = 0.5
"""Of its tolerance that a gear uses in the preset."""
PARALLEL_UM_PER_MM = 0.1
"""Largest misalignment of the preset's shafts per face width."""


def covering_classes(rig: Rig) -> tuple[int, ...]:
    """Return up to three neighbouring classes, of which the coarsest is the last that covers the face, or the finest.

    Those of the preset where there are no such gears, or none within ISO 1328-1: whoever loads the file says why.
    """
    try:
        pair = GearPair.of(rig.teeth, rig.module_mm, rig.face_width_mm, pressure_angle_deg=rig.pressure_angle_deg)
        allowed_um = _allowed_um(rig, pair) - PARALLEL_UM_PER_MM * rig.face_width_mm
        fitting = [grade for grade in range(FINEST, COARSEST + 1) if _slopes_um(pair, grade) <= allowed_um]
    except (UsageError, ValueError):
        return rig.accuracy_classes
    coarsest = max(fitting, default=FINEST)
    return tuple(range(max(FINEST, coarsest - CHOICES + 1), coarsest + 1))


def _allowed_um(rig: Rig, pair: GearPair) -> float:
    """Return 2 F/(b c_γβ) at the largest torque [µm]."""
    line_load_n_mm = rig.torque_nm[1] / pair.pinion.base_radius_m / rig.face_width_mm
    stiffness = 0.85 * single_stiffness_n_um_mm(rig.teeth) * (0.75 * pair.contact_ratio + 0.25)
    return 2.0 * line_load_n_mm / stiffness


def _slopes_um(pair: GearPair, grade: int) -> float:
    """Return the largest helix slopes of both gears together [µm]."""
    return sum(
        1e6 * LARGEST_SHARE * flank_tolerances(gear, pair.face_width_m, grade, pair.helix_rad).helix_slope_m
        for gear in (pair.pinion, pair.gear)
    )
