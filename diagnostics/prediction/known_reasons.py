"""Reasons to abstain that are known without a distance: teeth, rate, speed or length that were never trained.

Source: derived.

OwnState: a recording against healthy recordings of the same machine, before any state is named.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.prediction.model_facts import ModelFacts
from diagnostics.prediction.record_pieces import RecordPieces
from diagnostics.recordings.channel_factor import ACCELERATION_UNIT
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_pulses import ShaftPulses
from diagnostics.records.state_classes import HEALTHY
from diagnostics.statistics.change_score import FEWEST, ChangeScore, attainable_rate, change_score
from diagnostics.training.referenced import log_values
from siggen.errors import UsageError

FALSE_ALARMS = 0.05
UNTOLD = "cannot tell"

SHOWN_PAIRS = 5


@dataclass(frozen=True, slots=True)
class OwnState:
    """Verdict `changed`, `unchanged` or `cannot tell`, the reason in words, and the score where there is one."""

    verdict: str
    reason: str
    score: ChangeScore | None = None

    @property
    def changed(self) -> bool:
        """Whether the machine has changed."""
        return self.score is not None and self.score.changed

    def contradicts(self, named: str) -> bool:
        """Return whether a named state and the change point different ways."""
        return self.score is not None and self.changed == (named == HEALTHY)


def own_state(pieces: RecordPieces, references: Sequence[RecordPieces]) -> OwnState:
    """Return whether a recording differs from healthy ones of the same machine, by all indicators that all define.

    Parameters
    ----------
    pieces : RecordPieces
        Of the recording.
    references : sequence of RecordPieces
        Of each healthy recording.
    """
    if len(references) < FEWEST:
        few = f"a verdict takes {FEWEST} healthy recordings, one with 5 % of false alarms 19; given: {len(references)}"
        return OwnState(UNTOLD, few)
    healthy = log_values(np.stack([one.medians(pieces.names) for one in references]))
    try:
        score = change_score(healthy, log_values(pieces.medians(pieces.names)[None])[0], FALSE_ALARMS)
    except UsageError as error:
        return OwnState(UNTOLD, str(error))
    rate = attainable_rate(len(references), FALSE_ALARMS)
    side = "above" if score.changed else "not above"
    reason = f"distance {score.score:.3g}, {side} the limit {score.limit:.3g}; promised false alarms: {rate:.0%}"
    return OwnState("changed" if score.changed else "unchanged", reason, score)


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
        speed = f"the {facts.first_gear} speed is {pulses.speed_hz:.4g} Hz"
        found.append(f"{speed}, training covers {low:.4g} to {high:.4g} Hz")
    return found + _length_reasons(facts, pieces)


def check_units(facts: ModelFacts, recording: MeasuredRecording) -> None:
    """Refuse a recording with a channel in another unit than in training.

    Raises
    ------
    UsageError
        Naming the channel, both units and the way out.
    """
    for name, unit in zip(facts.channels, facts.units, strict=True):
        if (found := recording.units.get(name, ACCELERATION_UNIT)) != unit:
            raise UsageError(
                f"{recording.path}: channel {name} is in {found}; allowed: {unit}, as in training. Give a recording of "
                f"the same quantity, or a model trained on {found}"
            )


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
    covered = f"averages cover {pieces.revolutions} {facts.first_gear} revolutions"
    return [f"{covered}, in training {facts.fewest_revolutions} or more"]


def reference_reasons(
    facts: ModelFacts, reference: MeasuredRecording, pulses: ShaftPulses, pieces: RecordPieces, speed_hz: float
) -> list[str]:
    """Return what forbids to refer to a recording: it differs from how training records and their references stood."""
    found = _rate_reasons(facts, reference) + _length_reasons(facts, pieces)
    allowed = 1.01 * (facts.reference_speed_ratio or 1.0)  # a mean speed scatters by less than one per cent
    if max(pulses.speed_hz / speed_hz, speed_hz / pulses.speed_hz) > allowed:
        found.append(
            f"the {facts.first_gear} speed is {pulses.speed_hz:.4g} Hz, the recording has {speed_hz:.4g} Hz, in "
            f"training they differed by a factor of {facts.reference_speed_ratio or 1.0:.3g} at most"
        )
    return [f"reference {reference.path.name}: {text}" for text in found]
