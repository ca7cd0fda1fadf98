"""BearingSpall: a pit in a race or on a ball, and the load that a ball loses in it.

Derived: between the edges of a pit, which lie a length ℓ apart in the direction of rolling, a ball stands on the nearer
one. At a distance x from it the ball has sunk by u = r_e - √(r_e² - x²), no further than the depth: of a flat race r_e
is the radius of the ball, of a curved one 1/r_e = 2/d - 1/R_o outside, 2/d + 1/R_i inside (to the second order of x/R).
Races that squeezed it by δ squeeze it by δ - u then, so it loses K (δ^(3/2) - (δ - u)^(3/2)), all of its load at most.

A ball without mass rolls out of a pit as it rolled in. What strikes the far edge beyond that, the momentum of the ball
itself, is left out; so is the hardness of edges.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.bearings.ball_bearing import BallBearing
from siggen.errors import mm
from siggen.gears.damage.part import NO_GEAR, NO_TOOTH, Part, Refusal
from siggen.gears.damage.sham import SHAM
from siggen.names import Side


@dataclass(frozen=True, slots=True)
class RollingSpall:
    """A spall of one bearing of a shaft.

    Parameters
    ----------
    place : str, 'pinion_bearing' or 'gear_bearing'
    element : str, 'outer', 'inner' or 'ball'
    length_m, depth_m : float, along the path of the balls and normal to it
    bearing : BallBearing
    place_rad : float
        Of the outer race from the direction of the load; of the inner race in the shaft, or of a ball about its axis
        when the pinion stands at angle 0.
    """

    place: str
    element: str
    length_m: float
    depth_m: float
    bearing: BallBearing
    place_rad: float
    gear: str = NO_GEAR
    tooth: int = NO_TOOTH
    kind: str = "bearing_spall"

    @property
    def shaft(self) -> Side:
        """The shaft in the bearing, of the first mesh's gears."""
        return Side(self.place.partition("_")[0])

    @property
    def largest_length_m(self) -> float:
        """Length from which two balls would stand in it at once, or a ball would have nothing left to roll on."""
        bearing = self.bearing
        radius = {"outer": bearing.outer_radius_m, "inner": bearing.inner_radius_m}
        if self.element == "ball":
            return 0.5 * pi * bearing.ball_diameter_m
        return radius[self.element] * bearing.spacing_rad

    def hides(self, other: Part) -> bool:
        """Return whether the other one is the same spall, no longer and no deeper."""
        if not isinstance(other, RollingSpall):
            return False
        same = (other.place, other.element, other.place_rad) == (self.place, self.element, self.place_rad)
        return same and other.length_m <= self.length_m and other.depth_m <= self.depth_m

    def sham(self) -> RollingSpall:
        """Return a spall of no length and depth in its place."""
        return replace(self, length_m=0.0, depth_m=0.0, kind=SHAM)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield how a spall does not fit its element."""
        bearing = self.bearing
        if not self.length_m < self.largest_length_m:
            said = "half of the ball's girth" if self.element == "ball" else "the spacing of the balls"
            yield Refusal("length_m", mm(self.length_m), f"below {mm(self.largest_length_m)}, {said}")
        elif not self.depth_m < 0.5 * bearing.ball_diameter_m:
            allowed = f"below {mm(0.5 * bearing.ball_diameter_m)}, the radius of a ball"
            yield Refusal("depth_m", mm(self.depth_m), allowed)

    def table_row(self) -> dict[str, object]:
        """Return its row of the table of damage."""
        return {
            "gear": self.gear,
            "tooth": self.tooth,
            "kind": self.kind,
            "shape": "none",
            "depth_law": "flat",
            "depth_mm": 1e3 * self.depth_m,
            "bearing": self.place,
            "element": self.element,
            "length_mm": 1e3 * self.length_m,
        }

    def lost_n(self, squeezed_m: FloatArray, sunk_m: FloatArray) -> FloatArray:
        """Return the load (k,) [N] that a ball loses that was squeezed by and sinks by so much (k,)."""
        left = np.maximum(squeezed_m - sunk_m, 0.0)
        lost = squeezed_m * np.sqrt(squeezed_m) - left * np.sqrt(left)
        return np.asarray(self.bearing.contact_n_per_m15 * lost)

    def sunk_m(self, from_middle_m: FloatArray, inside: FloatArray | bool) -> FloatArray:
        """Return how far a ball sinks (k,) at a distance from the middle of the spall; `inside`: on the inner race."""
        bearing = self.bearing
        outer = 2.0 / bearing.ball_diameter_m - 1.0 / bearing.outer_radius_m
        inner = 2.0 / bearing.ball_diameter_m + 1.0 / bearing.inner_radius_m
        radius = 1.0 / np.where(inside, inner, outer)
        edge = np.clip(0.5 * self.length_m - np.abs(from_middle_m), 0.0, radius)
        # r - √(r² - x²) without the difference of two large numbers
        return np.asarray(np.minimum(edge**2 / (radius + np.sqrt(radius**2 - edge**2)), self.depth_m))


def in_bearings(parts: Iterable[Part]) -> tuple[RollingSpall, ...]:
    """Return the parts of a state's damage that act in bearings."""
    return tuple(one for one in parts if isinstance(one, RollingSpall))
