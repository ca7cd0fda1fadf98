"""Numbers of the stored samples of a channel that no level moves: repeats, equal tops, and the steps at both ends.

* Repeats: neighbours that are equal, beside those that differ by one to three steps of the converter. Where a signal
  crosses steps at all, small differences are equally frequent, however strong it is.
* Tops: samples as large as the largest, to a step of the converter. Its end does not count: several records reach it.
* Ends: rank of the first and the last difference among all of the record.
* Marks: runs around large samples, by which two records that share them bit by bit are found, wherever they stand.

Source: derived.
"""

from __future__ import annotations

import hashlib

import numpy as np

from diagnostics.audit.raw_edges import rank_of_first

MARKED_PARTS, MARK_REACH, FEWEST_VALUES = 32, 8, 12
"""Runs of 17 samples around the largest of every part; one of fewer values, such as a clipped one, marks nothing."""

NEIGHBOURS = 3
"""Steps up and down whose frequency the repeats are compared with."""

TOP = "largest sample"
"""Held by `stored_numbers` for `without_ends`, which takes it out."""


def stored_numbers(signal: np.ndarray) -> dict[str, float]:
    """Return the numbers of one channel (n,) float64 by name; none of fewer than three samples."""
    if signal.size < 3:
        return {}
    size, apart = np.abs(signal), np.abs(np.diff(signal))
    step = apart[apart > 0.0].min(initial=np.inf)
    near = 1.5 * step if np.isfinite(step) else 0.0
    return {
        "repeats": repeats_beyond_chance(apart),
        "samples as large as the largest": float(np.sum(size >= size.max() - near)),
        "first difference": rank_of_first(apart),
        "last difference": rank_of_first(apart[::-1]),
        TOP: float(size.max()),
    }


def repeats_beyond_chance(apart: np.ndarray) -> float:
    """Return by how many standard deviations equal neighbours exceed those a few steps apart.

    Parameters
    ----------
    apart : (n,) float64
        Differences of neighbours, without signs.
    """
    above = apart[apart > 0.0]
    if not above.size:
        return float(apart.size)
    steps = np.round(apart / above.min())
    few = float(np.sum((steps >= 1.0) & (steps <= NEIGHBOURS)))
    expected = few / (2.0 * NEIGHBOURS)
    return float((np.sum(apart == 0.0) - expected) / np.sqrt(expected + few / (2.0 * NEIGHBOURS) ** 2 + 1.0))


def without_ends(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return columns of all records without the largest samples; where several records share one, it counts once.

    Parameters
    ----------
    columns : dict of str to (records,) float64
        As of `stored_numbers`, "... of channel".
    """
    found = {name: values for name, values in columns.items() if not name.startswith(TOP)}
    for name, tops in columns.items():
        if name.startswith(TOP):
            _, place, counts = np.unique(tops, return_inverse=True, return_counts=True)
            own = f"samples as large as the largest{name.removeprefix(TOP)}"
            found[own] = np.where(counts[place.ravel()] > 1, 1.0, found[own])
    return found


def sample_marks(signal: np.ndarray) -> set[int]:
    """Return a number for the run of samples around the largest sample of every part of a record.

    Parameters
    ----------
    signal : (n,) float
        As it is stored; taken as float32.
    """
    stored = np.ascontiguousarray(signal, dtype="<f4")
    size, found = stored.size // MARKED_PARTS, set[int]()
    if size <= 2 * MARK_REACH:
        return found
    tops = stored[: size * MARKED_PARTS].reshape(MARKED_PARTS, size).argmax(axis=1) + size * np.arange(MARKED_PARTS)
    for top in tops.tolist():
        run = stored[max(top - MARK_REACH, 0) : top + MARK_REACH + 1]
        if run.size == 2 * MARK_REACH + 1 and np.unique(run).size >= FEWEST_VALUES:
            found.add(int.from_bytes(hashlib.blake2b(run.tobytes(), digest_size=8).digest(), "little"))
    return found
