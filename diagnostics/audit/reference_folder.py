"""A user's own healthy recordings as features of windows, each window with its recording.

A file directly in the folder is a recording. Files of one subfolder belong together, such as channels of one machine
that ran once: they are one recording. Windows of one recording are not independent of each other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.file_columns import READERS
from diagnostics.signal.window_features import signal_windows, window_features
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

LOWEST_RATE_HZ = 9600.0
MOST_WINDOWS = 20
"""Windows taken of a channel, evenly spread."""


@dataclass(frozen=True, slots=True)
class WindowSet:
    """Windows of recordings or of gearboxes.

    Attributes
    ----------
    values : (windows, 64) float64
        Features.
    owner : (windows,) str
        Recording or gearbox.
    channel : (windows,) str
        Channel within it.
    """

    values: np.ndarray
    owner: np.ndarray
    channel: np.ndarray

    def medians(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the median features of every channel of every owner, (channels, 64), and the owners, (channels,)."""
        pairs = list(dict.fromkeys(zip(self.owner.tolist(), self.channel.tolist(), strict=True)))
        found = [self.values[(self.owner == owner) & (self.channel == channel)] for owner, channel in pairs]
        return np.stack([np.median(rows, axis=0) for rows in found]), np.array([owner for owner, _ in pairs])


class _Windows:
    """Windows as they are read."""

    def __init__(self) -> None:
        self.values: list[np.ndarray] = []
        self.owner: list[str] = []
        self.channel: list[str] = []

    def add(self, signal: np.ndarray, fs_hz: float, owner: str, channel: str) -> None:
        rows = _channel_features(signal, fs_hz)
        self.values += rows
        self.owner += [owner] * len(rows)
        self.channel += [channel] * len(rows)

    def together(self) -> WindowSet:
        return WindowSet(np.stack(self.values), np.array(self.owner), np.array(self.channel))


def reference_windows(folder: Path, fs_hz: float | None) -> WindowSet:
    """Return the windows of all recordings of a folder.

    Parameters
    ----------
    folder : Path
        With files, or with a subfolder for every recording.
    fs_hz : float, optional
        Sampling frequency [Hz] of files that do not state it.

    Raises
    ------
    UsageError
        Without readable files, a rate, or a whole window.
    """
    if not folder.is_dir():
        raise UsageError(f"{folder}: no such folder; give the folder of healthy recordings to --reference")
    files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in READERS)
    if not files:
        raise UsageError(f"{folder}: no recordings; allowed are files that end in {', '.join(READERS)}")
    windows = _Windows()
    for path in files:
        found = read_columns(path)
        rate = fs_hz or found.fs_hz
        if not rate or rate < LOWEST_RATE_HZ:
            raise UsageError(
                f"{path}: sampling rate: received {rate}; {LOWEST_RATE_HZ:g} Hz or more are needed. Files that do not "
                "state it: give it with --reference-fs"
            )
        inside = path.relative_to(folder)
        for name, signal in found.values.items():
            windows.add(signal, rate, inside.parts[0], f"{inside}:{name}")
    if not windows.values:
        raise UsageError(f"{folder}: no recording holds a whole second; windows of one second are needed")
    return windows.together()


def _channel_features(signal: np.ndarray, fs_hz: float) -> list[np.ndarray]:
    if not np.isfinite(signal).all():
        return []
    windows = signal_windows(signal, fs_hz)
    chosen = np.unique(np.linspace(0, len(windows) - 1, min(len(windows), MOST_WINDOWS)).round().astype(int))
    found = [window_features(windows[k]) for k in chosen.tolist()]
    return [row for row in found if np.isfinite(row).all()]


def synthetic_windows(dataset: Dataset, advance: Callable[[], None]) -> WindowSet:
    """Return the windows of the healthy records of a set; a source is a gearbox.

    Parameters
    ----------
    dataset : siggen Dataset
    advance : callable
        Called after every record.

    Raises
    ------
    UsageError
        If no healthy record holds a whole second.
    """
    columns = {channel.name: channel.column for channel in dataset.channels}
    windows = _Windows()
    for batch in dataset.records(columns=["specimen_id", "fault", *columns.values()]):
        for row in range(batch.num_rows):
            advance()
            if batch.column("fault")[row].as_py() != "healthy":
                continue
            owner = str(batch.column("specimen_id")[row].as_py())
            for name, column in columns.items():
                signal = np.asarray(batch.column(column)[row].values, dtype=np.float64)
                windows.add(signal, dataset.fs_hz, owner, name)
    if not windows.values:
        raise UsageError(f"{dataset.path}: no healthy record holds a whole second; --reference needs one")
    return windows.together()
