"""What follows from the list of kinds: the union that a state parses, its words, and what is said about them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, TypeAlias

from pydantic import Discriminator, Field, Tag

from siggen.damage.fault import Fault
from siggen.damage.kinds import KINDS
from siggen.keys.problems import ONE, SEVERAL
from siggen.keys.wording import AllowedText

BY_WORD: Mapping[str, type[Fault]] = {one.kind_word(): one for one in KINDS}
"""Word of `kind:` -> section."""

HEALTHY, COMBINED = "healthy", "combined"
FAULT_WORDS = (HEALTHY, *dict.fromkeys(word for one in KINDS for word in one.words), COMBINED)
"""What states may be called."""
KNOWN_CHANGES = (
    "misalignment", "eccentricity", "unbalance", "lubrication", "looseness", "clearance", "bearing", "coupling",
    "resonance", "sensor",
)  # fmt: skip
"""What changed machines and sensors are called; any other word will do."""

DAMAGE = AllowedText(
    "null, a mapping with kind: {} or {}, or a list of such mappings".format(", ".join([*BY_WORD][:-1]), [*BY_WORD][-1])
)

if TYPE_CHECKING:
    DamageSections: TypeAlias = Fault | tuple[Fault, ...]
else:
    _Section = Annotated[reduce(or_, KINDS), Field(discriminator="kind")]
    DamageSections = Annotated[
        Annotated[_Section, Tag(ONE)] | Annotated[tuple[_Section, ...], Field(min_length=1), Tag(SEVERAL)],
        Discriminator(lambda given: SEVERAL if isinstance(given, (list, tuple)) else ONE),
    ]


def default_word(damage: object) -> str:
    """Return what a state with a damage, raw or parsed, or with several, is called by default."""
    if isinstance(damage, (list, tuple)):
        words = {default_word(one) for one in damage}
        return COMBINED if len(words) > 1 else next(iter(words), FAULT_WORDS[1])
    read: Callable[[str], object] = (
        damage.get if isinstance(damage, Mapping) else lambda key: getattr(damage, key, None)
    )
    kind = read("kind")
    section = BY_WORD.get(kind) if isinstance(kind, str) else None
    return FAULT_WORDS[1] if section is None else section.default_word(read)


def kinds_called(word: str) -> list[str]:
    """Return the kinds whose damage a state may be called by a word."""
    return [kind for kind, section in BY_WORD.items() if word in section.words]
