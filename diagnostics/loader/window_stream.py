"""Windows of a set for torch: shuffled, split over ranks and workers, and resumed in the middle of an epoch.

    loader = WindowLoader(WindowStream(siggen.open("runs/set"), "train", batch=64), workers=2)
    for batch in loader:
        loss = step(batch["windows"], batch["state_id"])
        position = loader.state_dict()

Records of one shard are decoded once; a random record would cost a whole shard each. Every iteration is the
next epoch, through a `WindowLoader` or through torch's `DataLoader`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.utils.data import DataLoader, IterableDataset, default_collate, get_worker_info
from torch.utils.data._utils.collate import default_collate_fn_map

from diagnostics.loader.epoch_order import Lane, Shuffling, epoch_chunks, rank_windows
from diagnostics.loader.window_index import StreamSettings, window_index
from diagnostics.loader.window_sample import Sample, ShardSignals, Transform, transformed, window_sample
from diagnostics.records.usable_records import of_quantity
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

MOST_WORKERS = 1024


class Batch(dict[str, Any]):
    """A batch of windows; torch's collation refuses to make a batch of several of them."""


def _refused(batches: list[Batch], **_: Any) -> None:
    raise UsageError(
        f"batch_size: DataLoader wants to join {len(batches)} items of a WindowStream, but each of them is a batch "
        "already. Give DataLoader batch_size=None, or give WindowStream "
        "batch=None: it then yields single windows, and DataLoader's batch_size holds"
    )


default_collate_fn_map[Batch] = _refused


@dataclass(slots=True)
class Position:
    """Where an epoch goes on: its number, and the batches of this rank that were already delivered."""

    epoch: int = 0
    delivered: int = 0


class WindowStream(IterableDataset[Any]):  # type: ignore[misc]  # the type checker does not read torch
    """Windows of one split, in batches or one by one, for a `WindowLoader` or torch's `DataLoader`.

    A batch has `windows` (batch, channels, samples) float32 in the unit of the channels, `record_id`, `specimen_id`,
    `state_id`, `class_id` (batch,) int64 (all healthy states are one class) and `damaged_area_mm2` (batch,) float64.
    All windows of an epoch come exactly once over all ranks and workers; ranks differ by one window at most, so give
    every rank the same number of steps. Every iteration is another epoch.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    split : str
        Split to read.
    settings : StreamSettings, optional
        Default: windows of 8 pinion revolutions of 288 angle steps, every 4 revolutions.
    batch : int or None
        Windows of a batch; the last of a rank may be smaller. None: single windows, for `DataLoader(batch_size=...)`.
    shuffling : Shuffling, optional
        Seed and buffer, and which of how many processes this is; `Shuffling(seed=None)` keeps the order of the files.
    cache : Path, optional
        Folder for decoded records, read through memory mapping; worth it where they are read more than once.
    labels : sequence of str
        Further labels, see `diagnostics.loader.window_index`.
    transform : callable, optional
        Takes a single window with its labels and a generator, and returns what is batched. The generator depends on
        seed, epoch and window alone.

    Raises
    ------
    UsageError
        If a number is out of range, or no channel holds the quantity.
    DatasetError
        If no record of the split holds a whole window.
    """

    def __init__(
        self,
        dataset: Dataset,
        split: str,
        settings: StreamSettings | None = None,
        *,
        batch: int | None = 32,
        shuffling: Shuffling | None = None,
        cache: Path | None = None,
        labels: Sequence[str] = (),
        transform: Transform | None = None,
    ) -> None:
        if batch is not None and batch < 1:
            raise UsageError(f"batch: received {batch}; allowed are 1 or more windows, or None for single ones")
        chosen = settings or StreamSettings()
        dataset = of_quantity(dataset, chosen.quantity)
        self.batch = batch
        self.shuffling = shuffling or Shuffling()
        self.index = window_index(dataset, split, chosen, labels)
        self.transform = transform
        self.signals = ShardSignals(dataset, split, dataset.shards(split), chosen, self.index, cache)
        # how often each worker began an epoch; shared, since a DataLoader makes new copies of the stream every time
        self._begun = torch.zeros(MOST_WORKERS, dtype=torch.int64).share_memory_()
        self.position = Position()

    @property
    def position(self) -> Position:
        """Where the next iteration begins; setting it makes all workers begin there."""
        return self._position

    @position.setter
    def position(self, position: Position) -> None:
        self._position = position
        self._begun.zero_()

    def __len__(self) -> int:
        """Batches of this rank in an epoch."""
        if self.batch is None:
            raise TypeError("a stream of single windows does not know into how many batches they will be put")
        first, last = rank_windows(self.index.size, self.shuffling)
        return (last - first + self.batch - 1) // self.batch

    def __iter__(self) -> Iterator[Any]:
        """Return this worker's part of the next epoch, without what the position has passed of the first one."""
        worker, workers = _worker()
        begun = int(self._begun[worker])
        self._begun[worker] += 1
        return self._epoch(self.position.epoch + begun, self.position.delivered if begun == 0 else 0, worker, workers)

    def _epoch(self, epoch: int, delivered: int, worker: int, workers: int) -> Iterator[Any]:
        # torch asks worker 0 first; after k batches it is the turn of the one that would have come then
        lane = (worker + delivered) % workers
        chunks = epoch_chunks(self.index.group, epoch, Lane(lane, workers), self.batch or 1, self.shuffling)
        passed = len(range(lane, delivered, workers)) * (self.batch or 1)
        places = self._places(chunks, passed)
        if self.batch is None:
            yield from (self._sample(epoch, *place) for place in places)
            return
        while found := list(islice(places, self.batch)):
            yield self._batch(epoch, found)

    def _places(self, chunks: list[np.ndarray], passed: int) -> Iterator[tuple[int, Sequence[np.ndarray]]]:
        """Yield the windows of the chunks with their records; chunks that were passed are not decoded."""
        for chunk in chunks:
            rest, passed = chunk[passed:], max(passed - chunk.size, 0)
            yield from zip(rest.tolist(), self._records(rest), strict=True)

    def _sample(self, epoch: int, number: int, record: Sequence[np.ndarray]) -> Any:
        sample: Sample = window_sample(self.index, number, record)
        if self.transform is None:
            return sample
        return transformed(sample, self.transform, self.shuffling.seed, epoch, number)

    def _batch(self, epoch: int, found: list[tuple[int, Sequence[np.ndarray]]]) -> Any:
        if self.transform is not None:
            joined = default_collate([self._sample(epoch, *place) for place in found])
            return Batch(joined) if isinstance(joined, dict) else joined
        # each window is copied once, straight into the batch; that spares a third where nothing is resampled
        windows = np.empty((len(found), len(found[0][1]), self.index.samples), dtype=np.float32)
        for place, (number, record) in enumerate(found):
            start = int(self.index.start[number])
            for row, channel in enumerate(record):
                windows[place, row] = channel[start : start + self.index.samples]
        labels = self.index.labels_of([number for number, _ in found])
        tensors = {name: torch.from_numpy(values) for name, values in labels.items()}
        return Batch(windows=torch.from_numpy(windows), **tensors)

    def _records(self, chosen: np.ndarray) -> Iterator[Sequence[np.ndarray]]:
        """Yield the decoded record of every window; all records of the chunk are decoded at once."""
        index = self.index
        decoded = {
            group: self.signals.read(group, np.unique(index.row[chosen[index.group[chosen] == group]]).tolist())
            for group in np.unique(index.group[chosen]).tolist()
        }
        for number in chosen.tolist():
            yield decoded[int(index.group[number])][int(index.row[number])]


class WindowLoader:
    """Iterates a stream, by `workers` processes, and knows where it is.

    One iteration is the rest of one epoch; the next one begins the next epoch. The order depends on the seed, the
    epoch, `world_size`, the batch size and the number of workers.
    """

    def __init__(self, stream: WindowStream, workers: int = 0) -> None:
        if workers < 0:
            raise UsageError(f"workers: received {workers}; allowed are 0 (this process) or more")
        if stream.batch is None:
            raise UsageError("batch: received None; a WindowLoader delivers batches. Give WindowStream a number")
        self.stream = stream
        self.workers = workers

    def __len__(self) -> int:
        """Batches of this rank in a whole epoch."""
        return len(self.stream)

    def __iter__(self) -> Iterator[Batch]:
        """Yield the rest of the epoch."""
        position = self.stream.position
        self.stream.position = position  # an epoch that another iteration began and left is gone on with, not passed
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
            "buffer_windows": stream.shuffling.buffer_windows,
            "batch": stream.batch,
            "rank": stream.shuffling.rank,
            "world_size": stream.shuffling.world_size,
            "workers": self.workers,
        }


def _worker() -> tuple[int, int]:
    info = get_worker_info()
    return (info.id, info.num_workers) if info else (0, 1)
