"""PairRest: compliance of a pair without its contact, by how it gives way across the face.

Fitted to finite elements of teeth on their rings in three dimensions (extruded, bore clamped, free ends, read at the
tooth's centre line, so that it adds to the contact's kernel). Of a gear's compliance c

    c_t          is rigid across the face: the torsion of its body (`body_coupling.ring_torsion`)
    c - c_t      bends with the load at its place, over the length l (`tooth_kernel`)
    l            = 1.75 m (1 - exp(-b/(2.4 m))), m the module: narrow faces stay together more

For the pair 18/47 the tilt compliance and the deflection under loads on a part of the face are within 6.5 % of the
finite elements from b = 6.7 modules on, 7.1 % at 4 and 10.1 % at 2 (`tests.reference.finite_elements.face_kernel`); of
single gears tilt errs by up to 21 %, the other way on either.
"""

from __future__ import annotations

from math import cos, exp, sinh
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.contact.uneven_teeth import UnevenTeeth
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.body_coupling import ring_torsion
from siggen.gears.stiffness.compliance import ToothCompliance
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

WIDE_MODULES, NARROW_MODULES = 1.75, 2.4
"""Length l of wide faces over the module, and the face width, in modules, over which it is reached."""


class PairRest(NamedTuple):
    """At positions (k,): `rigid_m_per_n`, and `tooth_m_per_n` that bends over `length_m` (one number).

    `uneven`: what is softer in a part of the face, beside it; None: nothing is.
    """

    rigid_m_per_n: FloatArray
    tooth_m_per_n: FloatArray
    length_m: float
    uneven: UnevenTeeth | None = None

    def at(self, chosen: np.ndarray) -> PairRest:
        """Return it at some of the positions."""
        uneven = None if self.uneven is None else self.uneven.at(chosen)
        return PairRest(self.rigid_m_per_n[chosen], self.tooth_m_per_n[chosen], self.length_m, uneven)


def pair_rest(
    pair: GearPair,
    teeth: tuple[ToothCompliance, ToothCompliance],
    options: StiffnessOptions,
    standing: tuple[float, float] = (1.0, 1.0),
    added_m_per_n: FloatArray | None = None,
) -> PairRest:
    """Return the rest of pinion and gear tooth (k,) each; without foundation no body twists.

    `standing` is the share of the face, at its end, over which either tooth still stands; `added_m_per_n` (2, k, n)
    what is added to slices of either tooth, beside its compliance.
    """
    whole = np.add(teeth[0].total, teeth[1].total)
    bends, softer = np.zeros_like(whole), np.zeros_like(whole)
    alone = []
    for gear, tooth, share in zip((pair.pinion, pair.gear), teeth, standing, strict=True):
        twist = 0.0
        if options.foundation != "none":
            twist = ring_torsion(gear, pair.poisson_ratio) / (pair.youngs_modulus_pa * pair.face_width_m)
        own = np.maximum(tooth.total - twist, 0.0)
        bends += own
        if share < 1.0:
            softer += (strip_factor(pair, share) - 1.0) * own
        alone.append(own)
    uneven = None if added_m_per_n is None else UnevenTeeth(np.stack(alone), added_m_per_n)
    return PairRest(whole - bends, bends + softer, bending_length_m(pair), uneven)


def strip_factor(pair: GearPair, share: float) -> float:
    """Return by how much teeth must bend more for a strip at an end of the face to be a tooth of its own.

    Derived. Of t - l² t'' = C b q with free ends, an even load on the share f at one end sinks, on its mean, by

        (C/f) F [1 - (l/(f b)) sinh((1 - f) b/l) sinh(f b/l)/sinh(b/l)],

    since what is beside it helps; where nothing is there, by (C/f) F.
    """
    if share <= 0.0:
        return 1.0  # nothing stands that could carry
    width = pair.face_width_m / bending_length_m(pair)
    helped = sinh((1.0 - share) * width) * sinh(share * width) / (share * width * sinh(width))
    return 1.0 / (1.0 - helped)


def bending_length_m(pair: GearPair) -> float:
    """Return the length across the face over which teeth bend together [m]."""
    module = pair.pinion.module_m * cos(pair.helix_rad)
    return WIDE_MODULES * module * (1.0 - exp(-pair.face_width_m / (NARROW_MODULES * module)))
