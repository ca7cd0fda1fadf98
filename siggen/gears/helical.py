r"""Helical gears: sections of their teeth, and where the slices of the face are on the path of contact.

Equations (reference: standard literature, ISO 21771): with the helix angle β on the pitch cylinder

    tan α_t = tan α_n/cos β    m_t = m_n/cos β    tan β_b = tan β cos α_t    z_n = z/(cos² β_b cos β)

Heights are those of the normal section, so coefficients in transverse modules are smaller by cos β.

Derived. Line loads across the face and along the contact line are one number, since force and length both grow by
1/cos β_b; what the flanks approach in the normal section is cos β_b of what they approach in the transverse plane. So
there a contact is softer by 1/cos β_b and a tooth, cut over b/cos β, by 1/cos² β_b.
"""

from __future__ import annotations

from dataclasses import replace
from math import atan, cos, tan

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.names import Side


def normal_pair(pair: GearPair) -> GearPair:
    """Return the spur pair whose teeth are the normal sections of a helical pair, as long as its teeth.

    Its numbers of teeth are z_n; bodies keep their ratio of root to bore.
    """
    pinion, gear = (normal_gear(pair, side) for side in Side)
    length = pair.face_width_m / cos(pair.helix_rad)
    return replace(pair, pinion=pinion, gear=gear, face_width_m=length, centre_distance_m=None, helix_rad=0.0)


def normal_gear(pair: GearPair, side: Side) -> SpurGear:
    """Return the normal section of one gear of a pair; of a spur gear the gear itself."""
    own, share = pair.member(side), cos(pair.helix_rad)
    if pair.helix_rad == 0.0:
        return own
    section = replace(
        own,
        teeth=own.teeth / (cos(pair.base_helix_rad) ** 2 * share),  # type: ignore[arg-type]  # no whole number
        module_m=own.module_m * share,
        pressure_angle_rad=atan(tan(own.pressure_angle_rad) * share),
        profile_shift=own.profile_shift / share,
        addendum_coefficient=own.addendum_coefficient / share,
        clearance_coefficient=own.clearance_coefficient / share,
    )
    return replace(section, bore_radius_m=section.root_radius_m * own.bore_radius_m / own.root_radius_m)


def normal_rolls(pair: GearPair, side: Side, roll_rad: FloatArray) -> FloatArray:
    """Return the roll angles in the normal section (k,) at which a helical tooth is as high as at rolls (k,) [rad]."""
    own, section = pair.member(side), normal_pair(pair).member(side)
    height = own.radius_m(roll_rad) - own.pitch_radius_m
    ratio = (section.pitch_radius_m + height) / section.base_radius_m
    return np.minimum(np.sqrt(np.maximum(ratio**2 - 1.0, 0.0)), section.tip_roll_rad)


def slice_shifts_m(pair: GearPair, slices: int) -> FloatArray:
    """Return how far the middles of slices (slices,) are ahead of the middle of the face on their path [m]."""
    place = (np.arange(slices) + 0.5) / slices - 0.5
    return place * pair.face_width_m * tan(pair.base_helix_rad)


def slice_radii_m(pair: GearPair, position_m: FloatArray, slices: int) -> FloatArray:
    """Return relative radii of curvature of slices of pairs at positions (k,): (k, slices), of spur pairs (k, 1) [m].

    A slice beside the path of contact counts as at its end.
    """
    place, line = position_m[:, np.newaxis], pair.line_of_action_m
    if pair.helix_rad != 0.0:
        place = np.clip(place + slice_shifts_m(pair, slices), pair.contact_start_m, pair.contact_end_m)
    return np.asarray(place * (line - place) / line)


def carrying_middle_m(pair: GearPair, position_m: FloatArray) -> FloatArray:
    """Return the middle of those places of the face that are on the path of contact, of pairs at positions (k,) [m]."""
    if pair.helix_rad == 0.0:
        return position_m
    half = 0.5 * pair.face_travel_m
    low, high = pair.contact_start_m, pair.contact_end_m
    return 0.5 * (np.clip(position_m - half, low, high) + np.clip(position_m + half, low, high))
