"""A tooth that has lost its tip over the whole face, or all of it.

Derived. What is left ends in a corner at a smaller radius: the pair's contact ends where that corner leaves, and then
the corner itself is in contact, as those of whole tips are beside the path (`corner_contact`). Where a tooth is gone
its pair does not exist: for 2 - ε base pitches the corners of the pairs before and after carry. Between them the driven
gear lags by the gap at which both touch, so corners are followed as far as that.

Material above a contact carries no load, so what is left of the tooth is as stiff as before; a corner is taken to be as
stiff as the flank at the pair's nominal position. Both flanks of a tooth lose their tip. Without the metal its gear is
out of balance (`siggen.gears.damage.lost_mass`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from math import sqrt

import numpy as np

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.damage.part import Part, Refusal
from siggen.gears.damage.part_chip import PartChip, lost_outline
from siggen.gears.damage.sham import SHAM
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.corner_contact import touching_gap_m
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import CORNER_REACH_PITCHES
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.names import Side

MARGIN_PITCHES = 0.05
"""Beyond the place where corners meet without load: a loaded mesh reaches further."""
FARTHEST_PITCHES = 0.95
"""How far beside the path corners can be followed at all: there the next pair is in the path itself."""
PLACES = 4001
"""Of the search for that place, 1e-3 of a base pitch apart."""


@dataclass(frozen=True, slots=True)
class WholeChip:
    """A tooth without its tip, over the whole face.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    height_m : float
        What is lost from the tip down, along the radius [m]; infinite for a tooth that is gone.
    """

    gear: Side
    tooth: int
    height_m: float
    kind: str = "chip"

    @property
    def whole_tooth(self) -> bool:
        """Whether nothing is left."""
        return self.height_m == np.inf

    def missing_m(self, pair: GearPair, position_m: FloatArray) -> FloatArray:
        """Return by how much its corner misses the mate more than that of a whole tip, at positions s (k,) [m]."""
        roll = left_roll_rad(pair.member(self.gear), self.height_m)
        if roll is None:
            return np.full(position_m.shape, pair.base_pitch_m)
        return touching_gap_m(pair, self.gear, position_m, roll) - touching_gap_m(pair, self.gear, position_m)

    def reach_pitches(self, pair: GearPair) -> float:
        """Return how far beside the path of contact corners of its neighbours may carry [base pitches]."""
        return corner_reach_pitches(pair, self.gear, self.height_m)

    def outlined(self, pair: GearPair) -> Damage:
        """Return it as a chip over a part of the face that is all of it; nothing for a sham."""
        gear, width_m = pair.member(self.gear), pair.face_width_m
        if self.kind == SHAM:
            return ()
        height_m = min(self.height_m, tooth_height_m(gear))
        outline = lost_outline(gear, height_m, width_m)
        return (PartChip(self.gear, self.tooth, height_m, width_m, outline, self.whole_tooth, whole_face=True),)

    def lost_from_m(self, gear: SpurGear) -> float:
        """Return the radius above which it is gone [m]."""
        return max(gear.tip_radius_m - self.height_m, gear.root_radius_m)

    def lost_width_m(self, gear: SpurGear, radius_m: FloatArray, face_width_m: float) -> FloatArray:  # noqa: ARG002
        """Return the face width (k,) at any radii (k,) [m]."""
        return np.full(radius_m.shape, face_width_m)

    def hides(self, other: Part) -> bool:
        """Return whether less is left than of the same tooth before; where nothing is, nothing else is to be seen.

        What lies on lost metal needs a pair to be told: `outlined` hides it.
        """
        if (other.gear, other.tooth) != (self.gear, self.tooth):
            return False
        return self.whole_tooth or (isinstance(other, WholeChip) and other.height_m <= self.height_m)

    def sham(self) -> WholeChip:
        """Return a tooth that has lost no height."""
        return replace(self, height_m=0.0, kind=SHAM)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield a height that is none."""
        if not self.height_m > 0.0:
            yield Refusal("height_m", f"height {mm(self.height_m)}", "above 0")

    def table_row(self) -> dict[str, object]:
        """Return gear, tooth, kind and the height that is lost; 0 where all of the tooth is."""
        return {
            "gear": self.gear,
            "tooth": self.tooth,
            "kind": "broken_tooth" if self.whole_tooth else self.kind,
            "shape": "none",
            "depth_law": "none",
            "chip_height_mm": 0.0 if self.whole_tooth else 1e3 * self.height_m,
        }


def left_roll_rad(gear: SpurGear, height_m: float) -> float | None:
    """Return the roll angle of the corner that is left [rad]; None where it lies on no involute any more."""
    radius = gear.tip_radius_m - height_m
    if radius <= gear.base_radius_m:
        return None
    return sqrt((radius / gear.base_radius_m) ** 2 - 1.0)


def tooth_height_m(gear: SpurGear) -> float:
    """Return the height of a tooth from root to tip circle [m]."""
    return gear.tip_radius_m - gear.root_radius_m


def keeps_contact(pair: GearPair, side: Side, height_m: float) -> bool:
    """Return whether a tooth without its tip meets its mate anywhere on the path of contact."""
    roll = left_roll_rad(pair.member(side), height_m)
    return roll is not None and roll > pair.active_flank[0 if side == Side.DRIVER else 1][0]


@lru_cache(maxsize=64)
def corner_reach_pitches(pair: GearPair, side: Side, height_m: float) -> float:
    """Return how far beside the path of contact corners carry where a tooth has lost its tip [base pitches].

    Without load the flanks touch where least is missing; the place beside the path that lies farthest out, and a
    margin; never less than for whole teeth.
    """
    pitch, start, end = pair.base_pitch_m, pair.contact_start_m, pair.contact_end_m
    place = np.linspace(start - pitch, end + pitch, PLACES)
    chipped = WholeChip(side, 0, height_m)
    around = np.stack([place + pitch, place, place - pitch])
    gaps = np.stack([touching_gap_m(pair, Side.DRIVER, s) + touching_gap_m(pair, Side.DRIVEN, s) for s in around])
    gaps[1] += chipped.missing_m(pair, place)
    touching = np.argmin(gaps, axis=0)
    at = np.take_along_axis(around, touching[None], axis=0)[0]
    beside = np.maximum(start - at, at - end)[np.min(gaps, axis=0) > 0.0]
    farthest = float(np.max(beside, initial=0.0)) / pitch
    return min(max(CORNER_REACH_PITCHES, farthest + MARGIN_PITCHES), FARTHEST_PITCHES)
