"""Corner contact: the gap between the tip corner of a tooth and its mate outside the path of contact.

Derived from the involutes alone. Before s_A the tip corner of the gear's tooth meets the pinion's flank, after s_E that
of the pinion's tooth the gear's flank. With the corner at radius R and angle γ about its own centre, counted from its
base tangent point, and r, g the radius and angle of that corner about the other centre, the other flank lags behind it
by g - (ψ - inv ψ_r), ψ the roll angle of the other gear and ψ_r the one of its flank at r; times the base radius this
is the gap along the line of action. Near the end (gap in m, Δs in m) it is (ρ_tip/R_b,tip)²/(2 R_e) Δs².

In a ring the same holds with its base radius negative, as along the line of action: its centre lies on the other side.
Its flank and the planet's bend the same way, so that a corner stays nearer for longer.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.names import Side

TURNS = 60
"""Of a fixed point whose error falls by the slope of the gap each time: 0.3 a third of a base pitch beside the path."""


def tip_gap_m(pair: GearPair, side: Side, position_m: FloatArray, tip_roll_rad: float | None = None) -> FloatArray:
    """Return the gap [m] that the tip corner of one gear leaves at positions s (k,) of the pair; 0 before its tip.

    Parameters
    ----------
    pair : GearPair
    side : Side, of the gear that the tip belongs to: the driven one for pairs before s_A, the driver after s_E
    position_m : (k,) nominal contact positions s, which pairs outside the path of contact have too [m]
    tip_roll_rad : float or None, roll angle of a tip that lies lower than the gear's [rad]
    """
    own, length = pair.member(side), pair.line_of_action_m
    mate = pair.member(side.mate)
    own_m = position_m if side == Side.DRIVER else length - position_m
    tip = own.tip_roll_rad if tip_roll_rad is None else tip_roll_rad
    base_m, mate_m = own.signed_base_radius_m, mate.signed_base_radius_m
    beyond = own_m > base_m * tip
    own_roll = own_m / base_m
    angle = own_roll - _involute(np.asarray(tip))
    radius = base_m * np.hypot(1.0, tip)
    # From the mate's centre, across and along the line of action.
    across = mate_m + base_m - radius * np.cos(angle)
    along = length - radius * np.sin(angle)
    gap = _lag(mate_m, (length - own_m) / mate_m, across, along)
    return np.where(beyond, np.maximum(gap, 0.0), 0.0)


def touching_gap_m(pair: GearPair, side: Side, position_m: FloatArray, tip_roll_rad: float | None = None) -> FloatArray:
    """Return by how much the driven gear lags until a tip corner touches, with the pinion at its place.

    Parameters as `tip_gap_m`, which turns the mate of the corner: for a corner of the gear that is the pinion, which
    touches ahead of its nominal position by the gap, 14 % of it at 0.15 base pitches beside the path. Derived:
    e(s + g(s)) = g(s). Not beyond about a base pitch, where the gap grows as fast as the way.
    """
    if side == Side.DRIVER:
        return tip_gap_m(pair, side, position_m, tip_roll_rad)
    nominal = position_m
    for _ in range(TURNS):
        nominal = position_m - tip_gap_m(pair, side, nominal, tip_roll_rad)
    return tip_gap_m(pair, side, nominal, tip_roll_rad)


def _lag(mate_m: float, mate_roll: FloatArray, across_m: FloatArray, along_m: FloatArray) -> FloatArray:
    """Return the distance along the line of action by which the flank of a mate of a base radius misses a point."""
    roll = np.sqrt(np.maximum(np.hypot(across_m, along_m) ** 2 / mate_m**2 - 1.0, 0.0))
    flank, side = mate_roll - _involute(roll), np.sign(mate_m)
    return np.asarray(mate_m * (np.arctan2(side * along_m, side * across_m) - flank))


def _involute(roll: FloatArray) -> FloatArray:
    return roll - np.arctan(roll)
