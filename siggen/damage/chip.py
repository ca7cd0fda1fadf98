"""A tooth that has lost its tip over the whole face, or all of it.

Derived. What is left ends in a corner at a smaller radius: the pair's contact ends where that corner leaves, and then
the corner itself is in contact, as those of whole tips are beside the path (`corner_contact`). Where a tooth is gone
its pair does not exist: for 2 - ε base pitches the corners of the pairs before and after carry. Between them the driven
gear lags by the gap at which both touch, so corners are followed as far as that.

Material above a contact carries no load, so what is left of the tooth is as stiff as before; a corner is taken to be as
stiff as the flank at the pair's nominal position. Both flanks of a tooth lose their tip. Without the metal its gear is
out of balance (`siggen.damage.part`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from math import inf, isfinite, sqrt
from typing import Annotated, ClassVar, Literal

import numpy as np
import pyarrow as pa
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.damage.covering import holds
from siggen.damage.fault import Fault
from siggen.damage.flank_damage import pit_rows
from siggen.damage.flank_place import DAMAGED_GEAR, MM, MODULE, AnyGear
from siggen.damage.growth import Growth
from siggen.damage.heights import flank_heights
from siggen.damage.outlines import Outline, Polygon
from siggen.damage.part import Damage, Part, Parts, Refusal, ToothDamage, acts_on_tooth, goes_through
from siggen.damage.row_columns import COLUMNS, THROUGH_M
from siggen.damage.sham import SHAM, Sham
from siggen.damage.union import lengths_covered
from siggen.errors import Problem, mm
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import CORNER_REACH_PITCHES, touching_gap_m
from siggen.gears.spur_gear import SpurGear
from siggen.keys.column import MILLIMETRE, Column
from siggen.keys.drawing import draw
from siggen.keys.number import Number, Within, bounds, number_text
from siggen.keys.scaling import Grows
from siggen.keys.teeth import DAMAGED_TEETH, Teeth, most_teeth
from siggen.keys.usual import Usual
from siggen.names import EITHER, PINION, Side

# A tooth that has lost its tip over a part of the face only, by a step or by a corner that is broken off.
#
# Derived. In the plane of height and face the tip is gone inside a polygon; a corner is cut by a plane, whose trace is
# straight there. What is gone is gone through the tooth, so its outline is damage without a floor: slices inside end
# at a lower tip and find an edge there, the others carry (`siggen.mesh.face_slices`). Where gears tilt the
# moment of the load that moves across the face turns them.
#
# Material above a contact carries no load, so the tooth is as stiff as before under a contact below the line. What
# stands beside a chip is taken to be as stiff as a whole tooth too. Where a part of the tooth is gone down to its root
# what stands is a tooth of its width: its compliance is that of the whole over the share that stands.

BEYOND_TIP_MODULES = 0.1
"""How far above the tip outlines reach: there is no land behind a chip."""


@dataclass(frozen=True, slots=True)
class PartChip:
    """A tooth without a part of its tip.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    height_m : float
        What is lost from the tip down, along the radius, at the end of the face where it begins [m].
    width_m : float
        Over which width of the face from that end, face coordinate 0 [m].
    outline : Polygon
        What is gone, in the plane of height and face (`lost_outline`).
    whole_height, whole_face : bool
        Whether the tooth is gone down to its root there, and whether that is all of the face.
    """

    gear: Side
    tooth: int
    height_m: float
    width_m: float
    outline: Polygon
    whole_height: bool = False
    whole_face: bool = False

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "broken_tooth" if self.whole_height else "chip"

    @property
    def depth_m(self) -> float:
        """Depth that stands for a tooth that is gone through and through [m]."""
        return THROUGH_M

    def rows(self) -> list[tuple[float, ...]]:
        """Return the rows of what is gone."""
        return self.outline.rows(THROUGH_M, dish=False)

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> FloatArray:  # noqa: ARG002
        """Return what is added to the compliance of its tooth, sound (k,), under an even load on what stands [m/N]."""
        left = standing_share(pair, self.gear, (self,))
        return sound_m_per_n * ((1.0 - left) / left if left > 0.0 else 0.0)

    def profile_arc_m(self, gear: SpurGear) -> float:  # noqa: ARG002
        """Return 0: no flank sinks into it."""
        return 0.0

    def lost_from_m(self, gear: SpurGear) -> float:
        """Return the radius above which it is gone [m]."""
        return max(gear.tip_radius_m - self.height_m, gear.root_radius_m)

    def lost_width_m(self, gear: SpurGear, radius_m: FloatArray, face_width_m: float) -> FloatArray:  # noqa: ARG002
        """Return over which width it is gone at radii (k,) above its line [m]."""
        return np.full(radius_m.shape, self.width_m)

    def hides(self, other: Part) -> bool:
        """Return whether `other` lies wholly on what is gone of the same tooth; False where it is unsure."""
        if (other.gear, other.tooth) != (self.gear, self.tooth) or not acts_on_tooth(other) or other.outline is None:
            return False
        return holds([*self.rows(), *self._gone_around(other.outline).rows(THROUGH_M, dish=False)], other.rows())

    def _gone_around(self, outline: Outline) -> Polygon:
        """Return what is gone, with all beyond the tip and the ends of the face that an outline reaches: no metal."""
        line = self.outline.corners_m[0][0]
        (_, high), (left, right) = outline.height_range_m, outline.face_range_m
        top, first = max(high, self.outline.height_range_m[1]), min(left, 0.0) - self.width_m
        last = max(right, 0.0) + self.width_m if self.whole_face else self.width_m
        return Polygon(((line, first), (line, last), (top, last), (top, first)), "rectangle")

    def sham(self) -> Sham:
        """Return a sham in its place."""
        return Sham(self)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield a height or a width that is none."""
        for name in ("height_m", "width_m"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0.0):
                yield Refusal(name, f"{name.removesuffix('_m')} {mm(value)}", "finite and above 0")

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        """Yield a tooth that there is not, a height beyond the tooth, a width beyond the face."""
        gear = pair.member(self.gear)
        if not 0 <= self.tooth < gear.teeth:
            yield Refusal("tooth", f"tooth {self.tooth!r}", f"0 to {gear.teeth - 1}")
        most = gear.tip_radius_m - gear.root_radius_m
        if self.height_m > most:
            yield Refusal("height_m", f"height {mm(self.height_m)}", f"up to {mm(most)}, the height of the tooth")
        if self.width_m > pair.face_width_m:
            allowed = f"up to {mm(pair.face_width_m)}, the face width"
            yield Refusal("width_m", f"width {mm(self.width_m)}", allowed)

    def table_row(self) -> dict[str, object]:
        """Return outline, height and width of what is gone in mm."""
        outline = self.outline
        across, along = outline.semi_axes_m
        return {
            "gear": self.gear,
            "tooth": self.tooth,
            "kind": self.kind,
            "shape": outline.shape,
            "height_mm": 1e3 * outline.height_m,
            "face_mm": 1e3 * outline.face_m,
            "semi_axis_face_mm": 1e3 * across,
            "semi_axis_profile_mm": 1e3 * along,
            "depth_law": "none",
            "polygon_face_mm": [1e3 * face for _, face in outline.corners_m],
            "polygon_height_mm": [1e3 * height for height, _ in outline.corners_m],
            "chip_height_mm": 0.0 if self.whole_height else 1e3 * self.height_m,
            "chip_width_mm": 1e3 * self.width_m,
        }


def lost_outline(gear: SpurGear, height_m: float, width_m: float) -> Polygon:
    """Return what is gone of a tip, from face coordinate 0 on.

    Parameters
    ----------
    gear : SpurGear
    height_m : float
        From the tip down, along the radius [m].
    width_m : float
        Across the face [m].
    """
    tip, line = float(gear.height_m(gear.tip_roll_rad)), line_height_m(gear, height_m)
    above = tip + BEYOND_TIP_MODULES * gear.module_m
    return Polygon(((line, 0.0), (line, width_m), (above, width_m), (above, 0.0)), "rectangle")


def standing_share(pair: GearPair, side: Side, damage: Iterable[ToothDamage]) -> float:
    """Return the share of the face over which a tooth still stands on its root, beside what is gone through it."""
    rows = pit_rows(one for one in damage if goes_through(one))
    start = np.array([flank_heights(pair.member(side))[0]])
    gone = lengths_covered(start, rows, start, np.empty((0, COLUMNS)), pair.face_width_m)
    return 1.0 - float(gone[0]) / pair.face_width_m


def line_height_m(gear: SpurGear, height_m: float) -> float:
    """Return the height above the base circle, along the tooth's axis, of the line down to which a tip is lost [m].

    Below the base circle, where no flank is, along the radius.
    """
    above_base = gear.tip_radius_m - height_m - gear.base_radius_m
    return (
        above_base if above_base <= 0.0 else float(gear.height_m(gear.roll_at_radius(above_base + gear.base_radius_m)))
    )


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


# Chipped and broken teeth: how much of a tooth is gone from its tip down, over how much of the face.

WHOLE = "whole"
HEIGHT = Column(
    "chip_height_mm", pa.float64(), MILLIMETRE, "height lost from a tooth's tip; 0 for other damage, or all"
)
WIDTH = Column(
    "chip_width_mm",
    pa.float64(),
    MILLIMETRE,
    "over which width of the face, from its end at 0, it is lost; 0 for other damage, or all",
)


class ChippedTeeth(Fault):
    """Teeth without their tips over the face or a part of it, or teeth that are gone."""

    words: ClassVar[tuple[str, ...]] = ("chip", "broken_tooth")
    outranked: ClassVar[tuple[str, ...]] = ("pitting", "spalling")
    acts: ClassVar[str] = (
        "Chipped teeth end at a lower tip, so their pairs leave the mesh early; where a tooth is gone, the corners of "
        "its neighbours carry, and flanks part and strike."
    )
    columns: ClassVar[tuple[Column, ...]] = (HEIGHT, WIDTH)
    needs_pairs: ClassVar[bool] = True

    kind: Literal["chip"] = "chip"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    height_mm: Annotated[Number | Literal["whole"], Within(above=0, words=(WHOLE,)), Usual(0.05, 30), Grows(MODULE)] = (
        Field(description="lost from the tip down, along the radius; whole: the tooth is gone")
    )
    face_share: Annotated[Number | None, Within(above=0, most=1, words=(None,)), Usual(0.01, 1)] = Field(
        default=None, description="share of the face that lost it, from one end; null: the whole face"
    )

    @classmethod
    def default_word(cls, read: Callable[[str], object]) -> str:
        """Return broken_tooth for teeth that are gone."""
        return "broken_tooth" if read("height_mm") == WHOLE else "chip"

    @property
    def own_words(self) -> tuple[str, ...]:
        """Teeth that are gone are broken; of others one may say so."""
        return ("broken_tooth",) if self.height_mm == WHOLE else self.words

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'height_mm' for no more lost than the milder state has lost on the same teeth."""
        if not isinstance(milder, ChippedTeeth) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        less = _heights_m(self)[1] <= _heights_m(milder)[0] and _shares(self)[1] <= _shares(milder)[0]
        return "height_mm" if less else None

    def drawn(self, growth: Growth) -> Parts:
        """Return what is lost of each damaged tooth, all of them alike."""
        own = draw(self, growth.place(self.gear, ChippedTeeth), f"chip.{self.gear}")
        return tuple(own._on_tooth(growth.pair, tooth) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield more than a tooth, and neighbours of which none meets its mate: no corner would carry between them."""
        deepest_m, most_m = _heights_m(self)[1], tooth_height_m(pair.member(self.side))
        if not isinstance(self.height_mm, str) and deepest_m > most_m:
            allowed = f"allowed: up to {1e3 * most_m:.6g}, the height of the tooth; or {WHOLE}"
            yield Problem("height_mm", number_text(self.height_mm), allowed)
        elif (
            self._may_take_the_face
            and not keeps_contact(pair, self.side, deepest_m)
            and _has_neighbours(most_teeth(self.teeth), pair.member(self.side).teeth)
        ):
            allowed = (
                "allowed: teeth that are no neighbours, or heights that leave some of the flank that meets the mate"
            )
            yield Problem("teeth", str(self.teeth), allowed)

    def reach_pitches(self, pair: GearPair) -> float:
        """Return how far beside the path of contact corners carry where most is lost."""
        if not self._may_take_the_face:
            return CORNER_REACH_PITCHES
        gears = Side if self.gear == EITHER else (self.side,)
        return max(corner_reach_pitches(pair, side, _heights_m(self)[1]) for side in gears)

    @property
    def _may_take_the_face(self) -> bool:
        """Whether the same height may be lost over the whole face."""
        return _shares(self)[1] >= 1.0

    def _on_tooth(self, pair: GearPair, tooth: int) -> WholeChip | PartChip:
        """Return the chip of drawn numbers on a tooth."""
        share, whole = _shares(self)[0], isinstance(self.height_mm, str)
        if self._may_take_the_face:
            return WholeChip(self.side, tooth, _heights_m(self)[0])
        gear, width_m = pair.member(self.side), share * pair.face_width_m
        height_m = tooth_height_m(gear) if whole else _heights_m(self)[0]
        outline = lost_outline(gear, height_m, width_m)
        return PartChip(self.side, tooth, height_m, width_m, outline, whole)


def _shares(section: ChippedTeeth) -> tuple[float, float]:
    """Return the least and the largest share of the face."""
    return (1.0, 1.0) if section.face_share is None else bounds(section.face_share)


def _heights_m(section: ChippedTeeth) -> tuple[float, float]:
    """Return the least and the largest height that is lost [m]."""
    if isinstance(section.height_mm, str):
        return inf, inf
    low, high = bounds(section.height_mm)
    return MM * low, MM * high


def _has_neighbours(teeth: int | tuple[int, ...], count: int) -> bool:
    """Return whether neighbouring teeth of a gear are hit."""
    if isinstance(teeth, int):
        return teeth > 1
    return any((tooth + 1) % count in teeth for tooth in teeth)
