"""Names: the user's own words for gears, shafts and meshes, in place of those of the short form.

The short form calls the gears of a mesh pinion and gear, those of a mesh SLOW behind the first one SLOW.pinion and
SLOW.gear. All code counts by these words. Columns, messages and pages that leave it say `Names`' own ones.
What the user wrote, such as the name of a state, is no word of the program and stays as it is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from html import escape
from typing import Any, TypeAlias

from siggen.errors import Problem

Table: TypeAlias = tuple[tuple[str, str], ...]
"""Words of the short form, each with the user's own."""
DRIVER, DRIVEN, EITHER, BOTH, SEVERAL = "pinion", "gear", "either", "both", "several"
KEYS: Table = (
    ("pinion", "driver"), ("gear", "driven"), ("pinion_depth", "driver_depth"), ("gear_depth", "driven_depth"),
    ("pinion_encoder", "driver_encoder"), ("gear_encoder", "driven_encoder"),
    ("accuracy_class_gear", "accuracy_class_driven"), ("crowning_gear_um", "crowning_driven_um"),
)  # fmt: skip
"""Keys of the short form and those of a file with a `machine`."""
START, END = r"(?<![\w.])", r"(?![\w])"
COORDINATE = re.compile(r"(?P<axis>[xyz]|theta|phi|phi_x|phi_y)_(?P<body>\d+|[mlcb])(?P<unit>(?:_rad|_m)?)")
"""Degrees of freedom: gears by their number in the order of power, and by a letter what is no gear."""
BODIES = {"m": "motor", "l": "load", "c": "casing", "b": "base"}
CHANGED = re.compile(r"states\.\d+\.changes\.")
"""In front of a key that a state changes."""
BREAK = "<wbr>"
"""Where pages may break a name."""
NAMED_GEAR = re.compile(r"\b[Tt]he (?=[a-z0-9_]+\.(?:pinion|gear)\b(?! shaft))")
"""An article that a name has not."""


@dataclass(frozen=True, slots=True)
class Names:
    """The words of one machine; without any, every word stays as it is.

    Attributes
    ----------
    gears : pinion, gear, SLOW.pinion, ... and the user's names; an idler has two, MESH.NAME by the mesh of each flank
    shafts : pinion, gear, SLOW (the shaft of SLOW.gear) and the user's names
    meshes : the empty name of the first mesh, SLOW, ... and the user's names
    paths : keys of the short form, such as stages.0.gears.pinion, and where the user wrote them
    kept : texts of the user, such as names of states, that stay as they are wherever they stand alone
    """

    gears: Table = ()
    shafts: Table = ()
    meshes: Table = ()
    paths: Table = ()
    kept: tuple[str, ...] = ()

    def keeping(self, texts: Iterable[object]) -> Names:
        """Return these names with further texts of the user; of those that would change, since few do."""
        plain = replace(self, kept=())
        more = {one for one in map(str, texts) if plain.text(one) != one or plain.column(one) != one}
        return replace(self, kept=tuple(sorted({*self.kept, *more})))

    def gear(self, word: str) -> str:
        """Return the user's name of a gear as damage and labels name it."""
        return _words(self).get(word, word)

    def mesh(self, name: str) -> str:
        """Return the user's name of a mesh."""
        return dict(self.meshes).get(name, name)

    @property
    def damaged(self) -> dict[str, str]:
        """What `gear` of damage may hold: gears, and for each mesh the drawn one of both."""
        return {**dict(self.gears), **{_in(mesh, EITHER): f"{own}.{EITHER}" for mesh, own in self.meshes}}

    @property
    def places(self) -> dict[str, str]:
        """Places of sensors: bearings, ends of the casing and all that turns."""
        of_shafts = {f"{short}_{what}": f"{own}_{what}" for short, own in self.shafts for what in ("bearing", "end")}
        return {**of_shafts, **dict(self.gears)}

    def place(self, word: str) -> str:
        """Return where a sensor stands in the user's words."""
        return self.places.get(word, word)

    def force(self, name: str) -> str:
        """Return a bearing force, given as place/axis, in the user's words."""
        place, axis = name.split("/")
        return f"{self.place(place)}/{axis}"

    def short_path(self, path: str) -> str:
        """Return a key of the user as the short form has it, such as one that a state changes."""
        for short, own in self.paths:
            if path.startswith(f"{own}."):
                return f"{short}{path.removeprefix(own)}"
        return path

    def own_path(self, path: str) -> str:
        """Return a key of the short form as the user wrote it."""
        for short, own in sorted(self.paths, key=lambda one: -len(one[0])):
            if path.startswith(f"{short}.") or (path == short and not short.endswith("gears")):
                return f"{own}{path.removeprefix(short)}"
        return path

    def column(self, name: str) -> str:
        """Return the user's name of a column or a quantity that the program has."""
        if not self.gears or name in {"gear", "faulty_gear"}:
            return name
        if name == "mesh_hz":
            return f"mesh_{self.mesh('')}_hz"
        if found := COORDINATE.fullmatch(name):
            return f"{found['axis']}_{self._body(found['body'])}{found['unit']}"
        words = _column_words(self)
        return _found(tuple(words), r"(?<![a-z0-9])", r"(?![a-z0-9])").sub(lambda one: words[one[0]], name)

    def text(self, text: str, mesh: str = "") -> str:
        """Return a text of the program in the user's words; `mesh` is that whose gears it calls pinion and gear."""
        return changed_beside(self.kept, text, lambda part: self._text(part, mesh)) if self.gears else text

    def _text(self, text: str, mesh: str) -> str:
        for short, own in sorted(self.paths, key=lambda one: -len(one[0])):
            text = re.sub(
                rf"{START}{re.escape(short)}(?=\.[a-z]{'' if short.endswith('gears') else '|' + END})", own, text
            )
        words = _text_words(self)
        text = re.sub(r", stages: [a-z0-9_, ]+", "", text)
        text = NAMED_GEAR.sub("", text)
        text = _found(tuple(words), START, END).sub(lambda one: words[one[0]], text)
        place = [name for name, _ in self.meshes].index(mesh)
        shafts = [f"the {own} shaft" for _, own in self.shafts[place : place + 2]]
        return _prose(text, shafts, self.gear(_in(mesh, DRIVER)), self.gear(_in(mesh, DRIVEN)))

    def of_any_mesh(self, text: str) -> str:
        """Return a text about the gears of any mesh without the words of the short form."""
        return _prose(text, ["its shaft"] * 2, "the driving gear", "the driven gear") if self.gears else text

    def problem(self, problem: Problem) -> Problem:
        """Return a problem in the user's words, at the key that the user wrote."""
        if not self.gears:
            return problem
        mesh = self._mesh_at(problem.path)
        path = self.own_path(problem.path)
        received, allowed = (self.text(one, mesh) for one in (problem.received, problem.allowed))
        keys = {short: own for short, own in KEYS if short not in {DRIVER, DRIVEN}}
        path = ".".join(keys.get(part, part) for part in path.split("."))
        if changed := CHANGED.match(path):
            path = changed[0] + self.own_path(path.removeprefix(changed[0]))
        return replace(problem, path=path, received=received, allowed=allowed)

    def _body(self, code: str) -> str:
        return self.gears[int(code) - 1][1].rpartition(".")[2] if code.isdigit() else BODIES[code]  # of an idler too

    def _mesh_at(self, path: str) -> str:
        found = re.match(r"stages\.(\d+)", path)
        return self.meshes[1 + int(found[1])][0] if found and int(found[1]) + 1 < len(self.meshes) else ""


NO_NAMES = Names()
"""Of files in the short form."""


def changed_beside(kept: tuple[str, ...], text: str, change: Callable[[str], str]) -> str:
    """Return a text that is changed but for the kept words; a page may break those behind `_`."""
    if not kept:
        return change(text)
    parts = _standing_alone(kept).split(text)
    return "".join(part if place % 2 else change(part) for place, part in enumerate(parts))


def renamed_keys(value: Any, *, own: bool) -> Any:
    """Return mappings and lists with the keys of the other form: the user's `own`, or those of the short form."""
    table = dict(KEYS) if own else {to: key for key, to in KEYS}
    if isinstance(value, dict):
        return {table.get(key, key): renamed_keys(item, own=own) for key, item in value.items()}
    return [renamed_keys(item, own=own) for item in value] if isinstance(value, (list, tuple)) else value


@cache
def _standing_alone(words: tuple[str, ...]) -> re.Pattern[str]:
    longest = sorted({form for word in words for form in (word, escape(word))}, key=len, reverse=True)
    broken = (re.escape(form).replace("_", f"_(?:{BREAK})?") for form in longest)
    return re.compile(rf"((?<!\w)(?:{'|'.join(broken)})(?!\w))")


def _in(mesh: str, gear: str) -> str:
    return f"{mesh}.{gear}" if mesh else gear


@cache
def _words(names: Names) -> dict[str, str]:
    """Return what `gear` of damage and labels may hold."""
    return {**names.damaged, **{_in(mesh, BOTH): SEVERAL for mesh, _ in names.meshes}}


@cache
def _column_words(names: Names) -> dict[str, str]:
    """Return parts of the names of columns."""
    of_shafts = {f"{short}_shaft": f"{own}_shaft" for short, own in names.shafts}
    gears = {short.replace(".", "_"): own.replace(".", "_") for short, own in names.gears}
    return {**of_shafts, **names.places, **gears}


@cache
def _text_words(names: Names) -> dict[str, str]:
    """Return whole words in texts; pinion and gear alone are left to `_prose`."""
    drawn = {short: own for short, own in _words(names).items() if short not in {DRIVER, DRIVEN, BOTH, EITHER}}
    keys = {short: own for short, own in KEYS if short not in {DRIVER, DRIVEN}}
    found = {**_column_words(names), **drawn, **keys}
    return {short: own for short, own in found.items() if short not in {DRIVER, DRIVEN}}


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
