"""Pulse times of the pinion of a recording: from its tacho, or from the lines of both shafts in a range of speed.

Without a tacho the speed in the range that most speaks for is taken if it is certain enough (see `speed_search`); two
speeds of which neither is certain are refused, and so is a range outside of which lines fit far better.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.speed_search import NARROW_RATIO, SpeedFound, pulses_of, speed_search
from siggen.errors import UsageError

CERTAIN = 0.95
"""Certainty below which no speed is taken; docs/scripts/speed_machines.py counts how often it is kept."""

FEWEST_REVOLUTIONS = 2


@dataclass(frozen=True, slots=True)
class ShaftPulses:
    """Pulse times (k,) [s] of the pinion, and where they come from: `tacho` or the channel whose mesh lines led.

    `certainty` (0 to 1) is that of the speed; 1 with a tacho.
    """

    times_s: np.ndarray
    source: str
    certainty: float = 1.0

    @property
    def speed_hz(self) -> float:
        """Mean speed of the pinion."""
        return float((self.times_s.size - 1) / (self.times_s[-1] - self.times_s[0]))

    @property
    def origin(self) -> str:
        """Where the pulses come from, in words."""
        if self.source == "tacho":
            return "tacho"
        return f"mesh lines of {self.source}, certain to {min(self.certainty, 0.999):.1%}"


def shaft_pulses(
    recording: MeasuredRecording, teeth: tuple[int, int], speed_range_hz: tuple[float, float] | None
) -> ShaftPulses:
    """Return the pulses of the pinion.

    Parameters
    ----------
    recording : MeasuredRecording
        With or without a tacho.
    teeth : (int, int)
        Teeth of pinion and gear.
    speed_range_hz : (float, float), optional
        Slowest and fastest pinion speed; needed without a tacho, and not left.

    Raises
    ------
    UsageError
        Naming the file: no tacho and no range, no speed that is certain, or fewer than two revolutions of either shaft.
    """
    if recording.tacho_s is not None:
        found = ShaftPulses(recording.tacho_s, "tacho")
    elif speed_range_hz is None:
        raise UsageError(
            f"{recording.path}: neither tacho nor speed; name the tacho's column with --tacho, or the range the pinion "
            "can have run in with --speed-range LOW,HIGH"
        )
    else:
        found = _from_lines(recording, teeth, speed_range_hz)
    turns = found.times_s.size - 1
    if min(turns, turns * teeth[0] / teeth[1]) < FEWEST_REVOLUTIONS:
        needed = int(np.ceil(FEWEST_REVOLUTIONS * max(1.0, teeth[1] / teeth[0])))
        raise UsageError(
            f"{recording.path}: {turns} whole pinion revolutions; averages of both shafts need {needed}. Record longer."
        )
    return found


def _from_lines(
    recording: MeasuredRecording, teeth: tuple[int, int], speed_range_hz: tuple[float, float]
) -> ShaftPulses:
    try:
        found = speed_search(recording, teeth, speed_range_hz)
        if found.certainty < CERTAIN:
            # a louder stage leads in a wide part that holds both; a narrow part holds one of them alone
            found = max(found, speed_search(recording, teeth, speed_range_hz, NARROW_RATIO), key=_sureness)
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from error
    if found.certainty < CERTAIN:
        raise UsageError(f"{recording.path}: {_uncertain(found, speed_range_hz)}")
    channel, pulses_s = pulses_of(recording, teeth, found)
    return ShaftPulses(pulses_s, channel, found.certainty)


def _sureness(found: SpeedFound) -> float:
    return found.evidence


def _uncertain(found: SpeedFound, speed_range_hz: tuple[float, float]) -> str:
    low, high = speed_range_hz
    rival, share = found.rivals[0] if found.rivals else (0.0, 0.0)
    if share > found.certainty and not low <= rival <= high:
        return (
            f"the lines fit {rival:.4g} Hz of pinion speed best, outside of {low:g} to {high:g} Hz "
            f"({found.speed_hz:.4g} Hz inside). Check range and teeth, or give a tacho."
        )
    if share > 0.1 * found.certainty:
        return (
            f"speeds of {found.speed_hz:.4g} ({found.certainty:.0%}) and {rival:.4g} Hz ({share:.0%}) are not told "
            f"apart; allowed is a certainty of {CERTAIN:.0%}. Give a narrower --speed-range, a longer recording or a "
            "tacho."
        )
    return (
        f"no lines of these shafts stand above the noise within {low:g} to {high:g} Hz of pinion speed (best "
        f"{found.speed_hz:.4g} Hz, certain to {found.certainty:.0%}; allowed is {CERTAIN:.0%}). Check range and teeth, "
        "give a longer recording or a tacho."
    )
