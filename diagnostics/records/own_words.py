"""Words of a set whose machine has names of its own, in place of those that diagnostics counts by.

Diagnostics calls the gears of a mesh pinion and gear, those of a mesh SLOW behind the first one SLOW.pinion and
SLOW.gear. What the user wrote, such as the name of a state, is no word of the program and stays as it is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from html import escape

from siggen.names import DRIVEN, DRIVER, EITHER, KEYS, Names, Table

START, END = r"(?<![\w.])", r"(?![\w])"
BREAK = "<wbr>"
"""Where pages may break a name."""
NAMED_GEAR = re.compile(r"\b[Tt]he (?=[a-z0-9_]+\.(?:pinion|gear)\b(?! shaft))")
"""An article that a name has not."""


@dataclass(frozen=True, slots=True)
class OwnWords:
    """The words of one machine; without any, every word stays as it is.

    Attributes
    ----------
    gears, shafts, meshes : words of diagnostics, each with the user's own
    paths : keys of sections, and where the user wrote them
    kept : texts of the user, such as names of states, that stay as they are wherever they stand alone
    """

    gears: Table = ()
    shafts: Table = ()
    meshes: Table = ()
    paths: Table = ()
    kept: tuple[str, ...] = ()

    def keeping(self, texts: Iterable[object]) -> OwnWords:
        """Return these words with further texts of the user; of those that would change, since few do."""
        plain = replace(self, kept=())
        more = {one for one in map(str, texts) if plain.text(one) != one or plain.column(one) != one}
        return replace(self, kept=tuple(sorted({*self.kept, *more})))

    def gear(self, word: str) -> str:
        """Return the user's name of a gear as damage and labels name it."""
        return _words(self).get(word, word)

    def column(self, name: str) -> str:
        """Return the user's name of a column or a quantity that the program has."""
        if not self.gears or name in {"gear", "faulty_gear"}:
            return name
        if name == "mesh_hz":
            return f"mesh_{dict(self.meshes)['']}_hz"
        words = _column_words(self)
        return _found(tuple(words), r"(?<![a-z0-9])", r"(?![a-z0-9])").sub(lambda one: words[one[0]], name)

    def text(self, text: str, mesh: str = "") -> str:
        """Return a text of the program in the user's words; `mesh` is that whose gears it calls pinion and gear."""
        return changed_beside(self.kept, text, lambda part: self._text(part, mesh)) if self.gears else text

    def _text(self, text: str, mesh: str) -> str:
        words = _text_words(self)
        text = NAMED_GEAR.sub("", text)
        text = _found(tuple(words), START, END).sub(lambda one: words[one[0]], text)
        place = [name for name, _ in self.meshes].index(mesh)
        shafts = [f"the {own} shaft" for _, own in self.shafts[place : place + 2]]
        return _prose(text, shafts, self.gear(_in(mesh, DRIVER)), self.gear(_in(mesh, DRIVEN)))


NO_WORDS = OwnWords()
"""Of sets whose gears have no names of their own."""


def own_words(names: Names) -> OwnWords:
    """Return the words of a machine by its names."""
    if not names.given:
        return NO_WORDS
    return OwnWords(
        tuple((gear.inner, gear.word) for gear in names.gears),
        tuple((shaft.inner, shaft.word) for shaft in names.shafts),
        tuple((mesh.inner, mesh.word) for mesh in names.meshes),
        names.paths,
    )


def changed_beside(kept: tuple[str, ...], text: str, change: Callable[[str], str]) -> str:
    """Return a text that is changed but for the kept words; a page may break those behind `_`."""
    if not kept:
        return change(text)
    parts = _standing_alone(kept).split(text)
    return "".join(part if place % 2 else change(part) for place, part in enumerate(parts))


@cache
def _standing_alone(words: tuple[str, ...]) -> re.Pattern[str]:
    longest = sorted({form for word in words for form in (word, escape(word))}, key=len, reverse=True)
    broken = (re.escape(form).replace("_", f"_(?:{BREAK})?") for form in longest)
    return re.compile(rf"((?<!\w)(?:{'|'.join(broken)})(?!\w))")


def _in(mesh: str, gear: str) -> str:
    return f"{mesh}.{gear}" if mesh else gear


@cache
def _words(words: OwnWords) -> dict[str, str]:
    """Return what `gear` of damage and labels may hold."""
    either = {_in(mesh, EITHER): f"{own}.{EITHER}" for mesh, own in words.meshes}
    return {**dict(words.gears), **either}


@cache
def _column_words(words: OwnWords) -> dict[str, str]:
    """Return parts of the names of columns."""
    of_shafts = {
        f"{short}_{what}": f"{own}_{what}" for short, own in words.shafts for what in ("shaft", "bearing", "end")
    }
    gears = {short.replace(".", "_"): own.replace(".", "_") for short, own in words.gears}
    return {**of_shafts, **dict(words.gears), **gears}


@cache
def _text_words(words: OwnWords) -> dict[str, str]:
    """Return whole words in texts; pinion and gear alone are left to `_prose`."""
    found = {**_column_words(words), **_words(words), **dict(KEYS)}
    return {short: own for short, own in found.items() if short not in {DRIVER, DRIVEN, EITHER}}


@cache
def _found(words: tuple[str, ...], start: str, end: str) -> re.Pattern[str]:
    """Return what finds any of these words, the longest first."""
    longest = sorted(words, key=len, reverse=True)
    return re.compile(f"{start}(?:{'|'.join(map(re.escape, longest))}){end}")


def _prose(text: str, shafts: Sequence[str], driver: str, driven: str) -> str:
    """Return a text with the gears of one mesh and their shafts named."""
    for short, shaft in zip((DRIVER, DRIVEN), shafts, strict=True):
        text = re.sub(rf"\b[Tt]he {short} shaft\b", shaft, text)
    text = re.sub(r"\bpinion(,| and| or) (?:the )?gear\b", rf"{driver}\1 {driven}", text)
    text = re.sub(r"\b(?:[Tt]he )?(?:first )?pinion\b", driver, text)
    return re.sub(
        r"\b[Tt]he gear(?! (?:pair|body|bodies|in front))\b|'gear'|^gear(?= [a-z]+$)|(?<=place )gear\b", driven, text
    )
