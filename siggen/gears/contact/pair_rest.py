"""PairRest: compliance of a pair without its contact, by how it gives way across the face.

Fitted to finite elements of teeth on their rings in three dimensions (extruded, bore clamped, free ends, read at the
tooth's centre line, so that it adds to the contact's kernel). Of a gear's compliance c

    c_t          is rigid across the face: the torsion of its body (`body_coupling.ring_torsion`)
    c - c_t      bends with the load at its place, over the length l = 1.6 modules (`tooth_kernel`)

For the pair 18/47 with b = 6.7 modules at three positions the tilt compliance is within 1.2 % of the finite elements',
and the deflection under loads on a part of the face within 5 %; of single gears tilt errs by up to 16 %, the other way
on either. Checked for b from 2 to 10 modules. Faces narrower than 5 modules stay together more: l = 0.55 b at most,
which makes b = 2 modules good to 11 %.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.body_coupling import ring_torsion
from siggen.gears.stiffness.compliance import ToothCompliance
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

MODULES, SHARE_OF_FACE = 1.6, 0.55
"""Length l over the module, and its largest part of the face."""


class PairRest(NamedTuple):
    """At positions (k,): `rigid_m_per_n`, and `tooth_m_per_n` that bends over `length_m` (one number)."""

    rigid_m_per_n: FloatArray
    tooth_m_per_n: FloatArray
    length_m: float

    def at(self, chosen: np.ndarray) -> PairRest:
        """Return it at some of the positions."""
        return PairRest(self.rigid_m_per_n[chosen], self.tooth_m_per_n[chosen], self.length_m)


def rigid_rest(compliance_m_per_n: FloatArray) -> PairRest:
    """Return the rest (k,) of teeth that are rigid across the face."""
    return PairRest(compliance_m_per_n, np.zeros_like(compliance_m_per_n), np.inf)


def pair_rest(pair: GearPair, teeth: tuple[ToothCompliance, ToothCompliance], options: StiffnessOptions) -> PairRest:
    """Return the rest of pinion and gear tooth (k,) each; without foundation no body twists."""
    whole = np.add(teeth[0].total, teeth[1].total)
    bends = np.zeros_like(whole)
    for gear, tooth in zip((pair.pinion, pair.gear), teeth, strict=True):
        twist = 0.0
        if options.foundation != "none":
            twist = ring_torsion(gear, pair.poisson_ratio) / (pair.youngs_modulus_pa * pair.face_width_m)
        bends += np.maximum(tooth.total - twist, 0.0)
    return PairRest(whole - bends, bends, min(MODULES * pair.pinion.module_m, SHARE_OF_FACE * pair.face_width_m))
