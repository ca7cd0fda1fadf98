"""Cracks in the roots of teeth: one on each damaged tooth, deeper in every more severe state."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from math import degrees, inf, radians
from typing import Annotated, ClassVar, Literal

import pyarrow as pa
from pydantic import Field

from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import DAMAGED_GEAR, AnyGear
from siggen.faults.growth import Growth
from siggen.gears.damage.crack import RootCrack
from siggen.gears.damage.crack_law import ANGLE_RANGE_RAD, DEEPEST_SHARE
from siggen.gears.damage.part import Parts
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.root_chord import root_chord
from siggen.keys.column import MILLIMETRE, Column
from siggen.keys.drawing import corners, draw
from siggen.keys.number import Number, Within, bounds, constant, number_text
from siggen.keys.teeth import DAMAGED_TEETH, Teeth, TeethValue
from siggen.keys.usual import Usual
from siggen.names import PINION

LEAST_DEG, MOST_DEG = (round(degrees(angle)) for angle in ANGLE_RANGE_RAD)
LONGEST_RUN = 1e3
"""Faces over which a depth may fall to nothing; beyond, it is the same everywhere."""
CRACK_KEYS = {"depth_m": "depth_share", "angle_rad": "angle_deg", "run_m": "face_share", "gear": "gear"}


class RootCracks(Fault):
    """A crack in the root of each damaged tooth."""

    words: ClassVar[tuple[str, ...]] = ("crack",)
    acts: ClassVar[str] = (
        "Cracks in roots soften their teeth, by a law fitted to finite elements, and leave contact and mass as "
        "they are; loads on the back flank close them, except under dynamics.mesh.law: linear."
    )
    columns: ClassVar[tuple[Column, ...]] = (
        Column("crack_angle_deg", pa.float64(), "deg", "of a crack, between it and the tooth's centre line"),
        Column(
            "crack_run_mm",
            pa.float64(),
            MILLIMETRE,
            "of a crack, place across the face where its depth falls to 0; 0: the same depth everywhere",
        ),
    )

    kind: Literal["crack"] = "crack"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    depth_share: Annotated[Number, Within(above=0, most=DEEPEST_SHARE), Usual(0.02, 0.5)] = Field(
        description="largest depth along the crack over the chord of the root, whose ends have tangents at 30 degrees "
        "to the tooth's centre line (ISO 6336-3)"
    )
    angle_deg: Annotated[Number, Within(least=LEAST_DEG, most=MOST_DEG)] = Field(
        default=45.0, description="between the crack and the tooth's centre line; it runs straight into the body"
    )
    face_share: Annotated[Number | None, Within(above=0, most=LONGEST_RUN, words=(None,)), Usual(0.01, 1)] = Field(
        default=None, description=(
            "where the depth, which falls from one end, comes to 0, over the face width; null: the same depth "
            "everywhere"
        ),
    )  # fmt: skip

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'depth_share' for cracks as deep and as long as those of the milder state on the same teeth."""
        if not isinstance(milder, RootCracks) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "depth_share" if self._sizes == milder._sizes else None

    def contradictions(self, milder: Fault) -> Iterator[Problem]:
        """Yield another angle than that of the milder crack on the same gear, less depth or a shorter run."""
        if not isinstance(milder, RootCracks) or milder.gear != self.gear or _apart(milder.teeth, self.teeth):
            return
        kept = "as in the milder state, or like in place of grows"
        if milder.angle_deg != self.angle_deg:
            allowed = f"allowed: {number_text(milder.angle_deg)}, {kept}"
            yield Problem("angle_deg", number_text(self.angle_deg), allowed)
        for key, before in milder._sizes.items():
            own = self._sizes[key]
            if own[0] < before[0] or own[1] < before[1]:
                least = "null" if before[0] == inf else f"at least {_span(before)}"
                yield Problem(key, _span(own), f"allowed: {least}, {kept}")

    def drawn(self, growth: Growth) -> Parts:
        """Return a crack in each damaged tooth: the milder one, where it has one, deeper and longer."""
        return tuple(self._grown(growth, tooth) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with a crack at every combination of its bounds."""
        for corner in corners(partial(draw, self, path="")):
            try:
                crack = corner._on_tooth(pair, 0)
            except ValueError as error:
                yield Problem("gear", str(error), "allowed: a gear whose root has one")
                return
            for problem in crack.place_problems(pair):
                yield Problem(CRACK_KEYS[problem.name], problem.received, f"allowed: {problem.allowed}")

    @property
    def _sizes(self) -> dict[str, tuple[float, float]]:
        run = (inf, inf) if self.face_share is None else bounds(self.face_share)
        return {"depth_share": bounds(self.depth_share), "face_share": run}

    def _grown(self, growth: Growth, tooth: int) -> RootCrack:
        one = draw(self, growth.place(self.gear, RootCracks), f"crack.{self.gear}.{tooth}")
        new = one._on_tooth(growth.pair, tooth)
        for old in growth.before:
            if isinstance(old, RootCrack) and (old.gear, old.tooth) == (new.gear, new.tooth):
                deepest, longest = max(old.depth_m, new.depth_m), max(old.run_m, new.run_m)
                return RootCrack(new.gear, tooth, deepest, old.angle_rad, longest)
        return new

    def _on_tooth(self, pair: GearPair, tooth: int) -> RootCrack:
        """Return the crack of drawn numbers on a tooth."""
        depth_m = constant(self.depth_share) * root_chord(pair.member(self.side)).length_m
        run_m = inf if self.face_share is None else constant(self.face_share) * pair.face_width_m
        return RootCrack(self.side, tooth, depth_m, radians(constant(self.angle_deg)), run_m)


def _apart(teeth: TeethValue, others: TeethValue) -> bool:
    """Whether two lists of teeth share none; counts begin at one tooth and share some."""
    return isinstance(teeth, tuple) and isinstance(others, tuple) and not set(teeth) & set(others)


def _span(values: tuple[float, float]) -> str:
    low, high = values
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"
