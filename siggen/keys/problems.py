"""Problems of one section in words for an engineer: where, what came, what is allowed."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from typing import get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError

from siggen.errors import Problem, counted
from siggen.keys.wording import allowed_text, keys_of, models_in, words_in

REFUSAL = "refusal"
MISSING = "nothing"
LISTED_KEYS = 10
"""Unknown keys of one mapping that are named; of the others only the number is told."""

MOST_PROBLEMS = 1_000
"""Of a section that are put into words, unknown keys apart; a hostile file has as many as it likes."""

SHOWN_NUMBERS = 4
"""Lists of up to as many numbers are shown as they came."""

ONE, SEVERAL = "one", "several"
"""Tags of what may be a section or a list of them."""

BRANCHES = {"modal", "plates", "rigid", ONE, SEVERAL}
"""Tags by which pydantic names the branch of a union it took, to which kinds of damage and sensors add their own.

No key of the file has such a name (tested).
"""

Location = tuple[int | str, ...]


def received_text(value: object) -> str:
    """Return a value of the YAML file as a reader of that file would name it."""
    match value:
        case None:
            return "null"
        case bool():
            return "true" if value else "false"
        case str():
            return f"the text '{_shortened(value)}'"
        case Mapping():
            return f"a mapping with {_listed([str(key) for key in value])}" if value else "an empty mapping"
        case list() | tuple():
            numbers = all(isinstance(entry, (int, float)) and not isinstance(entry, bool) for entry in value)
            shown = f", {list(value)}" if numbers and 0 < len(value) <= SHOWN_NUMBERS else ""
            return f"a list of {len(value)}{shown}"
        case _:
            return _shortened(repr(value))


def refusal(problems: Sequence[Problem]) -> PydanticCustomError:
    """Return an error to raise in a validator; paths of its problems are relative to what is validated."""
    triples = [(p.path, p.received, p.allowed) for p in problems]
    return PydanticCustomError(REFUSAL, "refused", {"problems": triples})


def refused_problems(error: PydanticCustomError, prefix: str | int = "") -> list[Problem]:
    """Return the problems of a refusal, below a prefix of their paths."""
    triples = (error.context or {})["problems"]
    return [Problem(joined(prefix, path), received, allowed) for path, received, allowed in triples]


def joined(*parts: str | int) -> str:
    """Return the path made of parts, without the empty ones."""
    return ".".join(str(part) for part in parts if part != "")


def nearest(word: str, known: Sequence[str]) -> str:
    """Return "; did you mean 'x'?" for the known word next to a mistyped one, or nothing."""
    close = difflib.get_close_matches(word, known, n=1, cutoff=0.6)
    return f"; did you mean '{close[0]}'?" if close else ""


def nearest_word(value: object, known: Sequence[str]) -> str:
    """Return what `nearest` says of a value of the YAML file; nothing of what is no text."""
    return nearest(value, known) if isinstance(value, str) else ""


def section_problems(model: type[BaseModel], errors: Sequence[ErrorDetails], below: Location = ()) -> list[Problem]:
    """Translate pydantic's errors about something that lies `below` a section; paths begin at the section."""
    found: list[Problem] = []
    unknown: dict[Location, list[tuple[str, object]]] = {}
    for error in errors:
        place: Location = (*below, *error["loc"])
        if error["type"] == "extra_forbidden":
            path = joined(*(part for part in place if part not in BRANCHES))
            unknown.setdefault(place[:-1], []).append((path, error["input"]))
        elif len(found) < MOST_PROBLEMS and not _echoes(error):
            found += _translated(model, place, error)
    for place, keys in unknown.items():
        found += unknown_keys(keys, keys_of(_model_at(model, place)))
    return found


def _echoes(error: ErrorDetails) -> bool:
    # a list whose entries are wrong is called too short as well, since only its good entries are counted
    return error["type"] == "too_short" and len(error["input"]) >= error["ctx"]["min_length"]


def unknown_keys(found: Sequence[tuple[str, object]], known: Sequence[str]) -> list[Problem]:
    """Return the problems of keys, as (path, value), that do not exist at their place; of many, ten and a number."""
    problems = [_unknown_key(path, value, known) for path, value in found[:LISTED_KEYS]]
    more = len(found) - LISTED_KEYS
    if more > 0:
        path = _short_path(found[LISTED_KEYS][0])
        problems.append(Problem(path, counted(more, "more unknown key"), f"known keys: {', '.join(known)}"))
    return problems


def _unknown_key(path: str, value: object, known: Sequence[str]) -> Problem:
    """Return the problem of a key that does not exist at its place."""
    path = _short_path(path)
    key = path.rpartition(".")[2]
    hint = nearest(key, known) or ";"
    return Problem(path, received_text(value), f"there is no such key here{hint} known keys: {', '.join(known)}")


def missing_key(path: str, field: FieldInfo) -> Problem:
    """Return the problem of a key that has no default and is not there."""
    return Problem(path, MISSING, f"this key is needed; allowed: {allowed_text(field)}")


def _translated(model: type[BaseModel], location: Location, error: ErrorDetails) -> list[Problem]:
    path = joined(*(part for part in location if part not in BRANCHES))
    context = error.get("ctx", {})
    match error["type"]:
        case "refusal":
            return [Problem(joined(path, sub), received, allowed) for sub, received, allowed in context["problems"]]
        case "union_tag_not_found" if isinstance(error["input"], Mapping):
            return [Problem(joined(path, "kind"), MISSING, f"allowed: one of {', '.join(_kinds_at(model, location))}")]
        case "union_tag_invalid":
            kind, kinds = error["input"].get("kind"), _kinds_at(model, location)
            allowed = f"allowed: one of {', '.join(kinds)}{nearest_word(kind, kinds)}"
            return [Problem(joined(path, "kind"), received_text(kind), allowed)]
        case "missing" if not isinstance(location[-1], int):
            return [missing_key(path, _field_at(model, location))]
        case "missing":  # one of the numbers of a place: the place is wrong
            location, path = location[:-1], path.rpartition(".")[0]
        case _:
            pass
    field, came = _field_at(model, location), error["input"]
    allowed = f"allowed: {allowed_text(field)}{nearest_word(came, words_in(field))}"
    return [Problem(path, received_text(came), allowed)]


def _kinds_at(model: type[BaseModel], location: Location) -> list[str]:
    kinds = [get_args(m.model_fields["kind"].annotation)[0] for m in models_in(_field_at(model, location).annotation)]
    return list(dict.fromkeys(kinds))


def _field_at(model: type[BaseModel], location: Location) -> FieldInfo:
    depth = max((i for i, part in enumerate(location) if isinstance(part, str) and part not in BRANCHES), default=-1)
    if depth < 0:
        return FieldInfo.from_annotation(model)
    field = _model_at(model, location[:depth]).model_fields[str(location[depth])]
    below = location[depth + 1 :]
    for part in () if SEVERAL in below else below:  # what may be a section or a list says so itself
        if isinstance(part, int):
            entries = get_args(field.annotation)
            each = get_origin(field.annotation) is tuple and Ellipsis not in entries  # each entry has its own type
            field = FieldInfo.from_annotation(entries[part if each else 0])
    return field


def _model_at(model: type[BaseModel], location: Location) -> type[BaseModel]:
    candidates = [model]
    for part in location:
        if part in (ONE, SEVERAL):
            continue
        if part in BRANCHES:
            candidates = [c for c in candidates if _is_branch(c, str(part))]
        elif isinstance(part, str):
            candidates = models_in(candidates[0].model_fields[part].annotation)
    return candidates[0]


def _is_branch(model: type[BaseModel], tag: str) -> bool:
    kind = model.model_fields.get("kind")
    return kind is not None and tag in get_args(kind.annotation)


def _short_path(path: str) -> str:
    return path if len(path) <= 200 else f"{path[:197]}..."


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(_shortened(name) for name in names[:6])
    return f"{shown}, ..." if len(names) > 6 else shown
