"""What a state and the checks ask a kind of damage before anything is drawn: the common part of all such sections."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias, get_args

from siggen.keys.problems import BRANCHES
from siggen.keys.section import Section
from siggen.keys.teeth import TeethValue

HitTeeth: TypeAlias = Iterator[tuple[str, str, TeethValue]]
"""Keys that name teeth, the gear they belong to, and how many or which ones they name."""


class DamageSection(Section):
    """Base of the sections of damage; what is said here holds for pits on neighbouring teeth of one gear."""

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Make the kind known to the messages, in whose paths it is no key."""
        BRANCHES.update(get_args(cls.model_fields["kind"].annotation))

    @classmethod
    def default_fault(cls, read: Callable[[str], object]) -> str:  # noqa: ARG003 - of use where a section holds several kinds
        """Return the fault of a state with such damage; `read` gives its keys, which are not checked yet."""
        return "pitting"

    @property
    def has_spalls(self) -> bool:
        """Whether a state with it may be called spalling."""
        return False

    @property
    def may_be_pitting(self) -> bool:
        """Whether a state with it may be called pitting."""
        return not self.has_spalls

    @property
    def drawn_edges(self) -> bool:
        """Whether each damage has an edge radius of its own; else all have that of the section dynamics."""
        return False

    def hit_teeth(self) -> HitTeeth:
        """Yield what names teeth."""
        yield "teeth", getattr(self, "gear"), getattr(self, "teeth")  # noqa: B009 - keys of most kinds, not of all

    def key_that_adds_nothing(self, milder: DamageSection) -> str | None:  # noqa: ARG002
        """Return the key by which it adds nothing to the milder damage that it contains, or None if it adds some."""
        return None

    def parallel_edges(self, face_width_mm: float) -> tuple[bool, bool]:  # noqa: ARG002
        """Return whether all its spalls are rectangles with edges parallel to the axis, and whether one may go through.

        "Through" is the whole face. Pits have neither.
        """
        return False, False
