"""What every kind of damage answers about itself: the protocol through which all others see damage.

A kind is a file beside this one with a frozen class. Most kinds lie on a flank inside an outline and take their answers
from `siggen.gears.damage.on_flank`; a kind without outline, such as a crack in the root, answers for itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Protocol, TypeAlias, TypeGuard

from siggen.arrays import FloatArray
from siggen.gears.damage.outlines import Outline
from siggen.gears.damage.part import Part, Refusal
from siggen.gears.damage.row_columns import THROUGH_M
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.names import Side


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
        """Return what it takes from contact and sections, as rows of `siggen.gears.damage.row_columns`; may be none."""

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
