"""Reasons to abstain that are known without a distance: teeth, rate, speed or length that were never trained.

Source: derived.
"""

from __future__ import annotations

from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.record_pieces import RecordPieces
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses

SHOWN_PAIRS = 5


def known_reasons(
    facts: ModelFacts,
    recording: MeasuredRecording,
    pulses: ShaftPulses,
    teeth: tuple[int, int],
    pieces: RecordPieces,
) -> list[str]:
    """Return what is known of the recording and was never trained."""
    found = []
    if teeth not in facts.teeth:
        known = ", ".join(f"{a}/{b}" for a, b in facts.teeth[:SHOWN_PAIRS])
        known += f" and {more} more pairs" if (more := len(facts.teeth) - SHOWN_PAIRS) > 0 else ""
        found.append(f"the gears have {teeth[0]}/{teeth[1]} teeth, training covers {known} only")
    found += _rate_reasons(facts, recording)
    low, high = facts.speed_range_hz
    if not 0.99 * low <= pulses.speed_hz <= 1.01 * high:  # a mean speed scatters by less than one per cent
        found.append(f"the pinion speed is {pulses.speed_hz:.4g} Hz, training covers {low:.4g} to {high:.4g} Hz")
    return found + _length_reasons(facts, pieces)


def _rate_reasons(facts: ModelFacts, recording: MeasuredRecording) -> list[str]:
    if recording.fs_hz >= facts.fs_hz * (1.0 - 1e-3):
        return []
    return [
        f"the sampling rate is {recording.fs_hz:g} Hz, training has {facts.fs_hz:g} Hz: the band above "
        f"{0.5 * recording.fs_hz:g} Hz is missing"
    ]


def _length_reasons(facts: ModelFacts, pieces: RecordPieces) -> list[str]:
    if pieces.revolutions >= facts.fewest_revolutions - 1:  # one may be lost to where the piece begins
        return []
    return [f"averages cover {pieces.revolutions} pinion revolutions, in training {facts.fewest_revolutions} or more"]


def reference_reasons(
    facts: ModelFacts, reference: MeasuredRecording, pulses: ShaftPulses, pieces: RecordPieces, speed_hz: float
) -> list[str]:
    """Return what forbids to refer to a recording: it differs from how training records and their references stood."""
    found = _rate_reasons(facts, reference) + _length_reasons(facts, pieces)
    allowed = 1.01 * (facts.reference_speed_ratio or 1.0)  # a mean speed scatters by less than one per cent
    if max(pulses.speed_hz / speed_hz, speed_hz / pulses.speed_hz) > allowed:
        found.append(
            f"the pinion speed is {pulses.speed_hz:.4g} Hz, the recording has {speed_hz:.4g} Hz, in training they "
            f"differed by a factor of {facts.reference_speed_ratio or 1.0:.3g} at most"
        )
    return [f"reference {reference.path.name}: {text}" for text in found]
