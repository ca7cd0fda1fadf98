"""A spall in a rolling bearing of a shaft: in a race, or on a ball."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import ceil, cos, pi, radians
from typing import Annotated, ClassVar, Literal

import numpy as np
import pyarrow as pa
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.damage.ball_geometry import BallGeometry
from siggen.damage.fault import Fault, HitTeeth
from siggen.damage.flank_place import MM
from siggen.damage.growth import Growth
from siggen.damage.part import NO_GEAR, NO_TOOTH, Part, Parts, Refusal
from siggen.damage.sham import SHAM
from siggen.drivetrain.bearings import BallBearing
from siggen.drivetrain.drive import Turning
from siggen.drivetrain.excitation import InputSource
from siggen.errors import Problem, mm
from siggen.gears.gear_pair import GearPair
from siggen.keys.column import MILLIMETRE, Column
from siggen.keys.drawing import corners, draw
from siggen.keys.number import Number, Within, bounds, constant
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.names import Side
from siggen.seeding import Stream, named_uniforms

# BearingSpall: a pit in a race or on a ball, and the load that a ball loses in it.
#
# Derived: between the edges of a pit, which lie a length ℓ apart in the direction of rolling, a ball stands on the
# nearer one. At a distance x from it the ball has sunk by u = r_e - √(r_e² - x²), no further than the depth: of a flat
# race r_e is the radius of the ball, of a curved one 1/r_e = 2/d - 1/R_o outside, 2/d + 1/R_i inside (to the second
# order of x/R). Races that squeezed it by δ squeeze it by δ - u then, so it loses K (δ^(3/2) - (δ - u)^(3/2)), all of
# its load at most.
#
# A ball without mass rolls out of a pit as it rolled in. What strikes the far edge beyond that, the momentum of the
# ball itself, is left out; so is the hardness of edges.


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


BEARING_TEXT = AllowedText("one of pinion_bearing, gear_bearing; of a machine SHAFT_bearing of the first two shafts")
KEYS = {"length_m": "length_mm", "depth_m": "depth_mm"}
"""Key that a problem of the drawn spall is about."""

LOADED_DEG = 0.0
"""Place of a spall on the outer race from the direction of the bearing's load: where races break."""


class BearingSpalls(Fault):
    """A spall in one of both bearings of a shaft: `dynamics.<shaft>.bearing.geometry`, of its defaults where null."""

    words: ClassVar[tuple[str, ...]] = ("bearing",)
    acts: ClassVar[str] = (
        "A spall in a bearing takes load from each ball that rolls over it: a force between shaft and housing, in step "
        "with the balls, which slip by 1 to 2 %."
    )
    needs_bearings: ClassVar[bool] = True
    columns: ClassVar[tuple[Column, ...]] = (
        Column("bearing", pa.string(), "", "bearing with the spall: pinion_bearing or gear_bearing; else empty"),
        Column("element", pa.string(), "", "what of the bearing has it: outer, inner or ball; else empty"),
        Column("length_mm", pa.float64(), MILLIMETRE, "length of a bearing's spall along the path of the balls"),
        Column(
            "slip_share", pa.float64(), "", "share by which the cage of a spalled bearing lags in this record; else 0"
        ),
    )

    kind: Literal["bearing_spall"] = "bearing_spall"
    bearing: Annotated[str, BEARING_TEXT] = Field(
        default="pinion_bearing",
        description="one of the two there: pinion_bearing, gear_bearing, of a machine SHAFT_bearing",
    )
    element: Literal["outer", "inner", "ball"] = Field(description="the spalled race, or a ball")
    length_mm: Annotated[Number, Within(above=0), Usual(0.1, 30)] = Field(description="along the path of the balls")
    depth_mm: Annotated[Number, Within(above=0), Usual(0.005, 1)] = Field(
        default=0.1, description="how far a ball may sink in (memory: 0.05 to 0.3)"
    )

    @property
    def position(self) -> str:
        """The bearing."""
        return self.bearing

    def hit_teeth(self) -> HitTeeth:
        """Yield nothing."""
        return iter(())

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'length_mm' where it may be no longer than that of the milder state on the same element."""
        if not self._is_of(milder) or not isinstance(milder, BearingSpalls):
            return None
        (low, high), (low_before, high_before) = bounds(self.length_mm), bounds(milder.length_mm)
        return "length_mm" if low < low_before or high <= high_before else None

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:  # noqa: ARG002
        """Yield nothing: no gear has it."""
        return iter(())

    def problems_in(self, bearing: BallBearing) -> Iterator[Problem]:
        """Yield the first of what does not fit its element of a bearing."""
        for corner in corners(partial(draw, self, path="")):
            for problem in corner._spall(bearing, 0.0).own_problems():
                yield Problem(KEYS[problem.name], problem.received, f"allowed: {problem.allowed}")
                return

    def drawn(self, growth: Growth) -> Parts:
        """Return the spall, with the draws of the one that it has grown from."""
        began = [state for state, older in growth.milder if self._is_of(older)]
        uniform = named_uniforms(
            growth.seed, Stream.DAMAGE, growth.specimen_id, began[-1] if began else growth.state_id
        )
        name = f"bearing_spall.{self.bearing}.{self.element}"
        spall = draw(self, uniform, name)._spall(BallGeometry().bearing(), uniform(f"{name}.place"))
        for older in in_bearings(growth.before):
            if (older.place, older.element) == (spall.place, spall.element):
                # other distributions may rank a gearbox otherwise: what broke out does not come back
                length_m, depth_m = max(spall.length_m, older.length_m), max(spall.depth_m, older.depth_m)
                spall = replace(spall, length_m=length_m, depth_m=depth_m)
        return (spall,)

    def _is_of(self, older: object) -> bool:
        return isinstance(older, BearingSpalls) and (older.bearing, older.element) == (self.bearing, self.element)

    def _spall(self, bearing: BallBearing, turn: float) -> RollingSpall:
        """Return the drawn spall; those of what turns stand at a share of a turn."""
        return RollingSpall(
            place=self.bearing,
            element=self.element,
            length_m=MM * constant(self.length_mm),
            depth_m=MM * constant(self.depth_mm),
            bearing=bearing,
            place_rad=radians(LOADED_DEG if self.element == "outer" else 360.0 * turn),
        )


# CageCourse: how far the cage has turned when its shaft stands at an angle, with slip and a random walk.
#
# Balls slip a little, so the cage lags by a share of its order, and by a little more or less from ball to ball: its
# angle takes a random step each time a ball passes a place of the outer race (reference: standard literature; shares
# from memory). Phases of lines are lost by it, in proportion to the square of their number.


@dataclass(frozen=True, slots=True)
class CageCourse:
    """Angle of a cage by the angle of its shaft.

    Parameters
    ----------
    order : float, turns of the cage per turn of the shaft, slip included
    start_rad : float, of the cage where the shaft stands at 0
    first_rad : float, angle of the shaft at which the walk begins
    step_rad : float, turn of the shaft from step to step of the walk
    walked_rad : (steps + 1,) the walk at each step, from 0; between them it runs straight
    """

    order: float
    start_rad: float
    first_rad: float
    step_rad: float
    walked_rad: FloatArray

    def angle_rad(self, shaft_rad: FloatArray) -> FloatArray:
        """Return the angle (k,) of the cage where the shaft stands at (k,) [rad].

        Raises
        ------
        ValueError
            If the shaft turns further than the walk covers.
        """
        place = (shaft_rad - self.first_rad) / self.step_rad
        if place.size and not (place.min() >= 0.0 and place.max() <= self.walked_rad.size - 1):
            raise ValueError(
                f"shaft_rad: received {shaft_rad.min()} to {shaft_rad.max()}; allowed are {self.first_rad} to "
                f"{self.first_rad + self.step_rad * (self.walked_rad.size - 1)}"
            )
        walked = np.interp(place, np.arange(self.walked_rad.size), self.walked_rad)
        return np.asarray(self.start_rad + self.order * shaft_rad + walked)


def cage_course(
    bearing: BallBearing, rng: np.random.Generator, slip: float, walk: float, ends_rad: tuple[float, float]
) -> CageCourse:
    """Return a course that covers a shaft that turns forward between two angles; a later end leaves it as it was.

    Parameters
    ----------
    slip : share by which the cage lags
    walk : standard deviation of a step, as a share of the angle between two balls
    """
    order = bearing.cage_order * (1.0 - slip)
    step_rad = bearing.spacing_rad / order
    start = 2.0 * np.pi * rng.random()
    steps = ceil((ends_rad[1] - ends_rad[0]) / step_rad) + 1
    walked = np.cumsum(walk * bearing.spacing_rad * rng.standard_normal(steps))
    return CageCourse(order, float(start), ends_rad[0], step_rad, np.concatenate([[0.0], walked]))


# SpalledBearing: the force between a shaft and its seat as balls pass a spall, as inputs of the equations of motion.
#
# A ball that sinks into a spall is a movement of the base of its bearing's spring: what the ball does not bear any
# more pushes shaft and seat together, equal on both and opposite (derived). The rest of the ring bears it, by the
# spring of the bearing. The spring itself keeps its stiffness, though a ball less shares it, and a healthy bearing
# does not vary as its balls pass: both are left out.
#
#     outer   at β_o, still       balls pass it n FTF (1 - s) times a turn, each under the load of that place
#     inner   turns with the shaft: the load of its place changes once a turn
#     ball    meets both races once in every turn about its axis, under a load that changes once a turn of the cage


@dataclass(frozen=True, slots=True)
class ZoneOfLoad:
    """Where the mean force of a shaft on its seat points from the horizontal [rad], and how far it moves the rings."""

    direction_rad: float
    deflection_m: float


@dataclass(frozen=True, slots=True, eq=False)
class SpalledBearing(InputSource):
    """A spall in a loaded bearing.

    Parameters
    ----------
    spall : BearingSpall
    zone : ZoneOfLoad
    cage : CageCourse
    order : float
        Turns of the shaft per turn of the pinion; negative if it turns from vertical to horizontal. Angles count from
        horizontal to vertical.
    directions : (2, n)
        Generalised forces per newton that a ball loses along both axes: on the shaft, and back on its seat.
    on_seat : place/axis -> (2,) force on the seat, per newton
    """

    spall: RollingSpall
    zone: ZoneOfLoad
    cage: CageCourse
    order: float
    directions: FloatArray
    on_seat: Mapping[str, FloatArray]

    @property
    def vectors(self) -> FloatArray:
        """The directions (2, n)."""
        return self.directions

    @property
    def sharp_turn_rad(self) -> float:
        """Until the spall stood at all angles to the load; of the outer race until two balls have passed."""
        cage_rad = 2.0 * pi / self.cage.order
        turns = {"outer": 2.0 * cage_rad / self.spall.bearing.balls, "inner": 2.0 * pi, "ball": cage_rad}
        return turns[self.spall.element] / abs(self.order)

    @property
    def seat_forces(self) -> Mapping[str, FloatArray]:
        """Forces on the seats (2,) per unit of both inputs, beside those of springs and dampers."""
        return self.on_seat

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the lost load (k, 2) [N] along both axes."""
        lost, toward = self.lost_n(turning.angle_rad)
        return np.stack([lost * np.cos(toward), lost * np.sin(toward)], axis=1)

    def lost_n(self, pinion_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what the ball in the spall, or next to it, loses (k,) [N], and its angle from horizontal (k,)."""
        sense, shaft_rad = np.sign(self.order), abs(self.order) * pinion_rad
        cage_rad = self.cage.angle_rad(shaft_rad)
        place_rad, apart_m, inside = self._nearest(shaft_rad, cage_rad)
        toward = sense * place_rad + self.zone.direction_rad
        bearing = self.spall.bearing
        squeezed = bearing.squeezed_m(self.zone.deflection_m, place_rad)
        return self.spall.lost_n(squeezed, self.spall.sunk_m(apart_m, inside)), toward

    def _nearest(self, shaft_rad: FloatArray, cage_rad: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray | bool]:
        """Return of the nearest ball its angle from the load, its way to the middle of the spall, and on which race."""
        spall, bearing = self.spall, self.spall.bearing
        if spall.element == "ball":
            turned = spall.place_rad + bearing.spin_per_cage * (cage_rad - self.cage.start_rad)
            race = np.rint(turned / pi)
            apart = 0.5 * bearing.ball_diameter_m * (turned - pi * race)
            return cage_rad, apart, race % 2.0 == 1.0
        inside = spall.element == "inner"
        place = spall.place_rad + (shaft_rad if inside else 0.0)
        apart = cage_rad - place
        apart -= bearing.spacing_rad * np.rint(apart / bearing.spacing_rad)
        radius = bearing.inner_radius_m if inside else bearing.outer_radius_m
        return np.asarray(place + apart), radius * apart, inside

    @property
    def ever_pushes(self) -> bool:
        """Whether any ball can lose load in it."""
        spall, bearing = self.spall, self.spall.bearing
        if spall.depth_m == 0.0:  # a sham
            return False
        half = bearing.half_zone_rad(self.zone.deflection_m)
        if spall.element != "outer":
            return half > 0.0
        reach = half + 0.5 * spall.length_m / bearing.outer_radius_m
        return half > 0.0 and cos(spall.place_rad) > cos(min(reach, pi))


def mean_zone(spall: RollingSpall, force_n: FloatArray) -> ZoneOfLoad:
    """Return the zone of load under the mean force (2,) of the shaft on its seat, horizontal and vertical [N]."""
    size = float(np.hypot(force_n[0], force_n[1]))
    return ZoneOfLoad(float(np.arctan2(force_n[1], force_n[0])), spall.bearing.deflection_m(size))
