"""Pulse times of the pinion of a recording: from its tacho, or from the lines of both shafts in a range of speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.records.planetary_members import Planets
from diagnostics.signal.mesh_pulses import mesh_pulses
from diagnostics.signal.order_domain import geared_pulses
from siggen.errors import UsageError

FEWEST_REVOLUTIONS = 2


@dataclass(frozen=True, slots=True)
class ShaftPulses:
    """Pulse times (k,) [s] of the pinion, and where they come from: `tacho` or the channel whose mesh lines led.

    `certainty` (0 to 1) is that of the speed; 1 with a tacho. Of a planetary set pulses are those of the sun against
    its carrier, `turns` per turn of its shaft.
    """

    times_s: np.ndarray
    source: str
    certainty: float = 1.0
    turns: float = 1.0

    @property
    def pulses_hz(self) -> float:
        """Mean rate of the pulses."""
        return float((self.times_s.size - 1) / (self.times_s[-1] - self.times_s[0]))

    @property
    def speed_hz(self) -> float:
        """Mean speed of the shaft of the pinion or of the sun."""
        return self.pulses_hz / self.turns

    @property
    def origin(self) -> str:
        """Where the pulses come from, in words."""
        if self.source == "tacho":
            return "tacho"
        return f"mesh lines of {self.source}, certain to {min(self.certainty, 0.999):.1%}"


def shaft_pulses(
    recording: MeasuredRecording,
    teeth: tuple[int, int],
    speed_range_hz: tuple[float, float] | None,
    planets: Planets | None = None,
) -> ShaftPulses:
    """Return the pulses of the pinion.

    Parameters
    ----------
    recording : MeasuredRecording
        With or without a tacho.
    teeth : (int, int)
        Teeth of pinion and gear.
    speed_range_hz : (float, float), optional
        Slowest and fastest pinion speed; needed without a tacho or a column of speed, and not left.
    planets : Planets, optional
        Of a planetary set, whose tacho is on the shaft of the sun.

    Raises
    ------
    UsageError
        Naming the file: no tacho and no range, no speed that is certain, or fewer than two revolutions of either shaft.
    """
    if planets is not None:
        found = _against_carrier(recording, planets)
    elif recording.tacho_s is not None:
        found = ShaftPulses(recording.tacho_s, "tacho")
    elif (span := speed_range_hz or recording.speed_span_hz) is None:
        raise UsageError(
            f"{recording.path}: neither tacho nor speed; name the tacho's column with --tacho, or the range the first "
            "shaft can have run in with --speed-range LOW,HIGH"
        )
    else:
        try:
            lines = mesh_pulses(recording.channels, recording.fs_hz, teeth, span)
        except UsageError as error:
            raise UsageError(f"{recording.path}: {error}") from error
        found = ShaftPulses(lines.times_s, lines.channel, lines.certainty)
    turns = found.times_s.size - 1
    if min(turns, turns * teeth[0] / teeth[1]) < FEWEST_REVOLUTIONS:
        needed = int(np.ceil(FEWEST_REVOLUTIONS * max(1.0, teeth[1] / teeth[0])))
        raise UsageError(
            f"{recording.path}: {turns} whole turns of the first shaft; averages of both shafts need {needed}. Record "
            "longer."
        )
    return found


def _against_carrier(recording: MeasuredRecording, planets: Planets) -> ShaftPulses:
    if recording.tacho_s is None:
        raise UsageError(
            f"{recording.path}: no tacho; the speed of planetary sets is not searched in lines, since passing planets "
            "move them. Name the column of a tacho on the sun's shaft with --tacho"
        )
    pulses = geared_pulses(recording.tacho_s, planets.sun_turns)
    if pulses.size < 2:
        raise UsageError(f"{recording.path}: no whole turn of the sun against the carrier. Record longer.")
    return ShaftPulses(pulses, "tacho", turns=float(planets.sun_turns))
