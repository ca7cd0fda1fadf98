"""Columns of a table where they are needed: intervals are halved until the middle is what the ends say of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from siggen.arrays import FloatArray, IntArray

Bent = Callable[[FloatArray, FloatArray, FloatArray, float], bool]
"""Whether a middle column is not the mean of a low and a high one; the weight of the high one comes last."""


def halved(
    wanted: Sequence[int], solve: Callable[[IntArray], FloatArray], bent: Bent, finest: int
) -> tuple[IntArray, FloatArray]:
    """Return places (k,), ascending, and their columns (k, ...).

    Parameters
    ----------
    wanted : sequence of int
        Places of the first columns, ascending.
    solve : callable
        Returns the columns at places.
    bent : callable
    finest : int
        Intervals that are not halved any more.
    """
    found = dict(zip(wanted, solve(np.array(wanted)), strict=True))
    intervals = list(pairwise(wanted))
    while intervals := [(low, high) for low, high in intervals if high - low > finest]:
        middles = [(low + high) // 2 for low, high in intervals]
        found |= dict(zip(middles, solve(np.array(middles)), strict=True))
        parted = [
            (low, middle, high)
            for (low, high), middle in zip(intervals, middles, strict=True)
            if bent(found[low], found[middle], found[high], (middle - low) / (high - low))
        ]
        intervals = [part for low, middle, high in parted for part in ((low, middle), (middle, high))]
    places = np.array(sorted(found), dtype=np.int64)
    return places, np.stack([found[i] for i in places.tolist()])
