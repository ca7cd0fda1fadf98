"""Where every window of a split lies: shard, row, and first sample, from the tacho pulses alone.

Labels of windows on request: any number of the set's labels, the damaged tooth, its outline, and the shaft's angle.

A tacho pulse passes where the pair of tooth 0 enters contact, so pulses alone tell angles. Source: the convention of
`siggen` (angle 0: tooth 0 enters contact), the rest derived.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import pyarrow as pa

from diagnostics.records.gear_train import in_column
from diagnostics.records.record_classes import STATE, check_kind, set_classes
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError

OUTLINE = "outline_mm"
ANGLES = ("start_angle_rad", "tooth_0_entry_sample")

FEWEST_REVOLUTIONS = 8
"""Fewer resolve no sidebands and show a once-per-revolution event too seldom."""

LABELS = ("record_id", "specimen_id", "state_id", "damaged_area_mm2")


def record_labels(dataset: Dataset, split: str, names: Sequence[str]) -> dict[str, np.ndarray]:
    """Return labels of the records of a split, (records, ...) each.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    split : str
        Its split.
    names : sequence of str
        Numbers among the set's labels (`speed_hz`, `torque_nm`, `damaged_area_share` ...) as float64 or int64;
        `tooth_GEAR` (`tooth_pinion` ...): lowest index of the damaged teeth, -1 for none; `outline_mm`: the box round
        all damage of that tooth, (4,): from and to across the face, from and to in height [mm], NaN without damage.

    Raises
    ------
    UsageError
        If a name is none of these.
    """
    return {name: _label(dataset, split, name) for name in names if name not in ANGLES}


def _label(dataset: Dataset, split: str, name: str) -> np.ndarray:
    teeth = {f"tooth_{in_column(gear)}": column for gear, column in dataset.columns_of("faulty_teeth").items()}
    if name in teeth:
        return _lowest_teeth(dataset, split, teeth[name])
    if name == OUTLINE:
        return _outlines(dataset, split)
    schema = dataset.labels(split).schema
    numbers = [field.name for field in schema if pa.types.is_integer(field.type) or pa.types.is_floating(field.type)]
    if name not in numbers:
        raise UsageError(f"labels: received {name!r}; allowed are {', '.join((*teeth, OUTLINE, *ANGLES, *numbers))}")
    kind = np.int64 if pa.types.is_integer(schema.field(name).type) else np.float64
    column = dataset.labels(split, [name]).column(name)
    return np.asarray(column.to_numpy(zero_copy_only=False)).astype(kind)


def _lowest_teeth(dataset: Dataset, split: str, column: str) -> np.ndarray:
    rows = dataset.labels(split, [column]).column(column).to_pylist()
    return np.array([min(row) if row else -1 for row in rows], dtype=np.int64)


def _outlines(dataset: Dataset, split: str) -> np.ndarray:
    """Return the box round all damage of the lowest damaged tooth, by the order of gears, (records, 4) float64."""
    place = {number: k for k, number in enumerate(dataset.labels(split, ["record_id"]).column("record_id").to_pylist())}
    lowest = [
        (gear, _lowest_teeth(dataset, split, column)) for gear, column in dataset.columns_of("faulty_teeth").items()
    ]
    found = np.tile([np.inf, -np.inf, np.inf, -np.inf], (len(place), 1))
    for row in dataset.damage(split).to_pylist():
        k = place[row["record_id"]]
        tooth = next(((gear, int(teeth[k])) for gear, teeth in lowest if teeth[k] >= 0), ("", -1))
        if (row["gear"], row["tooth"]) == tooth:
            face, height = row["semi_axis_face_mm"], row["semi_axis_profile_mm"]
            box = (row["face_mm"] - face, row["face_mm"] + face, row["height_mm"] - height, row["height_mm"] + height)
            found[k, ::2] = np.minimum(found[k, ::2], box[::2])
            found[k, 1::2] = np.maximum(found[k, 1::2], box[1::2])
    return np.where(np.isfinite(found), found, np.nan)


def window_angles(
    pulses: np.ndarray, turn: int, start: int, fs_hz: float, samples_per_revolution: int | None
) -> tuple[float, float]:
    """Return the first shaft's angle at a window's start, 0 to 2 pi, and the sample at which tooth 0 next enters.

    Parameters
    ----------
    pulses : (k,) float64
        Pulse times of the record [s].
    turn : int
        Pulse at or before the start of the window.
    start : int
        First sample of the window in the record, as taken.
    fs_hz : float
        Sampling rate [Hz].
    samples_per_revolution : int or None
        Where windows are resampled to angle they start on a pulse: both values are 0.
    """
    if samples_per_revolution is not None:
        return 0.0, 0.0
    time_s = start / fs_hz
    share = (time_s - pulses[turn]) / (pulses[turn + 1] - pulses[turn])
    entry_s = pulses[turn] if time_s <= pulses[turn] else pulses[turn + 1]
    return float(2.0 * np.pi * (share % 1.0)), float((entry_s - time_s) * fs_hz)


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
    quantity : str or None
        Channels that hold this, such as "acceleration"; None: all. Every channel comes in its own unit, so a network
        that takes several quantities has to standardise them.
    classes : str
        What `class_id` counts: `state`s, or primary `fault`s; healthy ones are one class.

    Raises
    ------
    UsageError
        If a number is too small, or the classes are of an unknown kind.
    """

    revolutions: int = FEWEST_REVOLUTIONS
    hop_revolutions: int = 4
    samples_per_revolution: int | None = 288
    quantity: str | None = None
    classes: str = STATE

    def __post_init__(self) -> None:
        check_kind(self.classes)
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
        Shard, row in it, and first sample in the decoded record.
    record : (windows,) int
        Position of the record in the split.
    samples : int
        Samples of a window.
    lengths : tuple of (rows,) int
        Samples of the decoded records of every shard.
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
        Labels besides the usual ones, see `diagnostics.loader.window_index`.

    Raises
    ------
    UsageError
        If a label is unknown.
    DatasetError
        If no record of the split holds a whole window.
    """
    labels = {**_columns(dataset, split, LABELS), "class_id": _class_id(dataset, split, settings.classes)}
    labels |= record_labels(dataset, split, [name for name in further if name not in labels])
    pulses = [list(_pulses(dataset.shard_rows(one, ["tacho_s"]))) for one in dataset.shards(split)]
    samples = _window_samples(pulses, settings, dataset.fs_hz)
    recorded = round(dataset.duration_s * dataset.fs_hz)
    rows, lengths, angles, record = [], [], [], 0
    for number, group in enumerate(pulses):
        lengths.append(np.array([_decoded_samples(times, settings, recorded) for times in group], dtype=np.int64))
        for row, times in enumerate(group):
            starts = window_starts(times, settings, dataset.fs_hz)
            for turn, start in starts.items():
                if start + samples <= lengths[-1][row]:
                    rows.append((number, row, start, record))
                    angles.append(window_angles(times, turn, start, dataset.fs_hz, settings.samples_per_revolution))
            record += 1
    if not rows:
        raise DatasetError(
            f"{dataset.path}: no record of split {split!r} holds {settings.revolutions} whole turns of the first "
            "shaft. Use longer records (`duration_s`) or a higher speed."
        )
    found = np.array(rows, dtype=np.int64).T
    of_windows = {name: column for name, column in zip(ANGLES, np.array(angles).T, strict=True) if name in further}
    return WindowIndex(found[0], found[1], found[2], found[3], samples, tuple(lengths), labels, of_windows)


def _columns(dataset: Dataset, split: str | None, names: tuple[str, ...]) -> dict[str, np.ndarray]:
    table = dataset.labels(split, list(names))
    return {name: np.asarray(table.column(name).to_pylist()) for name in names}


def _class_id(dataset: Dataset, split: str, kind: str) -> np.ndarray:
    """Return the class of every record of the split, (records,) int64: its place among those of the whole set."""
    states = dataset.labels(split, ["state"]).column("state").to_pylist()
    return set_classes(dataset, kind).places(np.asarray(states))


def _pulses(rows: pa.RecordBatch) -> Iterator[np.ndarray]:
    column = rows.column("tacho_s")
    yield from (np.asarray(column[row].values, dtype=np.float64) for row in range(len(column)))


def window_starts(pulses: np.ndarray, settings: StreamSettings, fs_hz: float) -> dict[int, int]:
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
