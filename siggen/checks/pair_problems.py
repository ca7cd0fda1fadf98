"""What is impossible for one of a set's gear pairs, told pair by pair, so that no gearbox turns out impossible."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from pydantic import ValidationError

from siggen.errors import Problem
from siggen.keys.problems import joined, section_problems
from siggen.keys.section import Section
from siggen.rig.carried_over import carried_over

Check = Callable[[Mapping[str, Any]], Iterable[Problem]]


def pair_problems(sections: Mapping[str, Any], check: Check) -> tuple[Problem, ...]:
    """Return the first problem of each pair of `gears.pairs`: a number out of its range, or what a check finds.

    Parameters
    ----------
    sections : mapping
        Valid sections of a configuration; states and sensors as mappings from their index.
    check : callable
        Sections of one pair -> problems.
    """
    if "operating_points" not in sections:
        return ()
    return tuple(
        Problem(f"gears.pairs.{index}", f"{pair}: {problem.path} would be {problem.received}", problem.allowed)
        for index, pair in enumerate(sections["gears"].pairs)
        if (problem := _first(sections, carried_over(sections, pair), check)) is not None
    )


def _first(sections: Mapping[str, Any], changed: dict[str, Any], check: Check) -> Problem | None:
    outside = next((one for name, value in changed.items() for one in _out_of_range(name, value)), None)
    return outside or next(iter(check({**sections, **changed})), None)


def _out_of_range(path: str, value: Any) -> Iterator[Problem]:
    """Yield numbers that a section must not hold, though nobody wrote them: they were carried over."""
    if isinstance(value, Section):
        try:
            type(value).model_validate(value.model_dump())
        except ValidationError as error:
            for problem in section_problems(type(value), error.errors()):
                yield Problem(joined(path, problem.path), problem.received, problem.allowed)
        return
    entries = value.items() if isinstance(value, Mapping) else enumerate(value)
    for index, entry in entries:
        yield from _out_of_range(joined(path, index), entry)
