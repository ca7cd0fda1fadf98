"""Windows of a set by number, for samplers, `DataLoader(batch_size=...)` and trainers that want a length.

    windows = WindowDataset(siggen.open("runs/set"), "train", cache=Path("cache"))
    loader = DataLoader(windows, batch_size=64, sampler=ShardSampler(windows), num_workers=2)

Batches are the same for any number of workers, since the sampler stays in one process.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.utils.data import Dataset as TorchDataset
from torch.utils.data import Sampler

from diagnostics.loader.epoch_order import Lane, Shuffling, epoch_chunks
from diagnostics.loader.window_index import StreamSettings, window_index
from diagnostics.loader.window_sample import Sample, ShardSignals, Transform, transformed, window_sample
from diagnostics.records.usable_records import of_quantity
from siggen.dataset.reading import Dataset

KEPT_BYTES = 256 << 20
"""Decoded records that a process keeps, whole shards of them; a record alone costs as much as its shard."""


class WindowDataset(TorchDataset[Sample]):  # type: ignore[misc]  # the type checker does not read torch
    """Windows of one split; `dataset[k]` is a dict with `windows` (channels, samples) float32 and the labels.

    Shards are decoded whole and kept up to 256 MB. Where a split is larger, a window in random order costs the
    reading of its shard; with `ShardSampler` or a cache it does not.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    split : str
        Split to read.
    settings : StreamSettings, optional
        Default: windows of 8 pinion revolutions of 288 angle steps, every 4 revolutions.
    labels : sequence of str
        Further labels, see `diagnostics.loader.window_index`.
    transform : callable, optional
        Takes a sample and a generator, and returns what the model gets. The generator depends on seed, window and how
        often the window was drawn.
    seed : int
        Of these generators.
    cache : Path, optional
        Folder for decoded records, read through memory mapping.

    Raises
    ------
    UsageError
        If a label is unknown, a number is out of range, or no channel holds the quantity.
    DatasetError
        If no record of the split holds a whole window.
    """

    def __init__(
        self,
        dataset: Dataset,
        split: str,
        settings: StreamSettings | None = None,
        *,
        labels: Sequence[str] = (),
        transform: Transform | None = None,
        seed: int = 0,
        cache: Path | None = None,
    ) -> None:
        chosen = settings or StreamSettings()
        dataset = of_quantity(dataset, chosen.quantity)
        self.index = window_index(dataset, split, chosen, labels)
        self.signals = ShardSignals(dataset, split, dataset.shards(split), chosen, self.index, cache)
        self.transform, self.seed = transform, seed
        # shared, so that copies in worker processes count on where an earlier epoch's stopped
        self._drawn = torch.zeros(self.index.size, dtype=torch.int64).share_memory_()
        self._groups: dict[int, Mapping[int, Sequence[np.ndarray]]] = {}

    def __len__(self) -> int:
        """Return the windows of the split."""
        return self.index.size

    def __getitem__(self, number: int) -> Any:
        """Return a window with its labels, transformed."""
        if not -len(self) <= number < len(self):
            raise IndexError(f"window {number} of {len(self)}")
        number = int(number) % len(self)
        sample = window_sample(self.index, number, self._record(number))
        if self.transform is None:
            return sample
        drawn = int(self._drawn[number])
        self._drawn[number] += 1
        return transformed(sample, self.transform, self.seed, drawn, number)

    def _record(self, number: int) -> Sequence[np.ndarray]:
        """Return the decoded channels of a window's record; the latest shards stay in memory."""
        group = int(self.index.group[number])
        if group not in self._groups:
            usable = np.flatnonzero(self.index.lengths[group]).tolist()
            self._groups[group] = self.signals.read(group, usable)
            while len(self._groups) > 1 and sum(map(_bytes, self._groups.values())) > KEPT_BYTES:
                del self._groups[next(iter(self._groups))]
        return self._groups[group][int(self.index.row[number])]

    def __getstate__(self) -> dict[str, Any]:
        """Return what goes to a worker process: everything but the decoded records."""
        return {**self.__dict__, "_groups": {}}


def _bytes(records: Mapping[int, Sequence[np.ndarray]]) -> int:
    return sum(channel.nbytes for channels in records.values() for channel in channels)


class ShardSampler(Sampler[int]):  # type: ignore[misc]
    """Shuffled order of a `WindowDataset`, another one in every epoch.

    Records that lie together on disk are drawn close to each other, so that each is decoded few times. The order
    depends on seed, epoch and rank alone.

    Parameters
    ----------
    windows : WindowDataset
        What is drawn from.
    shuffling : Shuffling, optional
        Seed, shards that are mixed, and which of how many processes this is.
    """

    def __init__(self, windows: WindowDataset, shuffling: Shuffling | None = None) -> None:
        self.group = windows.index.group
        self.shuffling = shuffling or Shuffling()
        self.epoch = 0

    def __len__(self) -> int:
        """Return the windows of this rank."""
        return int(sum(chunk.size for chunk in self._chunks(0)))

    def __iter__(self) -> Iterator[int]:
        """Yield the numbers of the next epoch."""
        epoch, self.epoch = self.epoch, self.epoch + 1
        for chunk in self._chunks(epoch):
            yield from chunk.tolist()

    def set_epoch(self, epoch: int) -> None:
        """Let the next iteration be that of a given epoch; trainers call it, nobody has to."""
        self.epoch = epoch

    def _chunks(self, epoch: int) -> list[np.ndarray]:
        return epoch_chunks(self.group, epoch, Lane(), 1, self.shuffling)
