"""A section with some of its numbers multiplied: what is written for one size of gearbox, carried over to another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from siggen.keys.distributions import Choice, LogUniform, Normal, Uniform
from siggen.keys.number import Each
from siggen.keys.section import Section

SomeSection = TypeVar("SomeSection", bound=Section)


@dataclass(frozen=True, slots=True)
class Grows:
    """Mark of a key whose numbers are multiplied by the factor of this name where a gearbox has another size."""

    factor: str


def grown(section: SomeSection, factors: Mapping[str, float]) -> SomeSection:
    """Return a section whose marked numbers are multiplied by the factor of their mark, at any depth."""
    changed: dict[str, Any] = {}
    for name, field in type(section).model_fields.items():
        value, marks = getattr(section, name), [mark for mark in field.metadata if isinstance(mark, Grows)]
        if marks:
            changed[name] = multiplied(value, factors[marks[-1].factor])
        elif isinstance(value, Section):
            changed[name] = grown(value, factors)
        elif isinstance(value, tuple) and value and all(isinstance(item, Section) for item in value):
            changed[name] = tuple(grown(item, factors) for item in value)
    return section.model_copy(update=changed)


def scaled(section: SomeSection, factors: Mapping[str, float]) -> SomeSection:
    """Return a section whose numbers are multiplied; words, null and keys without a factor stay as they are.

    Parameters
    ----------
    section : Section
    factors : mapping
        Path of a key below the section, joined with dots and without indices of lists -> factor.
    """
    return _scaled(section, factors, "")


def multiplied(value: Any, factor: float) -> Any:
    """Return a number, distribution or tuple of them times a factor; anything else as it is, and all by 1."""
    if isinstance(value, float):
        return value * factor
    if isinstance(value, Each):
        return value.model_copy(update={"each": multiplied(value.each, factor)})
    if isinstance(value, tuple):
        return tuple(multiplied(item, factor) for item in value)
    if isinstance(value, (Uniform, LogUniform, Normal, Choice)):
        numbers = {key: getattr(value, key) for key in type(value).model_fields}
        return value.model_copy(update={key: multiplied(number, factor) for key, number in numbers.items()})
    return value


def _scaled(section: SomeSection, factors: Mapping[str, float], below: str) -> SomeSection:
    changed: dict[str, Any] = {}
    for name in type(section).model_fields:
        value, path = getattr(section, name), f"{below}{name}"
        if path in factors:
            changed[name] = multiplied(value, factors[path])
        elif isinstance(value, Section):
            changed[name] = _scaled(value, factors, f"{path}.")
        elif isinstance(value, tuple) and value and all(isinstance(item, Section) for item in value):
            changed[name] = tuple(_scaled(item, factors, f"{path}.") for item in value)
    return section.model_copy(update=changed)
