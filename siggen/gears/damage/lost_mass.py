"""The metal that a part takes from a whole tooth, whose gear is out of balance without it.

Derived. A tooth of half thickness h at the radius r covers the angles up to ± asin(h/r) there, so the first moment of
the metal between two circles, along the tooth's centre line, is the integral of 2 r h over r, times width and density.
What a pit takes is left out: 0.1 g against 5 g of a tooth.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol, TypeAlias, TypeGuard

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.damage.part import Part
from siggen.gears.geometry.spur_gear import SpurGear

STEEL_KG_M3 = 7850.0
RADII = 1001
"""Of the quadrature: trapezoids 7 µm wide on a tooth of 7 mm, 1e-6 of the moment."""


class LostMetal(Part, Protocol):
    """A part without which some of its tooth is gone, from the tip down."""

    def lost_width_m(self, gear: SpurGear, radius_m: FloatArray, face_width_m: float) -> FloatArray:
        """Return over which width of the face metal is gone at radii (k,) above the lowest, (k,) [m]."""

    def lost_from_m(self, gear: SpurGear) -> float:
        """Return the radius above which metal is gone [m]."""


LostMetals: TypeAlias = tuple[LostMetal, ...]


def without_metal(parts: Iterable[Part]) -> LostMetals:
    """Return the parts without which some of a tooth is gone."""
    return tuple(one for one in parts if _takes_metal(one))


def lost_moment_kg_m(gear: SpurGear, part: LostMetal, face_width_m: float) -> float:
    """Return mass times distance from the axis of what is gone, along the tooth's centre line [kg m]."""
    radius = np.linspace(part.lost_from_m(gear), gear.tip_radius_m, RADII)
    moment = 2.0 * radius * half_thickness_m(gear, radius) * part.lost_width_m(gear, radius, face_width_m)
    return STEEL_KG_M3 * float(np.trapezoid(moment, radius))


def half_thickness_m(gear: SpurGear, radius_m: FloatArray) -> FloatArray:
    """Return the half thickness of a whole tooth at radii (k,) from root to tip: rack-cut fillet and involute [m]."""
    start = float(gear.radius_m(gear.involute_start_roll_rad))
    slopes = np.linspace(0.5 * np.pi, gear.involute_start_gamma_rad, RADII)
    fillet = np.array([gear.trochoid_point_m(slope) for slope in slopes])
    below = np.interp(radius_m, np.hypot(*fillet.T), fillet[:, 1])
    flank = gear.half_thickness_m(gear.roll_at_radius(np.maximum(radius_m, start)))
    return np.where(radius_m < start, below, flank)


def _takes_metal(part: Part) -> TypeGuard[LostMetal]:
    return hasattr(part, "lost_width_m")
