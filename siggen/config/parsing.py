"""From a mapping to a configuration, with all problems at once and the sections that are valid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from types import MappingProxyType
from typing import Any, get_args

from pydantic import TypeAdapter, ValidationError

from siggen.config.config import Config
from siggen.config.consistency import consistency_problems
from siggen.config.inheritance import REPLACED
from siggen.config.machine import drivetrain, machine_problems, names_of, problems_beside
from siggen.config.states import complete_states, source_of
from siggen.errors import Problem
from siggen.keys.by_name import BY_NAME, NO_NAME, named_entries, refused_list
from siggen.keys.problems import (
    MISSING,
    MOST_PROBLEMS,
    joined,
    missing_key,
    received_text,
    section_problems,
    unknown_keys,
)
from siggen.keys.wording import allowed_text
from siggen.names import PAIR, Names

NONE: Mapping[str, Any] = MappingProxyType({})
MOST_ENTRIES = 5_000
"""Of a section that is a list; a file has no room for as many mappings."""


@dataclass(frozen=True, slots=True)
class ParsedConfig:
    """What a mapping holds.

    Parameters
    ----------
    config
        The configuration; None if there are problems.
    sections
        Valid top-level values by key, with defaults for absent ones. `states` and `sensors` are mappings from names to
        valid entries.
    problems
        Everything that is wrong, physics not considered.
    names
        Of gears, shafts and meshes; sections of a file with a machine are those of pairs.
    """

    config: Config | None
    sections: Mapping[str, Any]
    problems: tuple[Problem, ...]
    names: Names = PAIR


def parse(raw: Mapping[str, object]) -> ParsedConfig:
    """Return the configuration that a mapping stands for, or all its problems; never raises because of its content."""
    if raw.get("machine") is None:
        return _parsed(raw, {"machine": None})
    machine, wrong = _validated(_adapter("machine"), raw["machine"], ("machine",))
    if wrong := [_at_part(one, raw["machine"]) for one in wrong] or machine_problems(machine):
        return ParsedConfig(None, MappingProxyType({}), tuple(wrong))  # words of all else are those of its names
    names = names_of(machine)
    gears, _, rotors = drivetrain(machine)
    short = {key: value for key, value in raw.items() if key not in (*REPLACED, "machine")}
    parsed = _parsed(short, {"machine": machine, "gears": gears}, rotors)
    wrong, told = [*problems_beside(raw)], {problem.path for problem in problems_beside(raw)}
    problems = [*wrong, *(one for one in map(names.problem, parsed.problems) if one.path not in told)]
    return ParsedConfig(None if wrong else parsed.config, parsed.sections, tuple(problems), names)


def _parsed(raw: Mapping[str, object], of_machine: Mapping[str, Any], rotors: Mapping[str, Any] = NONE) -> ParsedConfig:
    """Return what a mapping holds, beside the sections and the rotors that a machine stands for."""
    if raw.get("life") and not raw.get("states", True):  # no states, as a file says that extends one with some
        raw = {key: value for key, value in raw.items() if key != "states"}
    sections: dict[str, Any] = dict(of_machine)
    known = [name for name, field in Config.model_fields.items() if not field.exclude]
    problems = unknown_keys([(str(key), raw[key]) for key in raw if key not in known], known)
    for name in (name for name in known if name not in of_machine):
        value, found = _entries(name, raw) if name in BY_NAME and name in raw else _section(name, raw)
        problems += found
        if value is not None:
            sections[name] = {} if value == () and name in BY_NAME else value
    if rotors and "dynamics" in sections:
        sections["dynamics"] = sections["dynamics"].model_copy(update=rotors)
    if raw.get("planetary") is not None and "planetary" not in sections:  # words of all else are those of its gears
        return ParsedConfig(None, MappingProxyType({}), tuple(problems))
    problems += consistency_problems(sections, raw)
    if isinstance(states := raw.get("states"), Mapping):
        problems = [one for one in problems if not _taken_over(one, problems, states)]
    config = None if problems else Config.model_validate(_listed(sections))
    return ParsedConfig(config, MappingProxyType(sections), tuple(problems))


def _listed(sections: Mapping[str, Any]) -> dict[str, Any]:
    """Return valid sections with lists in place of entries by name, and without lists of none."""
    lists = {name: tuple(sections[name].values()) for name in BY_NAME}
    return {name: lists.get(name, value) for name, value in sections.items() if lists.get(name) != ()}


def _section(name: str, raw: Mapping[str, object]) -> tuple[Any, list[Problem]]:
    field = Config.model_fields[name]
    if isinstance(value := raw.get(name), (list, tuple)) and len(value) > MOST_ENTRIES:
        return None, [Problem(name, f"a list of {len(value)}", f"allowed: at most {MOST_ENTRIES} entries")]
    if name == "states" and not raw.get("life"):
        return None, [_no_states(MISSING)]
    if name not in raw:
        if field.is_required():
            return None, [missing_key(name, field)]
        return field.get_default(call_default_factory=True), []
    return _validated(_adapter(name), raw[name], (name,))


def _no_states(received: str) -> Problem:
    allowed = allowed_text(Config.model_fields["states"])
    return Problem("states", received, f"this key is needed, or a section life in its place; allowed: {allowed}")


def _entries(name: str, raw: Mapping[str, Any]) -> tuple[dict[str, Any] | None, list[Problem]]:
    """Return entries by name, each checked by itself, so that a bad one does not hide what is wrong with the others."""
    given, allowed = raw[name], allowed_text(Config.model_fields[name])
    if not isinstance(given, Mapping) or len(given) > MOST_ENTRIES:
        return None, [refused_list(name, given, allowed)]
    items = named_entries(name, raw)
    if not items and name == "states":
        return None, [_no_states(received_text(given))]
    if not items:
        return None, [Problem(name, received_text(given), f"allowed: {allowed}")]
    entries: dict[str, Any] = {}
    complete, problems = complete_states(items) if name == "states" else (items, [])
    for key, item in complete.items():
        if len(problems) >= MOST_PROBLEMS:
            break
        if isinstance(item, Mapping) and "name" in item:
            problems.append(Problem(_below(name, key, "name"), received_text(item["name"]), NO_NAME))
            continue
        named = {"name": key, **item} if isinstance(item, Mapping) else item
        entry, found = _validated(_entry_adapter(name), named, (name, 0))
        problems += [_of_entry(one, name, key) for one in found]
        if entry is not None:
            entries[key] = entry
    return entries, problems


def _of_entry(problem: Problem, name: str, key: str, place: int = 0) -> Problem:
    """Return the problem of an entry in a place under its name; that of the name itself stands at the entry."""
    below = problem.path.removeprefix(f"{name}.{place}").removeprefix(".")
    if below != "name":
        return replace(problem, path=_below(name, key, below))
    return replace(problem, path=_below(name, key), received=f"the name {key[:60]!r}")


def _at_part(problem: Problem, machine: Any) -> Problem:
    """Return a problem of a shaft, gear or mesh under its name."""
    _, kind, place, *_ = *problem.path.split("."), "", ""
    if not place.isdecimal():
        return problem
    return _of_entry(problem, f"machine.{kind}", [*named_entries(kind, machine)][int(place)], int(place))


def _taken_over(problem: Problem, problems: Sequence[Problem], states: Mapping[str, object]) -> bool:
    """Tell whether a state has a problem by a key of the state that it names, which has the same one."""
    name = next((name for name in states if problem.path.startswith(f"{_below('states', str(name))}.")), None)
    rest, seen = problem.path.removeprefix(_below("states", str(name))), {name}
    while name is not None and (name := source_of(states.get(name))) not in seen:
        if replace(problem, path=f"{_below('states', str(name))}{rest}") in problems:
            return True
        seen.add(name)
    return False


def _below(*parts: str) -> str:
    return joined(*(part[:200] for part in parts))


def _validated(adapter: TypeAdapter[Any], value: object, location: tuple[str | int, ...]) -> tuple[Any, list[Problem]]:
    try:
        return adapter.validate_python(value), []
    except ValidationError as error:
        return None, section_problems(Config, error.errors(include_url=False), location)


@cache
def _adapter(name: str) -> TypeAdapter[Any]:
    return TypeAdapter(Config.model_fields[name].rebuild_annotation())


@cache
def _entry_adapter(name: str) -> TypeAdapter[Any]:
    return TypeAdapter(get_args(Config.model_fields[name].annotation)[0])
