r"""Wear: material that sliding takes from the flanks of all teeth of a gear, and how it grows under a load.

Equations (Archard's law at a point of a flank, as Flodin and Andersson 1997 apply it; from memory): a pass of the mate
takes k p̄ 2a |v_1 - v_2|/v_i. Mean pressure times width of the contact is the force over the face (derived), so

    Δh_1(s) = k (F(s)/L) |1 - v_2/v_1|,   Δh_2(s) = k (F(s)/L) |1 - v_1/v_2|,   v_1 = Ω_1 s,  v_2 = Ω_2 (T - s)

with F(s) of the pair at s. A turn of the pinion is one pass for each of its teeth and z_1/z_2 for those of the gear.
Depths are normal to the flank, so along the line of action. What is worn carries less: the load is asked for again
whenever the depth has grown by `STEP_M`, or by a share of the penetration, whichever is less.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.part import NO_TOOTH, Damage, Part, Refusal
from siggen.damage.sham import SHAM
from siggen.errors import mm
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import CORNER_REACH_PITCHES
from siggen.names import Side

POINTS = 513
"""Of a worn profile from s_A to s_E: 30 µm of a usual path, where pairs change the depth has a step of this width."""
STEP_M = 1e-6
OF_PENETRATION = 0.1
"""A step may wear by this share of the penetration: a pair that wears by all of it would not carry in the next one."""
LABEL_POINTS = 33
"""Depths in the table of damage."""


class AtRest(NamedTuple):
    """Load of a pair over its path (k,) [N], and how far it presses the flanks into each other at most [m]."""

    load_n: FloatArray
    penetration_m: float


LoadAtRest = Callable[[FloatArray, FloatArray, FloatArray], AtRest]
"""Positions s (k,) and what pinion and gear miss there beside their relief (k,) -> the load there."""


@dataclass(frozen=True, slots=True)
class WornFlanks:
    """Worn flanks of all teeth of one gear.

    Parameters
    ----------
    gear : Side
        Its gear.
    depths_m : tuple of float
        Depth at `POINTS` even places from s_A to s_E; it stays at the ends' beyond them.
    """

    gear: Side
    depths_m: tuple[float, ...]
    tooth: int = NO_TOOTH
    kind: str = "wear"

    @property
    def whole_tooth(self) -> bool:
        """Return False: wear leaves every tooth its flanks."""
        return False

    @property
    def depth_m(self) -> float:
        """Largest depth [m]."""
        return max(self.depths_m)

    def missing_m(self, pair: GearPair, position_m: FloatArray) -> FloatArray:
        """Return what is worn at positions s (k,) [m]."""
        places = np.linspace(pair.contact_start_m, pair.contact_end_m, len(self.depths_m))
        return np.interp(position_m, places, self.depths_m)

    def outlined(self, pair: GearPair) -> Damage:  # noqa: ARG002
        """Return nothing: it has no outline."""
        return ()

    def reach_pitches(self, pair: GearPair) -> float:  # noqa: ARG002
        """Return what holds for whole tips."""
        return CORNER_REACH_PITCHES

    def hides(self, other: Part) -> bool:
        """Return whether it is nowhere less deep than milder wear of the same gear."""
        if not isinstance(other, WornFlanks) or other.gear != self.gear:
            return False
        return bool(np.all(np.asarray(self.depths_m) >= np.asarray(other.depths_m)))

    def sham(self) -> WornFlanks:
        """Return wear of no depth."""
        return replace(self, depths_m=(0.0,) * len(self.depths_m), kind=SHAM)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield a depth that is none."""
        depths = np.asarray(self.depths_m)
        if not (np.isfinite(depths).all() and depths.min() >= 0.0 < depths.max()):
            received = f"depths from {mm(depths.min())} to {mm(depths.max())}"
            yield Refusal("depths_m", received, "finite depths from 0, not 0 everywhere")

    def table_row(self) -> dict[str, object]:
        """Return gear, kind and depths; those along the profile from the root's end of the active flank to its tip."""
        from_root = np.asarray(self.depths_m if self.gear == Side.DRIVER else self.depths_m[::-1])
        named = np.interp(np.linspace(0.0, 1.0, LABEL_POINTS), np.linspace(0.0, 1.0, from_root.size), from_root)
        return {
            "gear": self.gear,
            "tooth": self.tooth,
            "kind": self.kind,
            "shape": "none",
            "depth_mm": 1e3 * self.depth_m,
            "depth_law": "none",
            "wear_depths_um": [1e6 * float(depth) for depth in named],
        }


class Worn(NamedTuple):
    """Depths of pinion and gear at positions s from s_A to s_E, each (k,) [m], after turns of the pinion."""

    pinion_m: FloatArray
    gear_m: FloatArray
    turns: float

    @property
    def largest_m(self) -> float:
        """Largest depth of either gear [m]."""
        return float(max(self.pinion_m.max(), self.gear_m.max()))


def worn_until(
    pair: GearPair,
    load: LoadAtRest,
    coefficient_m2_per_n: float,
    *,
    depth_m: float = np.inf,
    turns: float = np.inf,
) -> Worn:
    """Return the worn flanks of a pair that ran under one load until a largest depth or for some turns.

    Parameters
    ----------
    pair : GearPair
    load : LoadAtRest
    coefficient_m2_per_n : float
        Wear coefficient k, of both gears [m²/N].
    depth_m, turns : float
        Largest depth of either gear [m]; turns of the pinion. What comes first ends it; one at least is finite.

    Source: see this module.
    """
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)
    factors = turn_factors(pair, position, coefficient_m2_per_n)
    worn = Worn(np.zeros(POINTS), np.zeros(POINTS), 0.0)
    while worn.turns < turns and worn.largest_m < depth_m:
        worn = _stepped(worn, factors, load(position, worn.pinion_m, worn.gear_m), depth_m, turns - worn.turns)
    return worn


def turn_factors(pair: GearPair, position_m: FloatArray, coefficient_m2_per_n: float) -> tuple[FloatArray, FloatArray]:
    """Return depth over load [m/N] of pinion and gear (k,) by one turn of the pinion, at positions s (k,) [m]."""
    speed_1 = position_m / pair.pinion.teeth
    speed_2 = (pair.line_of_action_m - position_m) / pair.gear.teeth
    # The base radii are in the ratio of the teeth: Ω_2/Ω_1 = z_1/z_2.
    sliding = coefficient_m2_per_n / pair.face_width_m * np.abs(speed_1 - speed_2)
    return sliding / speed_1, sliding / speed_2 * pair.pinion.teeth / pair.gear.teeth


def _stepped(worn: Worn, factors: tuple[FloatArray, FloatArray], rest: AtRest, depth_m: float, turns: float) -> Worn:
    """Return flanks after a step that ends at the least of a small growth, the depth that is wanted, and the turns."""
    rates = tuple(factor * rest.load_n for factor in factors)
    largest = max(float(rate.max()) for rate in rates)
    step = min(turns, min(STEP_M, OF_PENETRATION * rest.penetration_m) / largest)
    step = min(step, _turns_to(depth_m, worn.pinion_m, rates[0]), _turns_to(depth_m, worn.gear_m, rates[1]))
    after = Worn(worn.pinion_m + step * rates[0], worn.gear_m + step * rates[1], worn.turns + step)
    # Rounding may leave the depth that ends it just below: the last step is the last.
    return after if after.largest_m < depth_m * (1.0 - 1e-12) else _scaled(after, depth_m)


def _turns_to(depth_m: float, depths_m: FloatArray, rates_m: FloatArray) -> float:
    """Return the turns until depths (k,) that grow at rates (k,) [m] per turn reach a depth anywhere."""
    grows = rates_m > 0.0
    return float(np.min((depth_m - depths_m[grows]) / rates_m[grows], initial=np.inf))


def _scaled(worn: Worn, depth_m: float) -> Worn:
    """Return depths with what rounding has left of the wanted largest one."""
    factor = depth_m / worn.largest_m
    return Worn(worn.pinion_m * factor, worn.gear_m * factor, worn.turns)
