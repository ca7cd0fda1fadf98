"""The kinds of damage; a new one is a line here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import or_
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from pydantic import Field

from siggen.faults.clustered import ClusteredPits
from siggen.faults.fault import Fault
from siggen.faults.irregular import IrregularSpalls
from siggen.faults.layered import LayeredPits
from siggen.faults.listed import ListedPits
from siggen.faults.spalls import Spalls
from siggen.keys.wording import AllowedText

REGISTERED: list[type[Fault]] = [LayeredPits, ClusteredPits, Spalls, ListedPits, IrregularSpalls]

KINDS: Mapping[str, type[Fault]] = {one.kind_word(): one for one in REGISTERED}
"""Word of `kind:` -> section."""

HEALTHY = "healthy"
FAULT_WORDS = (HEALTHY, *dict.fromkeys(word for one in REGISTERED for word in one.words))
"""What states may be called."""

DAMAGE = AllowedText("null, or a mapping with kind: {} or {}".format(", ".join([*KINDS][:-1]), [*KINDS][-1]))

if TYPE_CHECKING:
    DamageSection: TypeAlias = Fault
    FaultWord: TypeAlias = str
else:
    DamageSection = Annotated[reduce(or_, REGISTERED), Field(discriminator="kind")]
    FaultWord = Literal[FAULT_WORDS]


def default_word(damage: object) -> str:
    """Return what a state with a damage, raw or parsed, is called by default."""
    read: Callable[[str], object] = (
        damage.get if isinstance(damage, Mapping) else lambda key: getattr(damage, key, None)
    )
    kind = read("kind")
    section = KINDS.get(kind) if isinstance(kind, str) else None
    return FAULT_WORDS[1] if section is None else section.default_word(read)


def kinds_called(word: str) -> list[str]:
    """Return the kinds whose damage a state may be called by a word."""
    return [kind for kind, section in KINDS.items() if word in section.words]
