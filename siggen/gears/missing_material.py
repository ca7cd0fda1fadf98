"""Missing material of the teeth along the line of action, tooth by tooth, over the path of contact and a little beyond.

Derived. Everything counts positive where material is missing and belongs to the tooth that misses it: parabolic tip
relief, the corner of the tip outside the path of contact, and one constant per tooth for its place on the gear
(cumulative pitch error). Relief keeps its value at the tip where the corner is in contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair
from siggen.gears.planetary import InternalPair
from siggen.names import Side

# Corner contact: the gap between the tip corner of a tooth and its mate outside the path of contact.
#
# Derived from the involutes alone. Before s_A the tip corner of the gear's tooth meets the pinion's flank, after s_E
# that of the pinion's tooth the gear's flank. With the corner at radius R and angle γ about its own centre, counted
# from its base tangent point, and r, g the radius and angle of that corner about the other centre, the other flank
# lags behind it by g - (ψ - inv ψ_r), ψ the roll angle of the other gear and ψ_r the one of its flank at r; times the
# base radius this is the gap along the line of action. Near the end (gap in m, Δs in m) it is (ρ_tip/R_b,tip)²/(2 R_e)
# Δs².
#
# In a ring the same holds with its base radius negative, as along the line of action: its centre lies on the other
# side. Its flank and the planet's bend the same way, so that a corner stays nearer for longer.

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


CORNER_REACH_PITCHES = 0.15
"""How far before and after the path of contact corners are followed: gaps there are ten times a usual deflection."""

RING_REACH_PITCHES = 0.4
"""The same in a ring: its flank and the planet's bend the same way, so that corners part a third as fast."""


@dataclass(frozen=True, slots=True)
class TipRelief:
    """Parabolic relief of both gears: `amount_m` at the tip, from `length_m` along the line of action before it."""

    amount_m: float
    length_m: float


@dataclass(frozen=True, slots=True)
class MissingTables:
    """What the teeth of one gear miss.

    `profile_m` (kinds, points) [m] over the positions of the pair, `kind_of_tooth` (z,) its row for each tooth,
    `offset_m` (z,) [m] what a tooth misses everywhere.
    """

    profile_m: FloatArray
    kind_of_tooth: NDArray[np.int32]
    offset_m: FloatArray


@dataclass(frozen=True, slots=True)
class MissingMaterial:
    """Tables of both gears on a uniform grid of positions from `start_m` to `end_m`, at or beyond s_A and s_E."""

    start_m: float
    end_m: float
    pinion: MissingTables
    gear: MissingTables


@lru_cache(maxsize=4)  # states of a gearbox share them
def missing_material(
    pair: GearPair,
    relief: TipRelief | None = None,
    *,
    corner_contact: bool = True,
    points: int = 2049,
    reach_pitches: float = CORNER_REACH_PITCHES,
) -> MissingMaterial:
    """Return the missing material of gears whose teeth are all alike.

    Of a helical pair positions are those of the middle of the face, and only what all slices miss is in the tables.

    Without corner contact the tables end with the path of contact: a pair that enters is loaded at once. With it they
    reach `reach_pitches` base pitches further at both ends, in a ring `RING_REACH_PITCHES` at least.
    """
    reach_m = _reach_pitches(pair, reach_pitches) * pair.base_pitch_m if corner_contact else 0.0
    start_m, end_m = pair.engagement_start_m - reach_m, pair.engagement_end_m + reach_m
    position_m = np.linspace(start_m, end_m, points)
    if pair.helix_rad != 0.0:
        relief, position_m = None, nearest_place_m(pair, position_m)
    pinion, gear = (_teeth(pair, side, relief, position_m) for side in Side)
    return MissingMaterial(start_m, end_m, pinion, gear)


def _reach_pitches(pair: GearPair, reach_pitches: float) -> float:
    return max(reach_pitches, RING_REACH_PITCHES) if isinstance(pair, InternalPair) else reach_pitches


def nearest_place_m(pair: GearPair, position_m: FloatArray) -> FloatArray:
    """Return where that part of the face is which is nearest to the path of contact; slices miss what they do alone."""
    half = 0.5 * pair.face_travel_m
    middle = np.clip(position_m, pair.contact_start_m, pair.contact_end_m)
    return position_m + np.clip(middle - position_m, -half, half)


def missing_at_m(pair: GearPair, side: Side, relief: TipRelief | None, position_m: FloatArray) -> FloatArray:
    """Return what relief and corner of one gear leave out (k,) at positions (k,) of a contact [m]."""
    to_tip_m = pair.contact_end_m - position_m if side == Side.DRIVER else position_m - pair.contact_start_m
    profile = touching_gap_m(pair, side, position_m)
    if relief is None:
        return profile
    share = np.clip(1.0 - np.maximum(to_tip_m, 0.0) / relief.length_m, 0.0, None)
    return np.asarray(profile + relief.amount_m * share**2)


def _teeth(pair: GearPair, side: Side, relief: TipRelief | None, position_m: FloatArray) -> MissingTables:
    profile, teeth = missing_at_m(pair, side, relief, position_m), pair.member(side).teeth
    made = MissingTables(profile[np.newaxis], np.zeros(teeth, dtype=np.int32), np.zeros(teeth))
    for array in (made.profile_m, made.kind_of_tooth, made.offset_m):
        array.setflags(write=False)
    return made
