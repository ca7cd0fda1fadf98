"""One window with its labels as PyTorch takes it, and a user's change of it that any number of workers repeats."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import torch

from diagnostics.base.seeding import Purpose, generator
from diagnostics.loader.window_index import WindowIndex

Sample = dict[str, torch.Tensor]
Transform = Callable[[Sample, np.random.Generator], Any]


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
