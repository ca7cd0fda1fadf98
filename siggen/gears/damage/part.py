"""One part of a state's damage, on whatever it acts: a tooth, all flanks of a gear, a bearing.

A part that acts on one tooth answers `siggen.gears.damage.tooth_damage.ToothDamage` too. What acts elsewhere has a
protocol of its own, beside the physics that asks for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple, Protocol, TypeAlias

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
