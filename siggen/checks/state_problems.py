"""What is impossible about the keys that states change: told per state, with the key of the change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from pydantic_core import PydanticCustomError

from siggen.checks.physical_problems import physical_problems
from siggen.config import ParsedConfig, StateSection
from siggen.config.changes import Change, changed_sections
from siggen.config.consistency import consistency_problems
from siggen.config.states import changes_of
from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.problems import refused_problems


def state_problems(parsed: ParsedConfig) -> Iterator[Problem]:
    """Yield what is wrong with what states change, at the bounds of all numbers; of keys that are valid otherwise."""
    states: Mapping[str, StateSection] = parsed.sections.get("states", {})
    if parsed.problems or not any(state.changes for state in states.values()):
        return
    known = {problem.path for problem in _every(parsed.sections)}
    for index, name in enumerate(states):
        changes = [one for _, one in changes_of(tuple(states.values()), index)]
        if changes:
            yield from _changed_problems(parsed, name, changes, known)


def _changed_problems(
    parsed: ParsedConfig, state: str, changes: Sequence[Change], known: Iterable[str]
) -> Iterator[Problem]:
    try:
        changed = changed_sections(parsed.sections, changes)
    except PydanticCustomError as error:
        yield from refused_problems(error, f"states.{state}.changes")
        return
    manufacture = parsed.sections.get("manufacture")
    if manufacture is not None and manufacture.draw == "state":
        allowed = "allowed: none with manufacture.draw: state, whose gears are others in every state; or draw: specimen"
        yield Problem(f"states.{state}.changes", _texts(changes), allowed)
    for problem in _every({**parsed.sections, **changed}):
        if problem.path not in known:
            path, remark = _blamed(problem.path, changes)
            yield Problem(f"states.{state}.changes{path}", f"{remark}{problem.received}", problem.allowed)
    yield from _column_problems(parsed.sections, changed, changes, f"states.{state}.changes")


def _every(sections: Mapping[str, Any]) -> list[Problem]:
    """Return all problems of some sections."""
    return [*consistency_problems(sections, {}), *physical_problems(PossibleGearbox.of_sections(sections))]


def _blamed(path: str, changes: Sequence[Change]) -> tuple[str, str]:
    """Return the key of the change that a problem is about, and what stands before what was received."""
    if path in {one.path for one in changes}:
        return f".{path}", ""
    return f".{changes[0].path}" if len(changes) == 1 else "", f"{path}: "


def _column_problems(
    sections: Mapping[str, Any], changed: Mapping[str, Any], changes: Sequence[Change], path: str
) -> Iterator[Problem]:
    """Yield changes after which records would have other columns."""
    before, after = _columns(sections), _columns({**sections, **changed})
    others = [name for name, present in after.items() if present != before[name]]
    if others:
        received = f"{_texts(changes)}, which adds or takes columns: those of {', '.join(others)}"
        allowed = "allowed: what leaves the columns of the set as they are; give the healthy gearbox some of it"
        yield Problem(path, received, allowed)


def _columns(sections: Mapping[str, Any]) -> dict[str, bool]:
    """Return what numbers alone give columns of its own, and whether there is any of it."""
    variation, manufacture = sections.get("variation"), sections.get("manufacture")
    return {
        "variation": variation is not None and variation.active,
        "manufacture.crowning_um": manufacture is not None and manufacture.has_crowning,
    }


def _texts(changes: Sequence[Change]) -> str:
    return " and ".join(one.text for one in changes)
