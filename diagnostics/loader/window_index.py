"""Where every window of a split lies: row group, row, and first sample, from the tacho pulses alone."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from diagnostics.loader.window_labels import ANGLES, record_labels, window_angles
from diagnostics.records.state_classes import class_ids
from siggen.dataset.reading import Dataset, RowGroup
from siggen.errors import DatasetError, UsageError

FEWEST_REVOLUTIONS = 8
"""Fewer resolve no sidebands and show a once-per-revolution event too seldom."""

LABELS = ("record_id", "specimen_id", "state_id", "damaged_area_mm2")


@dataclass(frozen=True, slots=True)
class StreamSettings:
    """What a window is.

    Attributes
    ----------
    revolutions : int
        Pinion revolutions per window, 8 or more.
    hop_revolutions : int
        Revolutions from one window of a record to the next.
    samples_per_revolution : int or None
        Equal angle steps per revolution; None keeps the samples as they were taken, in windows as long as the
        slowest `revolutions` of the split.

    Raises
    ------
    UsageError
        If a number is too small.
    """

    revolutions: int = FEWEST_REVOLUTIONS
    hop_revolutions: int = 4
    samples_per_revolution: int | None = 288

    def __post_init__(self) -> None:
        if self.revolutions < FEWEST_REVOLUTIONS:
            raise UsageError(f"revolutions: received {self.revolutions}; allowed are {FEWEST_REVOLUTIONS} or more")
        for name, number in (
            ("hop_revolutions", self.hop_revolutions),
            ("samples_per_revolution", self.samples_per_revolution),
        ):
            if number is not None and number < 1:
                raise UsageError(f"{name}: received {number}; allowed are 1 or more")


@dataclass(frozen=True, slots=True)
class WindowIndex:
    """All windows of a split.

    Attributes
    ----------
    group, row, start : (windows,) int
        Row group, row in it, and first sample in the decoded record.
    record : (windows,) int
        Position of the record in the split.
    samples : int
        Samples of a window.
    lengths : tuple of (rows,) int
        Samples of the decoded records of every row group.
    labels : dict of str to (records, ...)
        `record_id`, `specimen_id`, `state_id`, `class_id`, `damaged_area_mm2`, and those that were asked for.
    window_labels : dict of str to (windows,)
        Those that differ between the windows of a record.
    """

    group: np.ndarray
    row: np.ndarray
    start: np.ndarray
    record: np.ndarray
    samples: int
    lengths: tuple[np.ndarray, ...]
    labels: dict[str, np.ndarray]
    window_labels: dict[str, np.ndarray] = field(default_factory=dict)

    def labels_of(self, number: int | list[int]) -> dict[str, np.ndarray]:
        """Return all labels of a window or of several."""
        own = {name: values[number] for name, values in self.window_labels.items()}
        return {name: values[self.record[number]] for name, values in self.labels.items()} | own

    @property
    def size(self) -> int:
        """Number of windows."""
        return int(self.group.size)

    def fingerprint(self) -> str:
        """Return a hash of what is where, by which a saved position knows its set."""
        digest = hashlib.sha256(str(self.samples).encode())
        for values in (self.group, self.row, self.start, self.labels["record_id"]):
            digest.update(np.ascontiguousarray(values, dtype=np.int64).tobytes())
        return digest.hexdigest()[:16]


def window_index(dataset: Dataset, split: str, settings: StreamSettings, further: Sequence[str] = ()) -> WindowIndex:
    """Return where the windows of a split lie; reads pulse times and labels only.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    split : str
        Its split.
    settings : StreamSettings
        What a window is.
    further : sequence of str
        Labels besides the usual ones, see `diagnostics.loader.window_labels`.

    Raises
    ------
    UsageError
        If a label is unknown.
    DatasetError
        If no record of the split holds a whole window.
    """
    labels = {**_columns(dataset, split, LABELS), "class_id": _class_id(dataset, split)}
    labels |= record_labels(dataset, split, [name for name in further if name not in labels])
    pulses = [list(_pulses(dataset, group)) for group in dataset.row_groups(split)]
    samples = _window_samples(pulses, settings, dataset.fs_hz)
    recorded = round(dataset.duration_s * dataset.fs_hz)
    rows, lengths, angles, record = [], [], [], 0
    for number, group in enumerate(pulses):
        lengths.append(np.array([_decoded_samples(times, settings, recorded) for times in group], dtype=np.int64))
        for row, times in enumerate(group):
            starts = _starts(times, settings, dataset.fs_hz)
            for turn, start in starts.items():
                if start + samples <= lengths[-1][row]:
                    rows.append((number, row, start, record))
                    angles.append(window_angles(times, turn, start, dataset.fs_hz, settings.samples_per_revolution))
            record += 1
    if not rows:
        raise DatasetError(
            f"{dataset.path}: no record of split {split!r} holds {settings.revolutions} whole pinion revolutions. "
            "Use longer records (`duration_s`) or a higher speed."
        )
    found = np.array(rows, dtype=np.int64).T
    of_windows = {name: column for name, column in zip(ANGLES, np.array(angles).T, strict=True) if name in further}
    return WindowIndex(found[0], found[1], found[2], found[3], samples, tuple(lengths), labels, of_windows)


def _columns(dataset: Dataset, split: str | None, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    table = dataset.labels(split, list(names))
    return {name: np.asarray(table.column(name).to_pylist()) for name in names}


def _class_id(dataset: Dataset, split: str) -> np.ndarray:
    """Return the class of every record of the split, (records,) int64: its state's, all healthy ones being one."""
    ids = class_ids(_columns(dataset, None, ("state", "state_id", "fault")))
    states = dataset.labels(split, ["state"]).column("state").to_pylist()
    return np.array([ids[state] for state in states], dtype=np.int64)


def _pulses(dataset: Dataset, group: RowGroup) -> Iterator[np.ndarray]:
    column = dataset.row_group(group, ["tacho_s"]).column("tacho_s")
    yield from (np.asarray(column[row].values, dtype=np.float64) for row in range(len(column)))


def _starts(pulses: np.ndarray, settings: StreamSettings, fs_hz: float) -> dict[int, int]:
    """Return the first sample of every window by the pulse that it starts at."""
    first = range(0, pulses.size - settings.revolutions, settings.hop_revolutions)
    if settings.samples_per_revolution is not None:
        return {turn: turn * settings.samples_per_revolution for turn in first}
    return {turn: int(np.ceil(pulses[turn] * fs_hz)) for turn in first}


def _decoded_samples(pulses: np.ndarray, settings: StreamSettings, recorded: int) -> int:
    if settings.samples_per_revolution is None:
        return recorded
    return max(pulses.size - 1, 0) * settings.samples_per_revolution


def _window_samples(pulses: list[list[np.ndarray]], settings: StreamSettings, fs_hz: float) -> int:
    """Return the samples of a window; as taken, they hold the stated revolutions even where they are slowest."""
    if settings.samples_per_revolution is not None:
        return settings.revolutions * settings.samples_per_revolution
    turns = settings.revolutions
    spans = [
        (times[turns:] - times[:-turns]).max()
        for group in pulses
        for times in group
        if times.size > settings.revolutions
    ]
    return int(np.ceil(max(spans, default=0.0) * fs_hz)) + 1
