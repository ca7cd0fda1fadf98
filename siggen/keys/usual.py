"""Usual: the range in which a key's numbers lie in machines that are built, beside what is allowed.

A number outside is taken, and named before a set is made: mostly it is a slip of units. Ranges are judgement: wide for
machines, and narrower than a slip by 60 or by 1000 of what presets have. What counts by another number, such as a face
width by its module, stands in `siggen.checks.plausibility`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from siggen.keys.distributions import DRAWN
from siggen.keys.number import bounds
from siggen.keys.section import Section


@dataclass(frozen=True, slots=True)
class Usual:
    """Mark of a key: its numbers, without their sign, usually lie between; 0 stands for none and is usual, too."""

    least: float
    most: float

    def holds(self, low: float, high: float) -> bool:
        """Return whether a number with these bounds is usual; of a range that begins at 0 its end counts."""
        sizes = sorted((abs(low), abs(high)))
        if low <= 0.0 <= high:
            sizes = sizes[1:]
        return all(size == 0.0 or self.least <= size <= self.most for size in sizes)


def unusual(section: Section, path: str = "") -> Iterator[tuple[str, tuple[float, float], Usual]]:
    """Yield path, bounds and usual range of every number of a section that lies outside its own."""
    for name, field in type(section).model_fields.items():
        value, here = getattr(section, name), f"{path}.{name}" if path else name
        marks = [mark for mark in field.metadata if isinstance(mark, Usual)]
        listed = isinstance(value, tuple)
        for place, item in enumerate(value if listed else (value,)):
            key = getattr(item, item.key_field) if isinstance(item, Section) and item.key_field else place
            at = f"{here}.{key}" if listed else here
            if isinstance(item, (int, float, *DRAWN)) and not isinstance(item, bool):
                low, high = bounds(float(item) if isinstance(item, int) else item)
                yield from ((at, (low, high), mark) for mark in marks if not mark.holds(low, high))
            elif isinstance(item, Section):
                yield from unusual(item, at)
