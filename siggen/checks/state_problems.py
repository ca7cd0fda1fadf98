"""What is impossible about the keys that states change: told per state, with the key of the change."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from pydantic_core import PydanticCustomError

from siggen.checks.physical_problems import physical_problems
from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.problems import refused_problems


def state_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what is wrong with what states change, at the bounds of all numbers; of sections that are valid."""
    changing = [number for number, state in enumerate(gearbox.config.states) if state.changes]
    known = {problem.path for problem in _every(gearbox)} if changing else set()
    for number in changing:
        yield from _changed_problems(gearbox, number, known)


def _changed_problems(gearbox: PossibleGearbox, number: int, known: Collection[str]) -> Iterator[Problem]:
    config, at = gearbox.config, f"states.{gearbox.config.states[number].name}.changes"
    changes = [one for _, one in config.changes_of(number)]
    texts = " and ".join(one.text for one in changes)
    try:
        changed = gearbox.changed(number)
    except PydanticCustomError as error:
        yield from refused_problems(error, at)
        return
    if config.manufacture is not None and config.manufacture.draw == "state":
        allowed = "allowed: none with manufacture.draw: state, whose gears are others in every state; or draw: specimen"
        yield Problem(at, texts, allowed)
    paths = [one.path for one in changes]
    for problem in _every(changed):
        if problem.path in known:
            continue
        if problem.path in paths:
            yield Problem(f"{at}.{problem.path}", problem.received, problem.allowed)
        else:
            path = f"{at}.{paths[0]}" if len(changes) == 1 else at
            yield Problem(path, f"{problem.path}: {problem.received}", problem.allowed)
    before, after = _columns(gearbox), _columns(changed)
    if others := [name for name, present in after.items() if present != before[name]]:
        received = f"{texts}, which adds or takes columns: those of {', '.join(others)}"
        allowed = "allowed: what leaves the columns of the set as they are; give the healthy gearbox some of it"
        yield Problem(at, received, allowed)


def _every(gearbox: PossibleGearbox) -> list[Problem]:
    """Return all problems, each at the key that the user wrote."""
    names = gearbox.config.names
    return [names.problem(problem) for problem in (*gearbox.contradictions(), *physical_problems(gearbox))]


def _columns(gearbox: PossibleGearbox) -> dict[str, bool]:
    """Return what numbers alone give columns of its own, and whether there is any of it."""
    manufacture = gearbox.config.manufacture
    crowned = manufacture is not None and manufacture.has_crowning
    return {"variation": gearbox.config.variation.active, "manufacture.crowning_um": crowned}
