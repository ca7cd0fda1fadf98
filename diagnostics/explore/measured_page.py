"""The page of recordings of one machine: the same charts as those of a set, without what only a simulation knows.

Recordings of one machine as a page shows them: the healthy ones, and others with their verdicts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from diagnostics.base.progress import Stage, silent_stage
from diagnostics.explore.look import TEMPLATES, look_of, look_page
from diagnostics.explore.payload import PageSource, RecordList, packed_indicators
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.machine.recording_indicators import RecordingIndicators
from diagnostics.page.sentences import listed
from diagnostics.page.template import write_page
from diagnostics.recordings.in_rig import in_rig
from diagnostics.records.gear_train import gear_names, in_column
from diagnostics.records.recording import Recording
from diagnostics.records.state_classes import HEALTHY
from siggen.errors import UsageError

REFERENCE, UNKNOWN = "healthy reference", "not judged"

COLUMNS = (
    *(("record_id", "Recording"), ("state", "Verdict"), ("name", "File"), ("speed_hz", "Speed [Hz]")),
    ("torque_nm", "Load"),
)
FILTERS = (("state", "Verdict"),)


@dataclass(frozen=True, slots=True)
class ShownRecording:
    """A recording with its indicators; what was said of it; its load as the user gave it (NaN where he did not)."""

    indicators: RecordingIndicators
    verdict: str
    load: float

    @property
    def healthy(self) -> bool:
        """Whether it is one of the machine's healthy recordings."""
        return self.verdict == REFERENCE


def recordings_source(shown: Sequence[ShownRecording]) -> PageSource:
    """Return recordings of one machine.

    Parameters
    ----------
    shown : sequence of ShownRecording
        At least one; all of the same rate and channels.

    Raises
    ------
    UsageError
        If rates or channels differ: charts and indicators could not be laid over each other.
    """
    first = shown[0].indicators
    for recording in shown[1:]:
        _check_alike(first, recording.indicators)
    names = tuple(dict.fromkeys(name for recording in shown for name in recording.indicators.values))
    values = np.array([[recording.indicators.values.get(name, np.nan) for name in names] for recording in shown])
    return PageSource(
        labels=_labels(shown),
        overlay=nearest_healthy(shown),
        kept=np.arange(len(shown)),
        records=lambda _numbers: _records(shown),
        channels=tuple(first.recording.channels),
        fs_hz=first.recording.fs_hz,
        duration_s=max(recording.indicators.recording.duration_s for recording in shown),
        indicators=packed_indicators(names, values, IndicatorSettings(), named=gear_names(first.train)),
        teeth=tuple(_teeth_labels(first).values()),
        measured=True,
        named=gear_names(first.train),
    )


def _check_alike(first: RecordingIndicators, other: RecordingIndicators) -> None:
    rates = first.recording.fs_hz, other.recording.fs_hz
    if abs(rates[1] / rates[0] - 1.0) > 1e-6:
        raise UsageError(
            f"{other.name}: recorded at {rates[1]:g} Hz, {first.name} at {rates[0]:g} Hz; allowed: one rate on a page"
        )
    channels = tuple(first.recording.channels), tuple(other.recording.channels)
    if channels[0] != channels[1]:
        raise UsageError(
            f"{other.name}: has the channels {', '.join(channels[1])}, {first.name} {', '.join(channels[0])}; allowed: "
            f"the same ones. Name them alike: {in_rig('channels: {NAME: COLUMN}')}"
        )


def _labels(shown: Sequence[ShownRecording]) -> dict[str, np.ndarray]:
    count = len(shown)
    return {
        "record_id": np.arange(1, count + 1),
        "name": np.array([recording.indicators.name for recording in shown]),
        "state": np.array([recording.verdict for recording in shown]),
        "fault": np.array([HEALTHY if recording.healthy else "unknown" for recording in shown]),
        "specimen_id": np.arange(count),  # an indicator's place is among the other recordings
        "operating_point_id": np.zeros(count, dtype=np.int64),
        "speed_hz": np.array([recording.indicators.pulses.speed_hz for recording in shown]),
        "torque_nm": np.array([recording.load for recording in shown]),
        "damaged_area_mm2": np.full(count, np.nan),
        **{
            label: np.array([recording.indicators.train.gear(gear).teeth for recording in shown])
            for gear, label in _teeth_labels(shown[0].indicators).items()
        },
    }


def nearest_healthy(shown: Sequence[ShownRecording]) -> list[int | None]:
    """Return the row of the healthy recording nearest in speed to each, never its own; None where there is none."""
    speeds = [recording.indicators.pulses.speed_hz for recording in shown]
    rows = [k for k, recording in enumerate(shown) if recording.healthy]
    return [
        min((k for k in rows if k != row), key=lambda k: abs(speeds[k] - speed), default=None)
        for row, speed in enumerate(speeds)
    ]


def _records(shown: Sequence[ShownRecording]) -> Iterator[Recording]:
    for number, one in enumerate(shown, start=1):
        measured, train = one.indicators.recording, one.indicators.train
        yield Recording({"record_id": number}, measured.channels, one.indicators.pulses.times_s, measured.fs_hz, train)


def _teeth_labels(recording: RecordingIndicators) -> dict[str, str]:
    """Return what the labels with teeth are called, as in a set, by the gears of the first mesh."""
    return {gear: f"teeth_{in_column(gear)}" for gear in recording.mesh.names.gears}


def write_recordings_page(
    name: str, shown: Sequence[ShownRecording], path: Path, *, full: bool = False, stage: Stage = silent_stage
) -> Path:
    """Write the page of recordings and return its path.

    Parameters
    ----------
    name : str
        Of the machine.
    shown : sequence of ShownRecording
        At least one.
    path : Path
        The HTML file.
    full : bool
        Whether all samples are kept, as far as 30 MB allow.
    stage : Stage
        Told of every recording.

    Raises
    ------
    UsageError
        If the recordings differ in rate or channels.
    """
    missing = missing_sentences(sum(recording.healthy for recording in shown))
    look = look_of(recordings_source(shown), RecordList(COLUMNS, FILTERS, missing), stage, full=full)
    write_page(path, look_page(f"Recordings of {name}", look))
    return path


def missing_sentences(healthy: int) -> list[str]:
    """Return what recordings do not give, and how to have it."""
    return listed(TEMPLATES / "missing_of_recordings.txt", healthy=healthy, reference=REFERENCE)
