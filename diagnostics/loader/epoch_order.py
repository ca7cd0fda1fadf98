"""Who reads which window when: the windows of an epoch over ranks, workers, buffers and batches.

Shards are permuted; every rank takes an equal stretch of the windows in that order, every worker of it a stretch of
whole batches, so that ranks differ by one window at most and batches come from the workers strictly in turn; what is
decoded together is shuffled together. Pure: the same arguments give the same order on any machine. Source: derived.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from diagnostics.base.seeding import Purpose, generator
from siggen.errors import UsageError


@dataclass(frozen=True, slots=True)
class Shuffling:
    """How an epoch is mixed, and which process this is.

    Attributes
    ----------
    seed : int or None
        None keeps the order of the files.
    buffer_windows : int
        Windows of whole shards that are shuffled together, those of one shard more at most.
    rank, world_size : int
        Which of how many processes; each has an equal part of every epoch.

    Raises
    ------
    UsageError
        If the rank is not below the number of processes.
    """

    seed: int | None = 0
    buffer_windows: int = 4096
    rank: int = 0
    world_size: int = 1

    def __post_init__(self) -> None:
        if not 0 <= self.rank < self.world_size:
            raise UsageError(f"rank: received {self.rank} of {self.world_size}; allowed are 0 to {self.world_size - 1}")


class Lane(NamedTuple):
    """Which of the workers of a process reads."""

    worker: int = 0
    workers: int = 1


def rank_windows(windows: int, part: Shuffling) -> tuple[int, int]:
    """Return the first and the last but one position of the windows of a rank; ranks differ by one window at most."""
    return windows * part.rank // part.world_size, windows * (part.rank + 1) // part.world_size


def lane_sizes(windows: int, batch: int, workers: int) -> np.ndarray:
    """Return how many windows every worker of a rank has, (workers,) int, if batch i comes from worker i % workers."""
    sizes = np.full(-(-windows // batch), batch, dtype=np.int64)
    if sizes.size:
        sizes[-1] = windows - batch * (sizes.size - 1)
    return np.bincount(np.arange(sizes.size) % workers, weights=sizes, minlength=workers).astype(np.int64)


def epoch_chunks(group: np.ndarray, epoch: int, reader: Lane, batch: int, shuffling: Shuffling) -> list[np.ndarray]:
    """Return the windows that one worker reads in an epoch, chunk by chunk.

    Parameters
    ----------
    group : (n,) int
        Shard of every window, ascending.
    epoch : int
        Another epoch, another order.
    reader : Lane
        Which worker of the process.
    batch : int
        Windows of a batch.
    shuffling : Shuffling
        Seed, size of the buffer, and which process.

    Returns
    -------
    list of (k,) int
        Numbers of windows; those of a shard are in one chunk, which is decoded at once.
    """
    place = _group_places(int(group[-1]) + 1 if group.size else 0, epoch, shuffling)
    sequence = np.argsort(place[group], kind="stable")
    first, last = rank_windows(group.size, shuffling)
    ends = np.cumsum(lane_sizes(last - first, batch, reader.workers))
    start = int(ends[reader.worker - 1]) if reader.worker else 0
    lane = sequence[first + start : first + int(ends[reader.worker])]
    counts = np.bincount(place[group])
    buffer = ((np.cumsum(counts) - counts) // shuffling.buffer_windows)[place[group[lane]]]
    chunks = np.split(lane, np.flatnonzero(np.diff(buffer)) + 1) if lane.size else []
    if shuffling.seed is None:
        return chunks
    rng = generator(shuffling.seed, Purpose.LOADER, epoch, 1 + shuffling.rank, reader.worker)
    return [rng.permutation(chunk) for chunk in chunks]


def _group_places(groups: int, epoch: int, shuffling: Shuffling) -> np.ndarray:
    """Return at which place every shard comes; the same for all ranks and workers."""
    if shuffling.seed is None:
        return np.arange(groups)
    return generator(shuffling.seed, Purpose.LOADER, epoch).permutation(groups)
