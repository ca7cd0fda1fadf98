"""Windows or averages of a split as arrays, for whoever fits on arrays, and answers as predictions of records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from diagnostics.base.extras import require_packages
from diagnostics.records.record_classes import set_classes
from siggen.dataset.reading import Dataset

if TYPE_CHECKING:
    from diagnostics.loader.window_index import StreamSettings


@dataclass(frozen=True, slots=True)
class Windows:
    """Windows or averages of one split.

    Attributes
    ----------
    values : (n, channels or rows, samples) float32
        Of windows in the units of the channels.
    labels : dict of str to (n, ...)
        `record_id`, `specimen_id`, `state_id`, `class_id`, `damaged_area_mm2`, and those that were asked for.
    classes : tuple of str
        What `class_id` counts.
    """

    values: np.ndarray
    labels: dict[str, np.ndarray]
    classes: tuple[str, ...]

    def __len__(self) -> int:
        """Return the rows, for `torch.utils.data.DataLoader`, which takes this as a dataset."""
        return len(self.values)

    def __getitem__(self, number: int) -> tuple[np.ndarray, int]:
        """Return one row's values (channels or rows, samples) and its class number."""
        return self.values[number], int(self.labels["class_id"][number])

    @property
    def groups(self) -> np.ndarray:
        """(n,) int: the gearbox of each row; one gearbox belongs to one side of any split or fold."""
        return self.labels["specimen_id"]

    def predictions(self, probability: np.ndarray) -> dict[str, np.ndarray]:
        """Return the mean over the windows of each record, as `diagnostics.score` takes it.

        Parameters
        ----------
        probability : (n, classes)
            Of the classes, for every row of `values`.
        """
        record_id, place = np.unique(self.labels["record_id"], return_inverse=True)
        total = np.zeros((record_id.size, len(self.classes)))
        np.add.at(total, place, np.asarray(probability, dtype=np.float64))
        mean = total / np.bincount(place)[:, None]
        return {"record_id": record_id, **{f"p_{name}": mean[:, k] for k, name in enumerate(self.classes)}}


def windows(
    dataset: Dataset, split: str, settings: StreamSettings | None = None, *, labels: Sequence[str] = ()
) -> Windows:
    """Return all windows of a split, as arrays.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    split : str
        train, validation or test.
    settings : StreamSettings, optional
        Default: windows of 8 pinion revolutions of 288 angle steps, every 4 revolutions.
    labels : sequence of str
        Further labels, as of `diagnostics.loader.WindowDataset`.

    Raises
    ------
    UsageError
        If PyTorch is missing, a label is unknown, or no channel holds the quantity.
    DatasetError
        If no record of the split holds a whole window.
    """
    require_packages("windows", "torch")
    from diagnostics.loader.window_dataset import WindowDataset
    from diagnostics.loader.window_index import StreamSettings

    chosen = settings or StreamSettings()
    found = WindowDataset(dataset, split, chosen, labels=labels)
    samples = [found[number] for number in range(len(found))]
    arrays = {name: np.stack([sample[name].numpy() for sample in samples]) for name in samples[0]}
    return Windows(arrays.pop("windows"), arrays, set_classes(dataset, chosen.classes).names)
