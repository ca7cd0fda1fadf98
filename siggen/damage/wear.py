"""Wear of both gears: keys of its depth, and of the load under which it grew."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

import pyarrow as pa
from pydantic import Field

from siggen.damage.fault import Fault, HitTeeth
from siggen.damage.flank_place import MODULE
from siggen.damage.flank_wear import LABEL_POINTS, WornFlanks, worn_until
from siggen.damage.growth import Growth
from siggen.damage.part import Parts
from siggen.errors import Problem
from siggen.gears.gear_pair import GearPair
from siggen.keys.column import MICROMETRE, Column, list_of
from siggen.keys.drawing import draw
from siggen.keys.number import Number, Within, bounds, constant, number_text
from siggen.keys.scaling import Grows
from siggen.keys.usual import Usual
from siggen.names import Side

DEEPEST_SHARE = 0.1
"""Of the module: beyond, a tooth is no involute with some wear any more (severe wear: 0.02 to 0.05, from memory)."""
COEFFICIENT_M2_PER_N = 1e-17
"""Mild wear of lubricated steel: 1e-18 to 1e-16 (Flodin and Andersson 1997, from memory)."""
OF_REFERENCE = 0.5
"""Share of the pair's reference force that is taken for its own load: 1 GPa between steel flanks in mid path."""
DEPTHS_UM = Column(
    "wear_depths_um",
    list_of(pa.float64()),
    MICROMETRE,
    f"depth of wear at {LABEL_POINTS} even places along the line of action, from the root's end of the active flank to "
    "the tip; empty for other damage",
)


class FlankWear(Fault):
    """Wear of all teeth, after Archard, under one load."""

    words: ClassVar[tuple[str, ...]] = ("wear",)
    acts: ClassVar[str] = (
        "Wear takes material from all teeth alike, most where they slide most under load, after Archard; it changes "
        "the path of the teeth and weakens none."
    )
    columns: ClassVar[tuple[Column, ...]] = (DEPTHS_UM,)
    needs_pairs: ClassVar[bool] = True

    kind: Literal["wear"] = "wear"
    depth_um: Annotated[Number, Within(above=0), Usual(0.5, 500), Grows(MODULE)] = Field(
        description="largest on any flank, mostly at the root of the pinion"
    )

    def hit_teeth(self) -> HitTeeth:
        """Yield nothing: no tooth is named."""
        return iter(())

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return the key of a depth that never passes that of the milder state."""
        if not isinstance(milder, FlankWear):
            return None
        return "depth_um" if bounds(self.depth_um)[1] <= bounds(milder.depth_um)[0] else None

    def drawn(self, growth: Growth) -> Parts:
        """Return the worn flanks of this state; what is nowhere less deep takes the place of milder wear."""
        own = draw(self, growth.place_of(FlankWear), "wear")
        pair = growth.pair
        worn = worn_until(
            pair,
            growth.load_at_rest(OF_REFERENCE * pair.reference_force_n),
            COEFFICIENT_M2_PER_N,
            depth_m=1e-6 * constant(own.depth_um),
        )
        return WornFlanks(Side.DRIVER, tuple(worn.pinion_m.tolist())), WornFlanks(
            Side.DRIVEN, tuple(worn.gear_m.tolist())
        )

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield wear that may go deeper than a share of the module."""
        allowed_um = 1e6 * DEEPEST_SHARE * pair.pinion.module_m
        share = f"{DEEPEST_SHARE:g} of the module"
        if bounds(self.depth_um)[1] > allowed_um:
            yield Problem("depth_um", number_text(self.depth_um), f"allowed: up to {allowed_um:.6g} um, {share}")
