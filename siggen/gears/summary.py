"""How much damage there is on a gear pair, in numbers a label can carry.

Derived from `siggen.gears.sections`; areas and lengths along the profile are measured on the involute, R_b psi dpsi.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.gears.damage import Damage, Pit, damaged_teeth, flank_heights, pits_of
from siggen.gears.geometry import GearPair
from siggen.gears.sections import largest_contact_length_loss, union_area_m2
from siggen.gears.spur_gear import SpurGear


@dataclass(frozen=True, slots=True)
class DamageSummary:
    """Extent of a damage.

    Parameters
    ----------
    count : int
        Number of pits, as listed.
    union_area_m2 : float
        Area of the union on all teeth, face width times arc along the involute [m2].
    area_share : float
        Area share of the most damaged flank; a flank is the involute from its rack-cut start to the tip times the
        face width.
    largest_face_length_m : float
        Largest single pit's length across the face, clipped to the face [m].
    largest_profile_length_m : float
        Largest single pit's arc along the involute, clipped to the flank [m].
    contact_length_loss_m : float
        Largest loss of contact length of any flank at any height [m].
    through_face : bool
        Whether a pit runs out through an end of the face.
    """

    count: int
    union_area_m2: float
    area_share: float
    largest_face_length_m: float
    largest_profile_length_m: float
    contact_length_loss_m: float
    through_face: bool


def damage_summary(pair: GearPair, damage: Damage) -> DamageSummary:
    """Return the extent of a damage without problems; all zero for none."""
    width = pair.face_width_m
    area = share = loss = 0.0
    for which in ("pinion", "gear"):
        gear = pair.member(which)
        for tooth in damaged_teeth(damage, which):
            pits = pits_of(damage, which, tooth)
            own = union_area_m2(gear, pits, width)
            area += own
            share = max(share, own / (width * flank_arc_m(gear)))
            loss = max(loss, largest_contact_length_loss(gear, pits, width))
    return DamageSummary(
        count=len(damage),
        union_area_m2=area,
        area_share=share,
        largest_face_length_m=max((_face_length(pit, width) for pit in damage), default=0.0),
        largest_profile_length_m=max((_profile_length(pair.member(pit.gear), pit) for pit in damage), default=0.0),
        contact_length_loss_m=loss,
        through_face=any(_runs_out(pit, width) for pit in damage),
    )


def flank_arc_m(gear: SpurGear) -> float:
    """Return the arc of the involute from its rack-cut start to the tip, R_b (psi_tip^2 - psi_start^2)/2 [m]."""
    return 0.5 * gear.base_radius_m * (gear.tip_roll_rad**2 - gear.involute_start_roll_rad**2)


def _face_length(pit: Pit, width: float) -> float:
    return min(pit.face_m + pit.semi_axis_face_m, width) - max(pit.face_m - pit.semi_axis_face_m, 0.0)


def _profile_length(gear: SpurGear, pit: Pit) -> float:
    ends = [pit.height_m - pit.semi_axis_profile_m, pit.height_m + pit.semi_axis_profile_m]
    low, high = gear.roll_at_height(np.clip(ends, *flank_heights(gear)))
    return float(0.5 * gear.base_radius_m * (high - low) * (high + low))


def _runs_out(pit: Pit, width: float) -> bool:
    return pit.face_m - pit.semi_axis_face_m < 0.0 or pit.face_m + pit.semi_axis_face_m > width
