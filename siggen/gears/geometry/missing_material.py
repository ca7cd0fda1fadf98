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
from siggen.gears.geometry.corner_contact import touching_gap_m
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.internal_pair import InternalPair
from siggen.names import Side

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

    Raises
    ------
    ValueError
        If the relief is negative or longer than a base pitch, or there are fewer than 2 points.
    """
    if points < 2:
        raise ValueError(f"received {points} table points; allowed: at least 2")
    if relief is not None and not (relief.amount_m >= 0.0 and 0.0 < relief.length_m <= pair.base_pitch_m):
        allowed = f"allowed are amounts from 0 and lengths above 0 up to a base pitch, {pair.base_pitch_m:.6g} m"
        raise ValueError(f"tip relief: received {relief.amount_m} m over {relief.length_m} m; {allowed}")
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
