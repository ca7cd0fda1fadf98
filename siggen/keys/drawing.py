"""Replacing the distributions of a section: by drawn values, or by their bounds; and drawn values in SI."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from siggen.keys.distributions import DRAWN
from siggen.keys.number import Within, at, bounds, constant
from siggen.keys.section import Section

SomeSection = TypeVar("SomeSection", bound=Section)
IN_SI = {"mm": ("m", 1e-3), "um": ("m", 1e-6), "ms": ("s", 1e-3)}
"""Unit at the end of a key -> that of SI, and what to multiply by; compound units such as `um_s` stay."""


def draw(section: SomeSection, uniform: Callable[[str], float], path: str) -> SomeSection:
    """Return a section with every distribution replaced by a value.

    Parameters
    ----------
    section : Section
    uniform : callable
        Path of a key -> the uniform in [0, 1) that belongs to it.
    path : str
        Where the section stands in the configuration; keys below it are joined with dots.
    """

    def drawn(value: object, name: str) -> object:
        is_drawn = isinstance(value, DRAWN)
        return at(value, uniform(name)) if is_drawn else value  # type: ignore[arg-type]

    return _replaced(section, drawn, path)


def corners(section: SomeSection) -> Iterator[SomeSection]:
    """Yield the section with its distributions at every combination of their bounds; itself if it has none."""
    pairs: list[tuple[object, ...]] = []

    def noted(value: object, _: str) -> object:
        is_drawn = isinstance(value, DRAWN)
        pairs.append(tuple(dict.fromkeys(bounds(value))) if is_drawn else (value,))  # type: ignore[arg-type]
        return value

    _replaced(section, noted, "")
    for combination in itertools.product(*pairs):
        values = iter(combination)
        yield _replaced(section, lambda *_, values=values: next(values), "")


def in_si(section: Section) -> dict[str, Any]:
    """Return the numbers of a drawn section by their keys, in SI: `roll_off_mm` as `roll_off_m`.

    Raises
    ------
    TypeError
        If a number is still a distribution.
    """
    found: dict[str, Any] = {}
    for key, field in type(section).model_fields.items():
        if not any(isinstance(marker, Within) for marker in field.metadata):
            continue
        number, (head, _, unit) = getattr(section, key), key.rpartition("_")
        if unit in IN_SI and not head.endswith("_per"):
            unit, factor = IN_SI[unit]
            found[f"{head}_{unit}"] = factor * constant(number)
        else:
            found[key] = number if number is None else constant(number)
    return found


def _replaced(section: SomeSection, replacement: Callable[[object, str], object], path: str) -> SomeSection:
    changed: dict[str, object] = {}
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        if any(isinstance(marker, Within) for marker in field.metadata):
            changed[name] = replacement(value, f"{path}.{name}")
        elif isinstance(value, Section):
            changed[name] = _replaced(value, replacement, f"{path}.{name}")
    return section.model_copy(update=changed)
