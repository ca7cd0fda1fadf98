"""One window with its labels as PyTorch takes it, and a user's change of it that any number of workers repeats.

The decoded records of a shard: as taken or resampled to equal angle steps, from Parquet or from a cache.

A cache holds one `.npy` file per shard, read through memory mapping; it is named by set, split and settings, and
made as groups are first read, by any number of processes at once.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from diagnostics.base.seeding import Purpose, generator
from diagnostics.loader.window_index import StreamSettings, WindowIndex
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from siggen.dataset.reading import Dataset
from siggen.file_writing import write_file

NOT_DECODED = ("quantity", "classes")
"""Settings that decoded samples do not depend on: the channels say what the quantity says."""

Sample = dict[str, torch.Tensor]
Transform = Callable[[Sample, np.random.Generator], Any]


@dataclass(frozen=True, slots=True)
class ShardSignals:
    """Reads the records of a split, shard by shard.

    Attributes
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    split : str
        Its split.
    groups : tuple of ListedShard
        What `dataset.shards(split)` returned.
    settings : StreamSettings
        Angle steps, or samples as they were taken.
    index : WindowIndex
        Lengths of the decoded records.
    cache : Path, optional
        Folder of the cache; None decodes every time.
    """

    dataset: Dataset
    split: str
    groups: tuple[Any, ...]
    settings: StreamSettings
    index: WindowIndex
    cache: Path | None = None

    def read(self, number: int, rows: Iterable[int]) -> Mapping[int, Sequence[np.ndarray]]:
        """Return the channels, each (samples,) float32, of the asked rows of a shard, by row."""
        if self.cache is None:
            return self._decoded(number, rows)
        lengths = self.index.lengths[number]
        ends = np.cumsum(lengths)
        joined = self._cached(number)
        return {row: list(joined[:, ends[row] - lengths[row] : ends[row]]) for row in rows}

    def _decoded(self, number: int, rows: Iterable[int]) -> dict[int, Sequence[np.ndarray]]:
        columns = [channel.column for channel in self.dataset.channels]
        batch = self.dataset.shard_rows(self.groups[number], [*columns, "tacho_s"])
        signals = [batch.column(name).flatten().to_numpy().reshape(batch.num_rows, -1) for name in columns]
        return {row: self._record([s[row] for s in signals], batch.column("tacho_s")[row]) for row in rows}

    def _record(self, signals: list[np.ndarray], tacho: Any) -> Sequence[np.ndarray]:
        steps = self.settings.samples_per_revolution
        if steps is None:
            return signals
        grid = angle_grid(np.asarray(tacho.values, dtype=np.float64), steps)
        return [resample_to_angle(signal, self.dataset.fs_hz, grid).astype(np.float32) for signal in signals]

    def _cached(self, number: int) -> np.ndarray:
        assert self.cache is not None
        folder = self.cache / self._key()
        path = folder / f"{self.split}-{number:05d}.f32"
        lengths = self.index.lengths[number]
        if not path.exists():
            usable = [row for row in range(lengths.size) if lengths[row]]
            joined = np.concatenate([np.stack(found) for found in self._decoded(number, usable).values()], axis=1)
            write_file(path, np.asarray(joined, dtype=np.float32).tofile)
        # Plain numbers: NumPy's header is parsed as Python source, which Python 3.11 at times refuses in a worker.
        shape = (len(self.dataset.channels), int(lengths.sum()))
        return np.asarray(np.memmap(path, dtype=np.float32, mode="r", shape=shape))

    def _key(self) -> str:
        facts = {
            "identity": self.dataset.manifest["identity"],
            "channels": [channel.name for channel in self.dataset.channels],
            "windows": self.index.fingerprint(),
            **{name: value for name, value in asdict(self.settings).items() if name not in NOT_DECODED},
        }
        return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:16]


def window_sample(index: WindowIndex, number: int, record: Sequence[np.ndarray]) -> Sample:
    """Return a window as a dict of tensors.

    Parameters
    ----------
    index : WindowIndex
        Where it lies, and its labels.
    number : int
        Which window.
    record : channels of (samples,) float32
        The decoded record that it belongs to.
    """
    start = int(index.start[number])
    windows = np.stack([channel[start : start + index.samples] for channel in record])
    labels = {name: torch.as_tensor(values) for name, values in index.labels_of(number).items()}
    return {"windows": torch.from_numpy(windows.astype(np.float32, copy=False)), **labels}


def transformed(sample: Sample, transform: Transform, seed: int | None, epoch: int, number: int) -> Any:
    """Return what the user's function makes of a sample; its generator depends on seed, epoch and window alone."""
    return transform(sample, generator(seed or 0, Purpose.AUGMENTATION, epoch, number))
