"""One part of a state's damage, on whatever it acts: a tooth, all flanks of a gear, a bearing.

A part that acts on one tooth answers `siggen.damage.part.ToothDamage` too. What acts elsewhere has a
protocol of its own, beside the physics that asks for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeAlias, TypeGuard

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.outlines import Outline
from siggen.damage.row_columns import THROUGH_M
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.names import Side

NO_GEAR, NO_TOOTH = "none", -1
"""Gear and tooth of a part that belongs to no gear, or to all teeth of one."""


class Refusal(NamedTuple):
    """Why a part cannot be: the attribute to blame, what came, what is allowed."""

    name: str
    received: str
    allowed: str


class Part(Protocol):
    """One part; immutable, and equal to another one that answers the same.

    Attributes
    ----------
    gear : Side
        `NO_GEAR` for what is on no gear.
    tooth : int
        Index, from 0; `NO_TOOTH` for all teeth of the gear, or none.
    kind : str
        What it is, as in the table of damage: 'pit', 'spall'.
    """

    @property
    def gear(self) -> str: ...  # noqa: D102 - see the class

    @property
    def tooth(self) -> int: ...  # noqa: D102

    @property
    def kind(self) -> str: ...  # noqa: D102

    def hides(self, other: Part) -> bool:
        """Return whether it takes the place of a milder part, which then is no part of its own any more."""

    def sham(self) -> Part:
        """Return a part in the same place that removes nothing: everything is asked of it, and nothing follows."""

    def own_problems(self) -> Iterator[Refusal]:
        """Yield what is impossible whatever gearbox it is in."""

    def table_row(self) -> dict[str, object]:
        """Return its row of the table of damage by column, lengths in mm, but for the record's number.

        Columns that it does not name are 0 or empty.
        """


Parts: TypeAlias = tuple[Part, ...]


def teeth_of(parts: Iterable[Part], side: Side) -> list[int]:
    """Return the single teeth of a gear that have a part, ascending."""
    return sorted({one.tooth for one in parts if one.gear == side and one.tooth != NO_TOOTH})


# What every kind of damage answers about itself: the protocol through which all others see damage.
#
# A kind is a file beside this one with a frozen class. Most kinds lie on a flank inside an outline and take their
# answers from `siggen.damage.on_flank`; a kind without outline, such as a crack in the root, answers for itself.


class ToothDamage(Part, Protocol):
    """One damage of one tooth; immutable, and equal to another one that answers the same.

    Attributes
    ----------
    gear : Side
        Which gear of its mesh has it.
    outline : Ellipse, Polygon or None
        On the plane of height and face, to draw and to measure it; None for a damage that shows on no flank.
    depth_m : float
        Largest depth normal to the tooth's centre plane [m].
    """

    @property
    def gear(self) -> Side: ...  # noqa: D102 - see the class

    @property
    def outline(self) -> Outline | None: ...  # noqa: D102

    @property
    def depth_m(self) -> float: ...  # noqa: D102

    def rows(self) -> list[tuple[float, ...]]:
        """Return what it takes from contact and sections, as rows of `siggen.damage.row_columns`; may be none."""

    def tooth_compliance_m_per_n(
        self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray
    ) -> FloatArray | float:
        """Return what it adds to the compliance of its tooth, sound (k,), beside its rows, (k,) or a number [m/N]."""

    def profile_arc_m(self, gear: SpurGear) -> float:
        """Return the longest arc along the involute that a line along the profile crosses [m]; 0 without outline."""

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        """Yield what is impossible on a pair; asked only where it has no problem of its own."""


class UnevenDamage(ToothDamage, Protocol):
    """Damage that softens its tooth in a part of the face, and says where."""

    @property
    def is_uneven(self) -> bool: ...  # noqa: D102

    def slice_compliance_m_per_n(
        self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray, slices: int
    ) -> FloatArray:
        """Return what it adds to a tooth, sound (k,), that were everywhere as in a slice of the face, (k, n) [m/N]."""


Damage: TypeAlias = tuple[ToothDamage, ...]


def on_teeth(parts: Iterable[Part]) -> Damage:
    """Return the parts that act on single teeth."""
    return tuple(one for one in parts if acts_on_tooth(one))


def acts_on_tooth(part: Part) -> TypeGuard[ToothDamage]:
    """Whether a part answers for its tooth; any other acts elsewhere."""
    return hasattr(part, "tooth_compliance_m_per_n")


def acts_unevenly(part: ToothDamage) -> TypeGuard[UnevenDamage]:
    """Whether damage softens its tooth in a part of the face; any other does so evenly, or not at all."""
    return bool(getattr(part, "is_uneven", False))


@dataclass(frozen=True, slots=True)
class DamageProblem:
    """One reason why a damage cannot be: which one of the damage, what came, what is allowed.

    `name` is the attribute to blame, or 'contact' for a contact length that is wholly lost.
    """

    index: int
    received: str
    allowed: str
    kind: str = "pit"
    name: str = ""

    def __str__(self) -> str:
        """One line: pit or spall, what was received, what is allowed."""
        return f"{self.kind} {self.index}: received {self.received}; allowed: {self.allowed}"


def pits_of(damage: Iterable[ToothDamage], side: Side, tooth: int) -> Damage:
    """Return the damage on one tooth."""
    return tuple(one for one in damage if one.gear == side and one.tooth == tooth)


def damaged_teeth(damage: Iterable[ToothDamage], side: Side) -> tuple[int, ...]:
    """Return the damaged teeth of a gear, ascending."""
    return tuple(sorted({one.tooth for one in damage if one.gear == side}))


def goes_through(damage: ToothDamage) -> bool:
    """Whether material is gone through the whole tooth: its sections are no business of rows."""
    return damage.depth_m >= THROUGH_M


def has_extent(damage: ToothDamage) -> bool:
    """Whether a damage has depth, height and width; an outline without one is no damage (a limit case of the tests)."""
    if damage.outline is None:
        return True
    (low, high), (left, right) = damage.outline.height_range_m, damage.outline.face_range_m
    return damage.depth_m != 0.0 and low != high and left != right


# The metal that a part takes from a whole tooth, whose gear is out of balance without it.
#
# Derived. A tooth of half thickness h at the radius r covers the angles up to ± asin(h/r) there, so the first moment
# of the metal between two circles, along the tooth's centre line, is the integral of 2 r h over r, times width and
# density. What a pit takes is left out: 0.1 g against 5 g of a tooth.

STEEL_KG_M3 = 7850.0
RADII = 1001
"""Of the quadrature: trapezoids 7 µm wide on a tooth of 7 mm, 1e-6 of the moment."""


class LostMetal(Part, Protocol):
    """A part without which some of its tooth is gone, from the tip down."""

    def lost_width_m(self, gear: SpurGear, radius_m: FloatArray, face_width_m: float) -> FloatArray:
        """Return over which width of the face metal is gone at radii (k,) above the lowest, (k,) [m]."""

    def lost_from_m(self, gear: SpurGear) -> float:
        """Return the radius above which metal is gone [m]."""


LostMetals: TypeAlias = tuple[LostMetal, ...]


def without_metal(parts: Iterable[Part]) -> LostMetals:
    """Return the parts without which some of a tooth is gone."""
    return tuple(one for one in parts if _takes_metal(one))


def lost_moment_kg_m(gear: SpurGear, part: LostMetal, face_width_m: float) -> float:
    """Return mass times distance from the axis of what is gone, along the tooth's centre line [kg m]."""
    radius = np.linspace(part.lost_from_m(gear), gear.tip_radius_m, RADII)
    moment = 2.0 * radius * half_thickness_m(gear, radius) * part.lost_width_m(gear, radius, face_width_m)
    return STEEL_KG_M3 * float(np.trapezoid(moment, radius))


def half_thickness_m(gear: SpurGear, radius_m: FloatArray) -> FloatArray:
    """Return the half thickness of a whole tooth at radii (k,) from root to tip: rack-cut fillet and involute [m]."""
    start = float(gear.radius_m(gear.involute_start_roll_rad))
    slopes = np.linspace(0.5 * np.pi, gear.involute_start_gamma_rad, RADII)
    fillet = np.array([gear.trochoid_point_m(slope) for slope in slopes])
    below = np.interp(radius_m, np.hypot(*fillet.T), fillet[:, 1])
    flank = gear.half_thickness_m(gear.roll_at_radius(np.maximum(radius_m, start)))
    return np.where(radius_m < start, below, flank)


def _takes_metal(part: Part) -> TypeGuard[LostMetal]:
    return hasattr(part, "lost_width_m")
