"""Dropout: stretches of a record that a bad contact of a sensor's cable loses; the converter then stores zeros.

Gaps of 1 to 50 ms (assumed: a contact that shakes open) stand anywhere in the record, without overlap. Together they
lose the given share of it, to the sample.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from siggen.arrays import FloatArray

GAP_S = (1e-3, 50e-3)
Gaps = list[tuple[int, int]]
"""First sample of each gap, and the one behind its last; ascending."""


def dropout_gaps(samples: int, fs_hz: float, share: float, rng: np.random.Generator) -> Gaps:
    """Return where the signal is lost; nothing for a share of 0."""
    total = round(share * samples)
    lengths: list[int] = []
    while (left := total - sum(lengths)) > 0:
        lengths.append(min(max(1, round(fs_hz * rng.uniform(*GAP_S))), left))
    # what is kept is cut at random places, and a gap opens at each of them
    cuts = np.sort(rng.integers(0, samples - total, size=len(lengths), endpoint=True))
    before = np.cumsum([0, *lengths[:-1]]) if lengths else cuts
    return [
        (int(cut + lost), int(cut + lost) + length) for cut, lost, length in zip(cuts, before, lengths, strict=True)
    ]


def silence(block: FloatArray, first: int, gaps: Sequence[tuple[int, int]]) -> None:
    """Set what gaps hold of a block (n,) to zero, which begins at a sample of the record."""
    for start, stop in gaps:
        block[max(start - first, 0) : max(stop - first, 0)] = 0.0
