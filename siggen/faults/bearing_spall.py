"""A spall in a rolling bearing of a shaft: in a race, or on a ball."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from math import radians
from typing import Annotated, ClassVar, Literal

import pyarrow as pa
from pydantic import Field

from siggen.dynamics.bearings.ball_bearing import BallBearing
from siggen.dynamics.bearings.bearing_spall import RollingSpall, in_bearings
from siggen.errors import Problem
from siggen.faults.ball_geometry import BallGeometry
from siggen.faults.fault import Fault, HitTeeth
from siggen.faults.flank_place import MM
from siggen.faults.growth import Growth
from siggen.gears.damage.part import Parts
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.column import MILLIMETRE, Column
from siggen.keys.drawing import corners, draw
from siggen.keys.number import Number, Within, bounds, constant
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.seeding import Stream, named_uniforms

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
        description="one of the two on that shaft: pinion_bearing, gear_bearing, of a machine SHAFT_bearing",
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
