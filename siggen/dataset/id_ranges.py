"""Inclusive ranges of ids, worked out when they are read: a set of a million records has half a million of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import overload

Range = tuple[int, int]
"""First and last id."""


class IdRanges(Sequence[Range]):
    """Ascending ids as inclusive ranges, which equal a tuple or list of them.

    Parameters
    ----------
    groups : sequence of int
        Ascending numbers of groups; kept, not copied.
    per_group : int
        Ids of a group: group i holds i * per_group to (i + 1) * per_group - 1.
    """

    def __init__(self, groups: Sequence[int], per_group: int = 1) -> None:
        self._groups, self._per_group = groups, per_group

    def __iter__(self) -> Iterator[Range]:
        size = self._per_group
        return ((first * size, (last + 1) * size - 1) for first, last in _ranges(self._groups))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    @overload
    def __getitem__(self, index: int) -> Range: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Range, ...]: ...
    def __getitem__(self, index: int | slice) -> Range | tuple[Range, ...]:
        return tuple(self)[index]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and tuple(self) == tuple(map(tuple, other))

    def __hash__(self) -> int:
        return hash(tuple(self))


def id_ranges(ids: Iterable[int]) -> tuple[Range, ...]:
    """Return ascending ids as inclusive ranges."""
    return tuple(_ranges(ids))


def _ranges(ids: Iterable[int]) -> Iterator[Range]:
    first: int | None = None
    last = 0
    for i in ids:
        if first is None:
            first = i
        elif i != last + 1:
            yield first, last
            first = i
        last = i
    if first is not None:
        yield first, last
