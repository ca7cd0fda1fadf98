"""Replacing the distributions of a section: by drawn values, or by their bounds."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import TypeVar

import numpy as np

from siggen.config.number import Choice, LogUniform, Normal, Uniform, Within, at, bounds
from siggen.config.section import Section

SomeSection = TypeVar("SomeSection", bound=Section)


def draw(section: SomeSection, rng: np.random.Generator) -> SomeSection:
    """Return a section with every distribution replaced by a value.

    Every physical number takes exactly one uniform from `rng`, in the order in which the section declares them,
    constants and nulls too; so a number that becomes a distribution leaves its neighbours as they were.
    """

    def drawn(value: object) -> object:
        u = rng.random()
        return at(value, u) if isinstance(value, (Uniform, LogUniform, Normal, Choice)) else value

    return _replaced(section, drawn)


def corners(section: SomeSection) -> Iterator[SomeSection]:
    """Yield the section with its distributions at every combination of their bounds; itself if it has none."""
    pairs: list[tuple[object, ...]] = []

    def noted(value: object) -> object:
        is_drawn = isinstance(value, (Uniform, LogUniform, Normal, Choice))
        pairs.append(tuple(dict.fromkeys(bounds(value))) if is_drawn else (value,))  # type: ignore[arg-type]
        return value

    _replaced(section, noted)
    for combination in itertools.product(*pairs):
        values = iter(combination)
        yield _replaced(section, lambda _, values=values: next(values))  # type: ignore[misc]


def _replaced(section: SomeSection, replacement: Callable[[object], object]) -> SomeSection:
    changed: dict[str, object] = {}
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        if any(isinstance(marker, Within) for marker in field.metadata):
            changed[name] = replacement(value)
        elif isinstance(value, Section):
            changed[name] = _replaced(value, replacement)
    return section.model_copy(update=changed)
