"""How much damage there is on a gear pair, in numbers a label can carry.

Derived from `siggen.mesh.sections`; areas and lengths along the profile are measured on the involute, R_b
psi dpsi.
"""

from __future__ import annotations

from dataclasses import dataclass

from siggen.damage.flank_damage import lost_contacts
from siggen.damage.outlines import Outline
from siggen.damage.part import Damage, damaged_teeth, pits_of
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.mesh.mesh_stiffness import largest_line_loss
from siggen.mesh.mesh_tables import pair_kinds
from siggen.mesh.sections import largest_contact_length_loss, union_area_m2
from siggen.names import Side


@dataclass(frozen=True, slots=True)
class DamageSummary:
    """Extent of a damage.

    Parameters
    ----------
    count : int
        Number of damages, as listed.
    union_area_m2 : float
        Area of the union on all teeth, face width times arc along the involute [m2].
    area_share : float
        Area share of the most damaged flank; a flank is the involute from its rack-cut start to the tip times the
        face width.
    largest_face_length_m : float
        Longest single pit or spall across the face (of a polygon: its range), clipped to the face [m].
    largest_profile_length_m : float
        Longest single pit's or spall's arc along the involute, clipped to the flank [m].
    contact_length_loss_m : float
        Largest loss of contact length of any flank at any height, of helical ones along any contact line; measured
        along the face [m].
    through_face : bool
        Whether the damage takes the whole face width somewhere on the path of contact, on one flank or on two that
        meet: there no contact length remains.
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
    for side in Side:
        gear = pair.member(side)
        for tooth in damaged_teeth(damage, side):
            pits = pits_of(damage, side, tooth)
            own = union_area_m2(gear, pits, width)
            area += own
            share = max(share, own / (width * flank_arc_m(gear)))
            loss = max(loss, _length_loss_m(pair, side, pits))
    longest = max(damage, key=lambda one: one.profile_arc_m(pair.member(one.gear)), default=None)
    outlines = [one.outline for one in damage if one.outline is not None]
    return DamageSummary(
        count=len(damage),
        union_area_m2=area,
        area_share=share,
        largest_face_length_m=max((_face_length(outline, width) for outline in outlines), default=0.0),
        largest_profile_length_m=longest.profile_arc_m(pair.member(longest.gear)) if longest else 0.0,
        contact_length_loss_m=loss,
        through_face=_through_face(pair, damage),
    )


def flank_arc_m(gear: SpurGear) -> float:
    """Return the arc of the involute between the ends of the flank, R_b (psi_2^2 - psi_1^2)/2 [m]."""
    low, high = gear.flank_rolls_rad
    return 0.5 * gear.base_radius_m * (high**2 - low**2)


def _length_loss_m(pair: GearPair, side: Side, pits: Damage) -> float:
    if pair.helix_rad == 0.0:
        return largest_contact_length_loss(pair.member(side), pits, pair.face_width_m)
    return largest_line_loss(pair, *((pits, ()) if side == Side.DRIVER else ((), pits)))[0]


def _through_face(pair: GearPair, damage: Damage) -> bool:
    if pair.helix_rad == 0.0:
        return any(lost_contacts(pair, damage))
    kinds = pair_kinds(damage)[1:]
    meeting = ((pits_of(damage, Side.DRIVER, first), pits_of(damage, Side.DRIVEN, second)) for first, second in kinds)
    return any(largest_line_loss(pair, *pits)[1] for pits in meeting)


def _face_length(outline: Outline, width: float) -> float:
    low, high = outline.face_range_m
    return min(high, width) - max(low, 0.0)
