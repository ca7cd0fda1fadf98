"""BlockResponses: how every input of a record reaches every channel, sensor included, as filters of limited length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import ComplexArray
from siggen.sensing.block_filter import TOGETHER, BlockGrid, limited
from siggen.sensing.inputs import Input


@dataclass(frozen=True, slots=True)
class BlockResponses:
    """Channel -> input -> spectrum (length // 2 + 1,) of the filter; no inputs that a channel does not feel."""

    grid: BlockGrid
    filters: Mapping[str, Mapping[Input, NDArray[np.complex64]]]

    @property
    def inputs(self) -> tuple[Input, ...]:
        """All inputs that a channel feels."""
        return tuple(dict.fromkeys(one for filters in self.filters.values() for one in filters))


def block_responses(grid: BlockGrid, ways: Mapping[str, Mapping[Input, ComplexArray]]) -> BlockResponses:
    """Return the filters of responses (memory // 2 + 1,)."""
    return BlockResponses(grid, {name: _filters(grid, found) for name, found in ways.items()})


def _filters(grid: BlockGrid, ways: Mapping[Input, ComplexArray]) -> dict[Input, NDArray[np.complex64]]:
    names, responses = tuple(ways), tuple(ways.values())
    parts = (np.array(responses[k : k + TOGETHER]) for k in range(0, len(responses), TOGETHER))
    return dict(zip(names, (row for part in parts for row in limited(part, grid)), strict=True))
