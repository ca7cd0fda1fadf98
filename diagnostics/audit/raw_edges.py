"""Beginning and end of raw records, and their means: where a program that cuts or fades leaves its mark.

* Edges: the rank of the first and last block among all blocks of the record, in level, mean and slope. Records start at
  a random angle, so every block has the same law, whatever the damage: the rank is uniform.
* Offsets: mean of an acceleration, and rise of a straight line through it. Nothing that vibrates in place has one.

Source: derived.
"""

from __future__ import annotations

import numpy as np

EDGE_SAMPLES, EDGE_PARTS = (16, 64), 16
"""Blocks of so many samples, and one part of so many of the record."""

SHAPED_SAMPLES = 64
"""Block whose mean and slope count too."""

TINY = 1e-30


def edge_ranks(signal: np.ndarray) -> dict[str, float]:
    """Return the shares of blocks that lie below the first and the last one, 0 to 1, by name; none of short records.

    Parameters
    ----------
    signal : (n,) float64
    """
    found = {}
    for edge, turned in (("first", signal), ("last", signal[::-1])):
        for size in (*EDGE_SAMPLES, signal.size // EDGE_PARTS):
            if size < EDGE_SAMPLES[0] or signal.size < EDGE_PARTS * size:
                continue
            blocks = turned[: signal.size // size * size].reshape(-1, size)
            found[f"level, {edge} {size} samples"] = rank_of_first(np.square(blocks).mean(axis=1))
            if size == SHAPED_SAMPLES:
                found[f"mean, {edge} {size} samples"] = rank_of_first(blocks.mean(axis=1))
                half = np.square(blocks).reshape(len(blocks), 2, -1).mean(axis=2)
                found[f"slope of the level, {edge} {size} samples"] = rank_of_first(
                    np.log((half[:, 1] + TINY) / (half[:, 0] + TINY))
                )
    return found


def offsets(signal: np.ndarray) -> dict[str, float]:
    """Return the mean of samples (n,) float64, and by how much a straight line rises over the record."""
    course = np.linspace(-0.5, 0.5, signal.size) if signal.size > 1 else np.zeros(signal.size)
    return {"mean": float(signal.mean()), "rise": 12.0 * float(np.mean(signal * course))}


def rank_of_first(values: np.ndarray) -> float:
    """Return the share of the others that lie below the first, ties counted half."""
    return float(np.mean(0.5 + 0.5 * np.sign(values[0] - values[1:])))
