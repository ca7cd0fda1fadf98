"""Synchronous averages of a set for a network: lines of a turn of the first shaft, written out as rows of equal length.

The lines are those that the one table of a set keeps, so no record is read again. A row has the same number of angle
steps whatever the number of teeth. Source: residual as of `diagnostics.signal.shaft_signals`; the rest derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pyarrow as pa

from diagnostics.indicators.classifier_table import table, table_settings
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.loader.window_arrays import Windows
from diagnostics.records.record_classes import STATE, set_classes
from diagnostics.records.state_classes import CLASS
from diagnostics.signal.shaft_signals import SHAFT_ORDERS
from diagnostics.training.splits import TEST, TRAIN, VALIDATION
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

STEPS = 1024
"""Angle steps of a row; it holds shaft orders up to 511."""

ROWS = 3
"""Rows per channel of a record that stands alone: average, residual, whitened residual."""

BESIDE = 16
"""Orders on each side whose mean amplitude whitens a line."""

FLOOR = 0.03
"""Share of the mean amplitude of all orders below which whitening raises nothing."""


@dataclass(frozen=True, slots=True)
class AveragedRecords:
    """Averages of one turn of the first shaft, from its first pulse on.

    Attributes
    ----------
    lines : (records, channels, orders) complex64
        Amplitude and phase [m/s²] at shaft orders 0, 1, 2 ...; zero where a record holds less.
    teeth : (records,) int
        Teeth of the first driver.
    channels : tuple of str
        Channel names.
    healthy : (records, channels, orders) complex64, optional
        Mean of the same gearbox's healthy averages; None where records stand alone.
    """

    lines: np.ndarray
    teeth: np.ndarray
    channels: tuple[str, ...]
    healthy: np.ndarray | None = None

    @property
    def rows(self) -> int:
        """Rows that a record gives: three per channel alone, six beside a healthy reference."""
        return len(self.channels) * (ROWS if self.healthy is None else 6)

    def chosen(self, places: np.ndarray) -> AveragedRecords:
        """Return some of the records."""
        healthy = None if self.healthy is None else self.healthy[places]
        return replace(self, lines=self.lines[places], teeth=self.teeth[places], healthy=healthy)


def averaged_records(table: RecordTable) -> AveragedRecords:
    """Return the averages of the first driver of all records of a table.

    Raises
    ------
    DatasetError
        If a record holds fewer than two turns of the first shaft.
    """
    found = table.complex_rows("waveform")
    numbers = table.select(["record_id", table.teeth[0]]).to_pydict()
    short = [int(k) for k, row in zip(numbers["record_id"], found, strict=True) if min(map(len, row)) == 0]
    if short:
        raise DatasetError(
            f"records {short[:5]} hold fewer than two whole turns of the first shaft; the network on the average needs "
            "them. Use longer records (`duration_s`) or leave the networks out: siggen-diagnostics report --no-cnn."
        )
    return AveragedRecords(padded_lines(found), np.asarray(numbers[table.teeth[0]]), table.channels)


def padded_lines(waveforms: Sequence[Sequence[np.ndarray]]) -> np.ndarray:
    """Return lines (k,) by record and channel as one array (records, channels, 512), zero where there are fewer."""
    lines = np.zeros((len(waveforms), len(waveforms[0]), STEPS // 2), dtype=np.complex64)
    for place, row in enumerate(waveforms):
        for channel, values in enumerate(row):
            lines[place, channel, : values.size] = values[: STEPS // 2]
    return lines


def with_references(records: AveragedRecords, places: np.ndarray, references: list[np.ndarray]) -> AveragedRecords:
    """Return some of the records, each beside the mean of those that it refers to.

    Parameters
    ----------
    records : AveragedRecords
        All records of the set.
    places : (k,) int
        Which of them.
    references : k of (m,) int
        Places of the healthy records that each refers to, one or more, see `diagnostics.training.referenced`.
    """
    healthy = np.stack([records.lines[rows].mean(axis=0) for rows in references])
    return replace(records.chosen(places), healthy=healthy)


def average_rows(records: AveragedRecords) -> np.ndarray:
    """Return what the network takes, (records, rows, 1024) float32 in m/s², whitened rows without a unit.

    All channels of each in turn: the average, its residual, the residual whitened; with a healthy reference the
    residual, that of the reference, the difference of the averages, its residual, and both residuals whitened.
    """
    residual = residual_lines(records.lines, records.teeth)
    if records.healthy is None:
        parts = [records.lines, residual, whitened(residual)]
    else:
        difference = records.lines - records.healthy
        rest = residual_lines(difference, records.teeth)
        own = residual_lines(records.healthy, records.teeth)
        parts = [residual, own, difference, rest, whitened(residual), whitened(rest)]
    lines = np.concatenate(parts, axis=1)
    lines[:, :, 0] = 0.0
    return np.asarray(np.fft.irfft(lines * (STEPS / 2.0), n=STEPS, axis=2), dtype=np.float32)


def whitened(lines: np.ndarray) -> np.ndarray:
    """Return lines (records, channels, orders) over their mean amplitude within 16 orders on each side.

    A short event has lines of all orders in step; it stands out once those of a resonance outweigh the others no more.
    A share of the mean amplitude is added, so that orders beyond the record's band stay small. Source: derived.
    """
    from scipy.ndimage import uniform_filter1d

    amplitude = np.abs(lines)
    level = uniform_filter1d(amplitude, 2 * BESIDE + 1, axis=2, mode="nearest")
    return np.asarray(lines / (level + FLOOR * amplitude.mean(axis=2, keepdims=True) + 1e-30))


def residual_lines(lines: np.ndarray, teeth: np.ndarray) -> np.ndarray:
    """Return lines (records, channels, orders) without shaft orders 0 to 2 and multiples of the (records,) teeth."""
    order = np.arange(lines.shape[2])
    kept = (order > SHAFT_ORDERS) & (order % teeth[:, None] != 0)
    return np.where(kept[:, None, :], lines, 0.0)


TERMS = 8
"""Of the cosine series that a path is; more make it rougher."""


def moved(records: AveragedRecords, rng: np.random.Generator, gain_db: float) -> AveragedRecords:
    """Return the records as seen from another tooth and through another smooth path, for training only.

    Record and reference are turned together and pass one path per channel: a gearbox has one. Source: derived
    (domain randomisation).

    Parameters
    ----------
    records : AveragedRecords
        Training records.
    rng : numpy.random.Generator
        Draws angles and paths.
    gain_db : float
        Standard deviation of a path's gain at any order [dB]; its phase scatters by 0.25 rad per 1 dB.
    """
    count, channels, orders = records.lines.shape
    place = np.arange(orders) / (orders - 1)
    series = np.cos(np.pi * np.arange(TERMS)[:, None] * place) / np.sqrt((1 + TERMS) / 2.0)
    gain = gain_db * np.log(10.0) / 20.0 * (rng.standard_normal((count, channels, TERMS)) @ series)
    phase = 0.25 * gain_db * (rng.standard_normal((count, channels, TERMS)) @ series)
    turn = 2.0 * np.pi * rng.uniform(size=(count, 1, 1)) * np.arange(orders)
    factor = np.exp(gain + 1j * (phase + turn)).astype(np.complex64)
    healthy = None if records.healthy is None else records.healthy * factor
    return replace(records, lines=records.lines * factor, healthy=healthy)


def table_averages(dataset: Dataset, classifiers: pa.Table) -> AveragedRecords:
    """Return the averages of the records of a feature table, from the table of indicators that it was made of."""
    return averaged_records(record_table(dataset, table_settings(classifiers)))


def averages(dataset: Dataset, split: str | None = None, *, classes: str = STATE) -> Windows:
    """Return one row block per record: what the shipped 1-D network takes.

    The averages are kept beside the set with its indicators, so that only the first call of any split computes them.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    split : str, optional
        train, validation or test; by default all records, in the order of `diagnostics.table`.
    classes : str
        What `class_id` counts: the `state` of a record, or its primary `fault`; healthy ones are one class.

    Returns
    -------
    Windows
        `values` (records, 3 * channels, 1024) float32: the synchronous average of one turn of the first shaft of every
        channel, then their residuals (without shaft orders 0 to 2 and mesh harmonics), then these whitened.

    Raises
    ------
    DatasetError
        If records cannot be used, or hold fewer than two turns of the first shaft.
    UsageError
        If the classes are of an unknown kind.
    """
    matrix, names = table(dataset, classes=classes), set_classes(dataset, classes).names
    chosen = np.flatnonzero(np.isin(matrix.labels["split"], (TRAIN, VALIDATION, TEST) if split is None else (split,)))
    values = average_rows(averaged_records(record_table(dataset)).chosen(chosen))
    labels = {name: matrix.labels[name][chosen] for name in ("record_id", "specimen_id", "state_id")}
    labels["class_id"] = np.array([names.index(name) for name in matrix.labels[CLASS][chosen].tolist()], dtype=np.int64)
    return Windows(values, labels, names)
