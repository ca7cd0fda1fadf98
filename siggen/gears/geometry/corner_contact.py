"""Corner contact: the gap between the tip corner of a tooth and its mate outside the path of contact.

Derived from the involutes alone. Before s_A the tip corner of the gear's tooth meets the pinion's flank, after s_E that
of the pinion's tooth the gear's flank. With the corner at radius R and angle γ about its own centre, counted from its
base tangent point, and r, g the radius and angle of that corner about the other centre, the other flank lags behind it
by g - (ψ - inv ψ_r), ψ the roll angle of the other gear and ψ_r the one of its flank at r; times the base radius this
is the gap along the line of action. Near the end (gap in m, Δs in m) it is (ρ_tip/R_b,tip)²/(2 R_e) Δs².
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear


def tip_gap_m(pair: GearPair, which: str, position_m: FloatArray) -> FloatArray:
    """Return the gap [m] that the tip corner of one gear leaves at positions s (k,) of the pair; 0 before its tip.

    Parameters
    ----------
    pair : GearPair
    which : str, gear that the tip belongs to: 'gear' for pairs before s_A, 'pinion' after s_E
    position_m : (k,) nominal contact positions s, which pairs outside the path of contact have too [m]
    """
    own, length = pair.member(which), pair.line_of_action_m
    mate = pair.member("gear" if which == "pinion" else "pinion")
    own_m = position_m if which == "pinion" else length - position_m
    beyond = own_m > own.base_radius_m * own.tip_roll_rad
    own_roll = own_m / own.base_radius_m
    angle = own_roll - _involute(np.asarray(own.tip_roll_rad))
    radius = own.base_radius_m * np.hypot(1.0, own.tip_roll_rad)
    # From the mate's centre, across and along the line of action.
    across = mate.base_radius_m + own.base_radius_m - radius * np.cos(angle)
    along = length - radius * np.sin(angle)
    gap = _lag(mate, (length - own_m) / mate.base_radius_m, across, along)
    return np.where(beyond, np.maximum(gap, 0.0), 0.0)


def _lag(mate: SpurGear, mate_roll: FloatArray, across_m: FloatArray, along_m: FloatArray) -> FloatArray:
    """Return the distance along the line of action by which the mate's flank misses a point."""
    roll = np.sqrt(np.maximum(np.hypot(across_m, along_m) ** 2 / mate.base_radius_m**2 - 1.0, 0.0))
    flank = mate_roll - _involute(roll)
    return mate.base_radius_m * (np.arctan2(along_m, across_m) - flank)


def _involute(roll: FloatArray) -> FloatArray:
    return roll - np.arctan(roll)
