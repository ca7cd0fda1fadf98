"""Windows of a set for torch: shuffled, split over ranks and workers, and resumed in the middle of an epoch.

    loader = WindowLoader(WindowStream(siggen.open("data/set"), "train", batch=64), workers=2)
    for batch in loader:
        loss = step(batch["windows"], batch["state_id"])
        position = loader.state_dict()

Records of one row group are decoded once; a random record would cost a whole row group each.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.utils.data import DataLoader, IterableDataset, get_worker_info

from diagnostics.loader.epoch_order import Part, Shuffling, epoch_chunks, rank_windows
from diagnostics.loader.row_group_signals import RowGroupSignals
from diagnostics.loader.window_index import StreamSettings, window_index
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

Batch = dict[str, torch.Tensor]


@dataclass(slots=True)
class Position:
    """Where an epoch goes on: its number, and the batches of this rank that were already delivered."""

    epoch: int = 0
    delivered: int = 0


class WindowStream(IterableDataset[Batch]):  # type: ignore[misc]  # the type checker does not read torch
    """Batches of windows of one split; iterate it through a `WindowLoader`.

    A batch has `windows` (batch, channels, samples) float32 in the unit of the channels, `record_id`, `specimen_id`,
    `state_id`, `class_id` (batch,) int64 (all healthy states are one class) and `damaged_area_mm2` (batch,) float64.
    All windows of an epoch come exactly once over all ranks and workers; ranks differ by one window at most, so give
    every rank the same number of steps.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    split : str
        Split to read.
    settings : StreamSettings, optional
        Default: windows of 8 pinion revolutions of 288 angle steps, every 4 revolutions.
    batch : int
        Windows of a batch; the last of a rank may be smaller.
    rank, world_size : int
        Which of how many processes this is.
    shuffling : Shuffling, optional
        Seed and buffer; `Shuffling(seed=None)` keeps the order of the files.
    cache : Path, optional
        Folder for decoded records, read through memory mapping; worth it where they are read more than once.

    Raises
    ------
    UsageError
        If a number is out of range.
    DatasetError
        If no record of the split holds a whole window.
    """

    def __init__(
        self,
        dataset: Dataset,
        split: str,
        settings: StreamSettings | None = None,
        *,
        batch: int = 32,
        rank: int = 0,
        world_size: int = 1,
        shuffling: Shuffling | None = None,
        cache: Path | None = None,
    ) -> None:
        if batch < 1:
            raise UsageError(f"batch: received {batch}; allowed are 1 or more windows")
        chosen = settings or StreamSettings()
        self.part = Part(rank, world_size)
        self.batch = batch
        self.shuffling = shuffling or Shuffling()
        self.index = window_index(dataset, split, chosen)
        self.signals = RowGroupSignals(dataset, split, dataset.row_groups(split), chosen, self.index, cache)
        self.position = Position()

    def __len__(self) -> int:
        """Batches of this rank in an epoch."""
        first, last = rank_windows(self.index.size, self.part)
        return (last - first + self.batch - 1) // self.batch

    def __iter__(self) -> Iterator[Batch]:
        """Yield the batches of this worker that the position has not passed."""
        worker, workers = _worker()
        delivered = self.position.delivered
        # torch asks worker 0 first; after k batches it is the turn of the one that would have come then
        lane = (worker + delivered) % workers
        part = Part(self.part.rank, self.part.world_size, lane, workers)
        chunks = epoch_chunks(self.index.group, self.position.epoch, part, self.batch, self.shuffling)
        passed = len(range(lane, delivered, workers)) * self.batch
        yield from self._batches(chunks, passed)

    def _batches(self, chunks: list[np.ndarray], passed: int) -> Iterator[Batch]:
        """Cut the windows of the chunks into batches; chunks that were passed are not decoded."""
        waiting: list[tuple[int, list[np.ndarray]]] = []
        for chunk in chunks:
            rest, passed = chunk[passed:], max(passed - chunk.size, 0)
            if not rest.size:
                continue
            for number, window in zip(rest.tolist(), self._windows(rest), strict=True):
                waiting.append((number, window))
                if len(waiting) == self.batch:
                    yield self._collated(waiting)
                    waiting = []
        if waiting:
            yield self._collated(waiting)

    def _windows(self, chosen: np.ndarray) -> Iterator[list[np.ndarray]]:
        """Yield the windows as channels of samples, views into the decoded records of the chunk."""
        index = self.index
        decoded = {
            group: self.signals.read(group, np.unique(index.row[chosen[index.group[chosen] == group]]).tolist())
            for group in np.unique(index.group[chosen]).tolist()
        }
        for number in chosen.tolist():
            record = decoded[int(index.group[number])][int(index.row[number])]
            start = int(index.start[number])
            yield [channel[start : start + index.samples] for channel in record]

    def _collated(self, found: list[tuple[int, Any]]) -> Batch:
        windows = np.empty((len(found), len(found[0][1]), self.index.samples), dtype=np.float32)
        for place, (_, channels) in enumerate(found):
            for row, channel in enumerate(channels):
                windows[place, row] = channel
        record = self.index.record[[number for number, _ in found]]
        labels = {name: torch.from_numpy(values[record]) for name, values in self.index.labels.items()}
        return {"windows": torch.from_numpy(windows), **labels}


class WindowLoader:
    """Iterates a stream, in this process or by `workers` of them, and knows where it is.

    One iteration is the rest of one epoch; the next one begins the next epoch. The order depends on the seed, the
    epoch, `world_size`, the batch size and the number of workers.
    """

    def __init__(self, stream: WindowStream, workers: int = 0) -> None:
        if workers < 0:
            raise UsageError(f"workers: received {workers}; allowed are 0 (this process) or more")
        self.stream = stream
        self.workers = workers

    def __len__(self) -> int:
        """Batches of this rank in a whole epoch."""
        return len(self.stream)

    def __iter__(self) -> Iterator[Batch]:
        """Yield the rest of the epoch."""
        position = self.stream.position
        # batches are ready-made; every worker gets a copy of the stream with its position
        for batch in DataLoader(self.stream, batch_size=None, num_workers=self.workers):
            position.delivered += 1
            yield batch
        self.stream.position = Position(position.epoch + 1)

    def state_dict(self) -> dict[str, Any]:
        """Return the position as plain values; what was yielded counts as delivered."""
        position = self.stream.position
        return {"epoch": position.epoch, "delivered": position.delivered, **self._facts()}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Go on where another loader was.

        Raises
        ------
        UsageError
            If that loader had other windows, batches, workers, ranks or another seed: the rest of its epoch would
            then not be what it had not delivered.
        """
        facts = self._facts()
        differing = [
            f"{name} {state.get(name)!r} instead of {facts[name]!r}" for name in facts if state.get(name) != facts[name]
        ]
        if differing:
            raise UsageError(
                f"the saved position belongs to another loader: it has {', '.join(differing)}. Make the loader with "
                "the same set, settings, seed, batch, ranks and workers, or begin the epoch anew."
            )
        self.stream.position = Position(int(state["epoch"]), int(state["delivered"]))

    def _facts(self) -> dict[str, Any]:
        stream = self.stream
        return {
            "windows": stream.index.fingerprint(),
            "seed": stream.shuffling.seed,
            "buffer_groups": stream.shuffling.buffer_groups,
            "batch": stream.batch,
            "rank": stream.part.rank,
            "world_size": stream.part.world_size,
            "workers": self.workers,
        }


def _worker() -> tuple[int, int]:
    info = get_worker_info()
    return (info.id, info.num_workers) if info else (0, 1)
