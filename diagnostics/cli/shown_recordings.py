"""Recordings of a machine for its page: read, with their indicators, and with what was said of each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from diagnostics.base.progress import Stage
from diagnostics.cli.recording_options import file_rows
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.explore.recordings_source import ShownRecording
    from diagnostics.machine.recording_indicators import RecordingIndicators
    from diagnostics.recordings.measured_recording import RecordingFacts


def of_machine(folder: Path, said: Sequence[str], stage: Stage) -> list[ShownRecording]:
    """Return recordings of a machine: its references by their names, the others with their latest verdict.

    Raises
    ------
    UsageError
        If no recording is given: the folder of a machine holds none of their samples.
    """
    from diagnostics.explore.recordings_source import REFERENCE, UNKNOWN
    from diagnostics.machine.check_history import past_checks
    from diagnostics.machine.machine import load_machine

    known = load_machine(folder)
    if not said:
        raise UsageError(
            f"{folder}: holds no samples of its recordings; name their files too, such as: explore {folder.name} "
            f"{' '.join(known.references[:2])} august.csv"
        )
    loads = dict(zip(known.references, known.load.tolist(), strict=True))
    verdicts = {past.recording: past.verdict for past in past_checks(folder)} | dict.fromkeys(
        known.references, REFERENCE
    )
    facts = replace(known.facts, columns=known.facts.columns or {name: name for name in known.channels})
    found = _read(said, known.teeth, facts, known.speed_range_hz, stage)
    return [_shown(one, verdicts.get(one.name, UNKNOWN), loads.get(one.name)) for one in found]


def of_files(
    said: Sequence[str],
    healthy: Sequence[str],
    teeth: tuple[int, int],
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    stage: Stage,
) -> list[ShownRecording]:
    """Return recordings that the user describes; those of `healthy` are the references."""
    from diagnostics.explore.recordings_source import REFERENCE, UNKNOWN

    references = _read(healthy, teeth, facts, speed_range_hz, stage)
    others = _read(said, teeth, facts, speed_range_hz, stage)
    return [*(_shown(one, REFERENCE, None) for one in references), *(_shown(one, UNKNOWN, None) for one in others)]


def _shown(found: RecordingIndicators, verdict: str, load: float | None) -> ShownRecording:
    from diagnostics.explore.recordings_source import ShownRecording

    return ShownRecording(found, verdict, float("nan") if load is None else load)


def _read(
    said: Sequence[str],
    teeth: tuple[int, int],
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    stage: Stage,
) -> list[RecordingIndicators]:
    from diagnostics.machine.recording_indicators import recording_indicators

    sources = [source for one in said for source in file_rows(one)]
    found: list[RecordingIndicators] = []
    with stage("indicators of recordings", len(sources)) as advance:
        for path, row in sources:
            found.append(recording_indicators(path, teeth, replace(facts, row=row), speed_range_hz))
            advance()
    return found
