"""What the rest of siggen asks a kind of damage: the common part of all sections of damage.

A kind is one module here: its section with the answers below. Where its physics is new, one module in `siggen.damage`
holds it, which knows no configuration. `kinds.py` names the kind; nothing else knows kinds.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from typing import Any, ClassVar, TypeAlias, get_args

from siggen.damage.growth import Growth
from siggen.damage.part import Damage, Parts
from siggen.errors import Problem
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import CORNER_REACH_PITCHES
from siggen.keys.column import Column
from siggen.keys.number import Number
from siggen.keys.problems import BRANCHES
from siggen.keys.section import Section
from siggen.keys.teeth import TeethValue
from siggen.names import Side

HitTeeth: TypeAlias = Iterator[tuple[str, str, TeethValue]]
"""Keys that name teeth, the gear they belong to, and how many or which ones they name."""


class Fault(Section):
    """Base of the sections of damage; its field `kind` is a Literal of one word.

    Paths of problems count from the state's damage. Pairs are given at the bounds of the gears' distributions; what is
    asked about the damage holds at the bounds of its own, so that no gearbox can turn out impossible.
    """

    words: ClassVar[tuple[str, ...]] = ()
    """What a state with it may be called (`fault`); the first is the default."""

    outranked: ClassVar[tuple[str, ...]] = ()
    """What a state with it is not called any more, although it contains a milder one of that name."""

    nouns: ClassVar[str] = ""
    """What it consists of, in the plural, where it is material missing from a flank: for cards and messages."""

    acts: ClassVar[str] = ""
    """A sentence of the card on how it acts, where it is anything else."""

    one_flank: ClassVar[bool] = False
    """Whether each of its gears is a single one, never either of a mesh."""

    needs_bearings: ClassVar[bool] = False
    """Whether it acts on balls of bearings, which a planetary set has not."""

    columns: ClassVar[tuple[Column, ...]] = ()
    """Columns that its rows of the table of damage have beyond those of all kinds; 0 or empty in others' rows."""

    needs_pairs: ClassVar[bool] = False
    """Whether it acts through the shape of the flanks, which the law linear does not know."""

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Make the kind known to the messages, in whose paths it is no key.

        Raises
        ------
        TypeError
            If it does not say what a state with it may be called.
        """
        if not cls.words:
            raise TypeError(
                f"{cls.__name__}.words: received (); allowed: what a state with it may be called, one at least"
            )
        BRANCHES.add(cls.kind_word())

    @classmethod
    def kind_word(cls) -> str:
        """Return the word of its `kind:`."""
        return str(get_args(cls.model_fields["kind"].annotation)[0])

    @abstractmethod
    def drawn(self, growth: Growth) -> Parts:
        """Return what this state adds; what it hides of the milder state's damage goes by itself."""

    @abstractmethod
    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what cannot be about single damages."""

    def widest(self, pair: GearPair) -> Damage:  # noqa: ARG002
        """Return the damage that may together take the whole width of contact, without depth to speak of.

        As large as it may be; nothing where that is known only when it is drawn.
        """
        return ()

    @classmethod
    def default_word(cls, read: Callable[[str], object]) -> str:  # noqa: ARG003 - of use where a section holds several kinds
        """Return what a state with it is called by default; `read` gives its keys, which are not checked yet."""
        return cls.words[0]

    @property
    def own_words(self) -> tuple[str, ...]:
        """What a state with this very damage may be called."""
        return self.words

    @property
    def own_edge_radius(self) -> tuple[str, Number] | None:
        """Key and number of the radius [mm] if each damage draws one; else all have that of the section dynamics."""
        return None

    def reach_pitches(self, pair: GearPair) -> float:  # noqa: ARG002
        """Return how far beside the path of contact corners may carry at most [base pitches]."""
        return CORNER_REACH_PITCHES

    def hit_teeth(self) -> HitTeeth:
        """Yield what names teeth; as it stands, for damage on neighbouring teeth of one gear."""
        yield "teeth", getattr(self, "gear"), getattr(self, "teeth")  # noqa: B009 - keys of most kinds, not of all

    @property
    def hit_gear(self) -> str:
        """The gear that it is on, as the file calls it; empty for none."""
        return str(getattr(self, "gear", ""))

    @property
    def side(self) -> Side:
        """Which gear of its mesh that is, once it is drawn."""
        return Side(self.hit_gear)

    @property
    def hit_gears(self) -> tuple[str, ...]:
        """All gears that it names."""
        return (self.hit_gear,)

    def with_gears(self, name: Callable[[str], str]) -> Fault:
        """Return the same on a gear of another name."""
        return self.model_copy(update={"gear": name(self.hit_gear)}) if self.hit_gear else self

    @property
    def word(self) -> str:
        """What a state with it is called by default."""
        return self.default_word(lambda key: getattr(self, key, None))

    @property
    def position(self) -> str:
        """Where it is, in a word."""
        return str(getattr(self, "gear", "as listed"))

    def contradictions(self, milder: Fault) -> Iterator[Problem]:  # noqa: ARG002
        """Yield what cannot be, beside the milder damage that it contains."""
        return iter(())

    def key_that_adds_nothing(self, milder: Fault) -> str | None:  # noqa: ARG002
        """Return the key by which it adds nothing to the milder damage that it contains, or None if it adds some."""
        return None

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool] | None:  # noqa: ARG002
        """Return whether all its edges are parallel to the axis, and whether one may then go through the face.

        None for what has no such edges.
        """
        return None
