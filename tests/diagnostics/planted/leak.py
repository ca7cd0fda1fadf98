"""A leak: a name, a sentence, and how it makes damaged records differ for a reason that is no gear's."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import pyarrow as pa


@dataclass(frozen=True, slots=True)
class Signals:
    """What sensors gave of one record, ahead of the converter.

    Attributes
    ----------
    channels
        Shape (channels, samples), in m/s^2.
    tacho_s
        Times of the tacho's pulses.
    steps
        Step of each channel's converter, shape (channels, 1), in m/s^2.
    record_id, is_damaged, fs_hz, mesh_hz
        Of the record.
    """

    channels: np.ndarray
    tacho_s: np.ndarray
    steps: np.ndarray
    record_id: int
    is_damaged: bool
    fs_hz: float
    mesh_hz: float

    @property
    def rms(self) -> np.ndarray:
        """Standard deviation of each channel, shape (channels, 1)."""
        return np.std(self.channels, axis=1, keepdims=True)

    @property
    def t_s(self) -> np.ndarray:
        """Time of each sample, shape (samples,)."""
        return np.arange(self.channels.shape[1]) / self.fs_hz

    def noise(self, seed: int = 0) -> np.ndarray:
        """White noise of variance 1 that depends on the record and the seed, of the shape of the channels."""
        return np.random.default_rng([seed, self.record_id]).normal(size=self.channels.shape)


@dataclass(frozen=True, slots=True)
class Leak:
    """What is planted into each shard; a part that is None leaves the files' part as it is.

    Attributes
    ----------
    name, planted
        Of the table: a word and a sentence.
    channels, tacho
        Signals of a damaged record -> other channels or other times of pulses.
    is_for_all
        Whether healthy records pass `channels` too.
    labels
        (rows, which of them are damaged) -> other rows; passes data and labels alike.
    is_grouped
        Whether damaged rows that follow each other have a row group of their own in their file.
    """

    name: str
    planted: str
    channels: Callable[[Signals], np.ndarray] | None = None
    tacho: Callable[[Signals], np.ndarray] | None = None
    is_for_all: bool = False
    labels: Callable[[pa.Table, np.ndarray], pa.Table] | None = None
    is_grouped: bool = False


def named(functions: tuple[Callable[..., object], ...], part: str, **more: object) -> Mapping[str, Leak]:
    """Return leaks by the functions' names, described by their docstrings; `part` says what of a leak they are."""
    texts = {function.__name__: str(function.__doc__).rstrip(".") for function in functions}
    return {f.__name__: Leak(f.__name__, texts[f.__name__], **{part: f}, **more) for f in functions}  # type: ignore[arg-type]
