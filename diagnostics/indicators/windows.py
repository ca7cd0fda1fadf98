"""Indicators of single windows of a set, so that all kinds of splits can be tried on the same rows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.record import record_values
from diagnostics.records.recording import LABEL_NAMES, Recording, recordings
from diagnostics.records.state_classes import CLASS, class_names
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

REVOLUTIONS = 8
MOST_WINDOWS = 3
"""Windows of a record: enough to leak, few enough to be quick."""


def window_matrix(
    dataset: Dataset, advance: Callable[[], None] | None = None, healthy: str | None = None
) -> FeatureMatrix:
    """Return the indicators of windows that follow each other without overlap, with the labels of their records.

    `healthy` names the healthy class where it is not the first healthy state of the set.

    Raises
    ------
    DatasetError
        If no record holds a whole window.
    """
    rows: list[dict[str, float]] = []
    labels: list[dict[str, Any]] = []
    for record in recordings(dataset):
        teeth = (int(record.labels["teeth_pinion"]), int(record.labels["teeth_gear"]))
        for window in windows_of(record):
            rows.append(record_values(window.channels, window.tacho_s, window.fs_hz, teeth).values)
            labels.append(dict(record.labels))
        if advance:
            advance()
    if not rows:
        raise DatasetError(
            f"{dataset.path}: no record holds {REVOLUTIONS} pinion revolutions, which the windows of --studies need. "
            "Use longer records (`duration_s`) or leave --studies out."
        )
    names = tuple(rows[0])
    values = np.array([[row[name] for name in names] for row in rows])
    columns = {name: np.array([label[name] for label in labels]) for name in LABEL_NAMES}
    return FeatureMatrix(values, names, {**columns, CLASS: class_names(columns, healthy)})


def windows_of(record: Recording) -> Iterator[Recording]:
    """Yield the windows of a record, each with its own time from zero."""
    pulses = record.tacho_s
    for window in range(min(MOST_WINDOWS, (pulses.size - 1) // REVOLUTIONS)):
        times = pulses[window * REVOLUTIONS : (window + 1) * REVOLUTIONS + 1]
        first, last = int(np.floor(times[0] * record.fs_hz)), int(np.ceil(times[-1] * record.fs_hz)) + 1
        channels = {name: signal[first:last] for name, signal in record.channels.items()}
        yield replace(record, channels=channels, tacho_s=times - first / record.fs_hz)


def by_channel(matrix: FeatureMatrix) -> FeatureMatrix:
    """Return one row per window and channel, features without the channel's name, and a label `channel`."""
    channels = tuple(dict.fromkeys(name.split("__")[1] for name in matrix.names))
    names = tuple(dict.fromkeys(name.split("__")[0] for name in matrix.names))
    values = np.concatenate([matrix.columns([f"{name}__{c}" for name in names]).values for c in channels])
    labels = {name: np.tile(column, len(channels)) for name, column in matrix.labels.items()}
    return FeatureMatrix(values, names, {**labels, "channel": np.repeat(channels, matrix.values.shape[0])})
