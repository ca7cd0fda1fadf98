"""What follows from the list of kinds: the union that a state parses, its words, and what is said about them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, TypeAlias

from pydantic import Field

from siggen.faults.fault import Fault
from siggen.faults.kinds import KINDS
from siggen.keys.wording import AllowedText

BY_WORD: Mapping[str, type[Fault]] = {one.kind_word(): one for one in KINDS}
"""Word of `kind:` -> section."""

HEALTHY = "healthy"
FAULT_WORDS = (HEALTHY, *dict.fromkeys(word for one in KINDS for word in one.words))
"""What states may be called."""

DAMAGE = AllowedText("null, or a mapping with kind: {} or {}".format(", ".join([*BY_WORD][:-1]), [*BY_WORD][-1]))

if TYPE_CHECKING:
    DamageSection: TypeAlias = Fault
else:
    DamageSection = Annotated[reduce(or_, KINDS), Field(discriminator="kind")]


def default_word(damage: object) -> str:
    """Return what a state with a damage, raw or parsed, is called by default."""
    read: Callable[[str], object] = (
        damage.get if isinstance(damage, Mapping) else lambda key: getattr(damage, key, None)
    )
    kind = read("kind")
    section = BY_WORD.get(kind) if isinstance(kind, str) else None
    return FAULT_WORDS[1] if section is None else section.default_word(read)


def kinds_called(word: str) -> list[str]:
    """Return the kinds whose damage a state may be called by a word."""
    return [kind for kind, section in BY_WORD.items() if word in section.words]
