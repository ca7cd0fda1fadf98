"""What is impossible for one of a set's gear pairs, told pair by pair, so that no gearbox turns out impossible."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from pydantic import ValidationError

from siggen.errors import Problem
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.problems import joined, section_problems
from siggen.keys.section import Section


def pair_problems(
    gearbox: PossibleGearbox, check: Callable[[PossibleGearbox], Iterable[Problem]]
) -> tuple[Problem, ...]:
    """Return the first problem of each pair of `gears.pairs`: a number out of its range, or what a check finds."""
    told = []
    for index, own in enumerate(gearbox.pairs):
        changed = {key: value for key, value in own.config if value is not getattr(gearbox.config, key)}
        outside = (one for key, value in changed.items() for one in _out_of_range(key, value))
        problem = next(outside, None) or next(iter(check(own)), None)
        if problem is not None:
            received = f"{gearbox.config.gears.pairs[index]}: {problem.path} would be {problem.received}"
            told.append(Problem(f"gears.pairs.{index}", received, problem.allowed))
    return tuple(told)


def _out_of_range(path: str, value: Any) -> Iterator[Problem]:
    """Yield numbers that a section must not hold, though nobody wrote them: they were carried over."""
    if isinstance(value, tuple):
        for place, entry in enumerate(value):
            yield from _out_of_range(joined(path, getattr(entry, entry.key_field) if entry.key_field else place), entry)
    elif isinstance(value, Section):
        try:
            type(value).model_validate(value.model_dump())
        except ValidationError as error:
            for problem in section_problems(type(value), error.errors()):
                yield Problem(joined(path, problem.path), problem.received, problem.allowed)
