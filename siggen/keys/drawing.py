"""Replacing the distributions of a section by drawn values, corners of what is drawn, and drawn values in SI."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import Any, TypeAlias, TypeVar

from siggen.keys.distributions import DRAWN
from siggen.keys.number import HIGH, LOW, MIDDLE, Each, Within, at, constant, each_of
from siggen.keys.section import Section

SomeSection = TypeVar("SomeSection", bound=Section)
Part = TypeVar("Part")
Uniforms: TypeAlias = Callable[[str], float]
"""Path of a key -> the uniform in [0, 1) that belongs to it, or an end of its number."""
MOST_CROSSED = 10
"""Numbers of a part whose ends are all combined; of more each end by itself, and all low or high at once."""
IN_SI = {"mm": ("m", 1e-3), "um": ("m", 1e-6), "ms": ("s", 1e-3)}
"""Unit at the end of a key -> that of SI, and what to multiply by; compound units such as `um_s` stay."""


def draw(section: SomeSection, uniform: Uniforms, path: str) -> SomeSection:
    """Return a section with every distribution replaced by a value.

    Parameters
    ----------
    section : Section
    uniform : callable
        Path of a key -> the uniform in [0, 1) that belongs to it.
    path : str
        Where the section stands in the configuration; keys below it are joined with dots.
    """
    changed: dict[str, object] = {}
    for name, field in type(section).model_fields.items():
        value, below = getattr(section, name), f"{path}.{name}"
        if (law := next((marker for marker in field.metadata if isinstance(marker, Within)), None)) is not None:
            changed[name] = _drawn(value, uniform, below, law.count)
        elif isinstance(value, Section):
            changed[name] = draw(value, uniform, below)
        elif isinstance(value, tuple) and value and all(isinstance(part, Section) and part.key_field for part in value):
            changed[name] = tuple(draw(part, uniform, f"{below}.{getattr(part, part.key_field)}") for part in value)
    return section.model_copy(update=changed)


def _drawn(value: Any, uniform: Uniforms, name: str, count: int) -> object:
    if count and value is not None:
        numbers = enumerate(each_of(value, count))
        return Each(each=tuple(_drawn(number, uniform, f"{name}.{place}", 0) for place, number in numbers))  # type: ignore[misc]
    return at(value, uniform(name)) if isinstance(value, DRAWN) else value


def corners(part: Callable[[Uniforms], Part], *of: str) -> Iterator[Part]:
    """Yield a part as it is drawn at the ends of the numbers that it is drawn from; once if it has none.

    Parameters
    ----------
    part : callable
        What draws the part: uniforms by the paths of keys -> the part.
    *of : str
        What the paths of numbers have in them whose ends count, all others are in their middle; without any all count.
    """
    names: dict[str, float] = {}

    def noted(name: str) -> float:
        return names.setdefault(name, MIDDLE) if not of or any(one in name for one in of) else MIDDLE

    typical = part(noted)
    if not names:
        yield typical
        return
    crossed = product((LOW, HIGH), repeat=len(names)) if len(names) <= MOST_CROSSED else _apart(len(names))
    for ends in crossed:
        at_ends = dict(zip(names, ends, strict=True))
        yield part(lambda name, at_ends=at_ends: at_ends.get(name, MIDDLE))  # type: ignore[misc]


def _apart(count: int) -> Iterator[tuple[float, ...]]:
    """Yield all ends low, all high, and each of them alone."""
    for end in (LOW, HIGH):
        yield (end,) * count
        yield from (tuple(end if one == place else MIDDLE for one in range(count)) for place in range(count))


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
