"""Pits whose chord on the flank is given as an arc: what the contact tests measure in."""

from __future__ import annotations

from math import sqrt

from siggen.damage.pits import FlankPit
from siggen.gears.gear_pair import GearPair


def arc_of(pair: GearPair, which: str, position_m: float) -> float:
    """Arc along the involute of a gear at a contact position s."""
    gear = pair.member(which)
    travel = position_m if which == "pinion" else pair.line_of_action_m - position_m
    return 0.5 * travel**2 / gear.base_radius_m


def chord_pit(pair, length_m, position_m, depth_m=1e-3, which="pinion", semi_face_m=1.0, floor="flat"):
    """A pit of a chord in arc, centred in arc at a contact position; by default so wide that its chord is constant."""
    gear = pair.member(which)
    centre = arc_of(pair, which, position_m)
    ends = [float(gear.height_m(sqrt(2.0 * (centre + sign * 0.5 * length_m) / gear.base_radius_m))) for sign in (-1, 1)]
    middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])
    return FlankPit(which, 0, middle, 0.5 * pair.face_width_m, semi_face_m, half, depth_m, floor)
