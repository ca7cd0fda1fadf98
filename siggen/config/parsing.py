"""From a mapping to a configuration, with all problems at once and the sections that are valid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any, get_args

from pydantic import TypeAdapter, ValidationError

from siggen.config.config import Config
from siggen.config.consistency import consistency_problems
from siggen.config.machine import Machine
from siggen.config.machine_problems import machine_problems
from siggen.config.short_form import names_of, short_form
from siggen.errors import Problem
from siggen.keys.problems import MISSING, MOST_PROBLEMS, missing_key, received_text, section_problems, unknown_keys
from siggen.keys.wording import allowed_text
from siggen.names import PAIR, Names

LISTS = ("states", "sensors")
"""Sections whose entries are checked one by one, so that one bad entry does not hide what is wrong with the others."""

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
        Valid top-level values by key, with defaults for absent ones. `states` and `sensors` are mappings from the index
        of an entry to the valid entry.
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
        return _parsed(raw, None)
    machine, wrong = _validated(_adapter("machine"), raw["machine"], ("machine",))
    if wrong := wrong or machine_problems(machine):
        return ParsedConfig(None, MappingProxyType({}), tuple(wrong))  # words of all else are those of its names
    names = names_of(machine)
    short, wrong = short_form(raw, machine, names)
    parsed, told = _parsed(short, machine), {problem.path for problem in wrong}
    problems = [*wrong, *(one for one in map(names.problem, parsed.problems) if one.path not in told)]
    return ParsedConfig(None if wrong else parsed.config, parsed.sections, tuple(problems), names)


def _parsed(raw: Mapping[str, object], machine: Machine | None) -> ParsedConfig:
    """Return what a mapping in the short form holds."""
    if raw.get("life") and not raw.get("states", True):  # no states, as a file says that extends one with some
        raw = {key: value for key, value in raw.items() if key != "states"}
    sections: dict[str, Any] = {"machine": machine}
    unknown = [(str(key), raw[key]) for key in raw if key not in Config.model_fields]
    problems = unknown_keys(unknown, list(Config.model_fields))
    for name in (name for name in Config.model_fields if name != "machine"):
        value, found = (
            _entries(name, raw[name]) if name in LISTS and _is_filled_list(raw, name) else _section(name, raw)
        )
        problems += found
        if value is not None:
            sections[name] = dict(enumerate(value)) if name in LISTS and isinstance(value, tuple) else value
    problems += consistency_problems(sections, raw)
    config = None if problems else Config.model_validate(_listed(sections))
    return ParsedConfig(config, MappingProxyType(sections), tuple(problems))


def _listed(sections: Mapping[str, Any]) -> dict[str, Any]:
    """Return valid sections with lists in place of their numbered entries, and without lists of none."""
    lists = {name: tuple(sections[name].values()) for name in LISTS}
    return {name: lists.get(name, value) for name, value in sections.items() if lists.get(name) != ()}


def _is_filled_list(raw: Mapping[str, object], name: str) -> bool:
    return isinstance(raw.get(name), (list, tuple)) and bool(raw[name])


def _section(name: str, raw: Mapping[str, object]) -> tuple[Any, list[Problem]]:
    field = Config.model_fields[name]
    if isinstance(value := raw.get(name), (list, tuple)) and len(value) > MOST_ENTRIES:
        return None, [Problem(name, f"a list of {len(value)}", f"allowed: at most {MOST_ENTRIES} entries")]
    if name == "states" and not raw.get(name) and not raw.get("life"):
        received = received_text(raw[name]) if name in raw else MISSING
        allowed = f"this key is needed, or a section life in its place; allowed: {allowed_text(field)}"
        return None, [Problem(name, received, allowed)]
    if name not in raw:
        if field.is_required():
            return None, [missing_key(name, field)]
        return field.get_default(call_default_factory=True), []
    return _validated(_adapter(name), raw[name], (name,))


def _entries(name: str, raw: Any) -> tuple[dict[int, Any], list[Problem]]:
    entries: dict[int, Any] = {}
    problems: list[Problem] = []
    for index, item in enumerate(raw):
        if len(problems) >= MOST_PROBLEMS:
            break
        entry, found = _validated(_entry_adapter(name), item, (name, index))
        problems += found
        if entry is not None:
            entries[index] = entry
    return entries, problems


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
