"""Order-resampled records for a network, cut into windows of whole pinion revolutions.

A window must hold several revolutions: 2048 raw samples at 51.2 kHz are 1.2 revolutions at 30 Hz and can neither
resolve sidebands nor show a once-per-revolution event twice. Source: derived.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from diagnostics.records.recording import Recording, pair_teeth, recordings
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

SAMPLES_PER_TOOTH = 16
"""Angle steps per mesh period: the full band (0.45 of the steps) holds seven mesh harmonics; 288 steps for 18 teeth."""


@dataclass(frozen=True, slots=True)
class WindowSettings:
    """How records become windows.

    Attributes
    ----------
    revolutions : int
        Pinion revolutions per window.
    hop_revolutions : int
        Step between the windows of a record that is judged; training starts windows anywhere.
    teeth : int
        Teeth of the pinion; the most of a set whose pinions differ, so that every one has steps enough per tooth.
    samples_per_tooth : int
        Angle steps per mesh period.
    most_revolutions : int
        Revolutions of a record that are kept, from its start; bounds memory.
    """

    teeth: int
    revolutions: int = 8
    hop_revolutions: int = 4
    samples_per_tooth: int = SAMPLES_PER_TOOTH
    most_revolutions: int = 64

    @property
    def samples_per_revolution(self) -> int:
        """Angle steps per pinion revolution."""
        return self.teeth * self.samples_per_tooth

    @property
    def samples(self) -> int:
        """Samples per window."""
        return self.revolutions * self.samples_per_revolution


@dataclass(frozen=True, slots=True)
class OrderRecords:
    """Records in the order domain.

    Attributes
    ----------
    signals : tuple of (channels, samples) float32
        One array per record; lengths differ with speed.
    record_id : (records,) int
        In the order of `signals`.
    channels : tuple of str
        Channel names in the order of the rows.
    settings : WindowSettings
        Samples per revolution and window length.
    """

    signals: tuple[np.ndarray, ...]
    record_id: np.ndarray
    channels: tuple[str, ...]
    settings: WindowSettings


def order_records(
    dataset: Dataset, settings: WindowSettings | None = None, advance: Callable[[], None] | None = None
) -> OrderRecords:
    """Return all records of a set resampled to equal angle steps of the pinion.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    settings : WindowSettings, optional
        Default: windows of 8 revolutions.
    advance : callable, optional
        Called after every record.

    Raises
    ------
    DatasetError
        If a record holds fewer revolutions than a window.
    """
    settings = settings or WindowSettings(teeth=_most_teeth(dataset))
    signals, numbers = [], []
    for record in recordings(dataset):
        signals.append(_order_signal(record, settings))
        numbers.append(record.labels["record_id"])
        if advance:
            advance()
    names = tuple(channel.name for channel in dataset.channels)
    return OrderRecords(tuple(signals), np.array(numbers), names, settings)


def _most_teeth(dataset: Dataset) -> int:
    first, _ = pair_teeth(dataset)
    return int(max(dataset.labels(columns=[first]).column(first).to_pylist()))


def _order_signal(record: Recording, settings: WindowSettings) -> np.ndarray:
    pulses = record.tacho_s[: settings.most_revolutions + 1]
    if pulses.size <= settings.revolutions:
        raise DatasetError(
            f"record {record.labels['record_id']} holds {max(pulses.size - 1, 0)} whole pinion revolutions; a "
            "window of "
            f"the network needs {settings.revolutions}. Use longer records (`duration_s`) or leave the "
            "network out (--no-cnn)."
        )
    grid = angle_grid(pulses, settings.samples_per_revolution)
    rows = [resample_to_angle(signal, record.fs_hz, grid) for signal in record.channels.values()]
    return np.stack(rows).astype(np.float32)


def drawn_windows(records: OrderRecords, chosen: np.ndarray, per_record: int, rng: np.random.Generator) -> np.ndarray:
    """Return windows that start at random angles, (len(chosen) * per_record, channels, samples) float32.

    Parameters
    ----------
    records : OrderRecords
        Where to draw from.
    chosen : (k,) int
        Positions of the records.
    per_record : int
        Windows of each record, consecutive in the result.
    rng : numpy.random.Generator
        Draws the starts.
    """
    length = records.settings.samples
    found = []
    for position in chosen:
        signal = records.signals[position]
        starts = rng.integers(0, signal.shape[1] - length + 1, size=per_record)
        found += [signal[:, start : start + length] for start in starts]
    return np.stack(found)


def record_windows(records: OrderRecords, position: int) -> np.ndarray:
    """Return the regular windows of one record, (windows, channels, samples) float32."""
    length = records.settings.samples
    hop = records.settings.hop_revolutions * records.settings.samples_per_revolution
    signal = records.signals[position]
    return np.stack([signal[:, start : start + length] for start in range(0, signal.shape[1] - length + 1, hop)])
