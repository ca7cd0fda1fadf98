"""The speed whose own shafts show, among those at which a comb of mesh lines fits.

A comb also fits in part at twice, half or two thirds of the speed, so those are judged as well. What shows is the
pinion's shaft first (see `shaft_contrast`). Where the gear's does not show with it, the comb may be that of a second
stage on the gear's shaft: then a speed at which both shafts show wins. Source: derived.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.recordings.comb_pulses import SAME_SPEED, distinct_speeds, mean_speed, pulses_around
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.shaft_contrast import shaft_contrast
from siggen.errors import UsageError

LINES_COMPARED = 10

RATIOS = (0.5, 2.0 / 3.0, 0.75, 1.0, 4.0 / 3.0, 1.5, 2.0)
"""Speeds over the one that a part shows, at which mesh harmonics fall on each other."""

LEAST_CONTRAST = 0.25
"""Two and a half times what noise reaches: with less, the shaft itself cannot be seen, and mesh lines must do."""

TIMES_THE_GEAR = range(1, 9)
"""What passes for the pinion may turn so many times as fast as the gear's shaft, with a second stage for the mesh."""

CLEAR_LEAD = 0.8
"""Contrast, relative to the best one, from which another speed fits alike."""

JUDGED_S = 3.0
"""Seconds on which candidates are compared."""


@dataclass(frozen=True, slots=True, eq=False)
class _Candidate:
    """A speed over time, its mean, and how far lines of pinion and gear stand out at it."""

    speed_hz: np.ndarray
    mean_hz: float
    pinion: float
    gear: float

    @property
    def both(self) -> bool:
        """Whether both shafts show."""
        return min(self.pinion, self.gear) >= LEAST_CONTRAST


@dataclass(frozen=True, slots=True)
class _Judge:
    """What candidates are judged by: the beginning of a recording, its clearest channel, teeth, highest frequency."""

    recording: MeasuredRecording
    channel: str
    teeth: tuple[int, int]
    highest_hz: float

    def candidate(self, speed: np.ndarray) -> _Candidate:
        """Return a speed over time with what its shafts show, mean over channels."""
        samples = round(JUDGED_S * self.recording.fs_hz)
        signals = [signal[:samples] for signal in self.recording.channels.values()]
        clearest = self.recording.channels[self.channel][:samples]
        pulses = pulses_around(clearest, self.recording.fs_hz, self.teeth[0], speed)
        turns_of_gear = np.arange(0.0, pulses.size - 1, self.teeth[1] / self.teeth[0])
        of_gear = np.interp(turns_of_gear, np.arange(pulses.size), pulses)
        shown = [
            float(np.mean([shaft_contrast(one, own, self.recording.fs_hz, count, self.highest_hz) for one in signals]))
            for own, count in ((pulses, self.teeth[0]), (of_gear, self.teeth[1]))
        ]
        return _Candidate(speed, mean_speed(pulses), *shown)


def surest_speed(
    recording: MeasuredRecording,
    channel: str,
    teeth: tuple[int, int],
    speeds: list[np.ndarray],
    speed_range_hz: tuple[float, float],
) -> np.ndarray | None:
    """Return the speed over time (k,) [Hz] whose shafts show; None where the pinion's shows at none.

    Parameters
    ----------
    recording : MeasuredRecording
    channel : str
        With the clearest mesh lines.
    teeth : (int, int)
    speeds : list of (k,) float64
        At which mesh lines fit.
    speed_range_hz : (float, float)
        That the speed must lie in.

    Raises
    ------
    UsageError
        If the surest speed lies outside the range, or another fits alike.
    """
    fastest = max(float(np.median(speed)) for speed in speeds)
    judge = _Judge(recording, channel, teeth, min(LINES_COMPARED * teeth[0] * fastest, 0.45 * recording.fs_hz))
    tried = distinct_speeds([*speeds, *(ratio * one for one in speeds for ratio in RATIOS)])
    found = [judge.candidate(speed) for speed in tried]
    best = max(found, key=lambda one: one.pinion)
    if best.pinion < LEAST_CONTRAST:
        return None
    if best.gear < LEAST_CONTRAST and (own := _of_gear(judge, best)) is not None:
        best, found = own, [own]
    _check_range(best, speed_range_hz)
    _check_rivals(best, [one for one in found if _within(one, speed_range_hz)])
    return best.speed_hz


def _of_gear(judge: _Judge, best: _Candidate) -> _Candidate | None:
    """Return the surest speed at which both shafts show, if the best one is a multiple of the gear's shaft."""
    gear = best.speed_hz * judge.teeth[1] / judge.teeth[0]
    both = [one for one in (judge.candidate(gear / k) for k in TIMES_THE_GEAR) if one.both]
    return max(both, key=lambda one: one.pinion + one.gear, default=None)


def _check_range(best: _Candidate, speed_range_hz: tuple[float, float]) -> None:
    if not _within(best, speed_range_hz):
        raise UsageError(
            f"the lines fit {best.mean_hz:.4g} Hz of pinion speed best, outside of {speed_range_hz[0]:g} "
            f"to {speed_range_hz[1]:g} Hz. Check range and teeth, or give a tacho."
        )


def _check_rivals(best: _Candidate, inside: list[_Candidate]) -> None:
    rivals = [one for one in inside if one.pinion >= CLEAR_LEAD * best.pinion and one is not best]
    if rivals:
        listed = ", ".join(f"{one.mean_hz:.4g}" for one in (best, *rivals))
        raise UsageError(f"speeds of {listed} Hz fit alike. Give a narrower --speed-range, or a tacho.")


def _within(one: _Candidate, speed_range_hz: tuple[float, float]) -> bool:
    low, high = speed_range_hz
    return (1.0 - SAME_SPEED) * low <= one.mean_hz <= (1.0 + SAME_SPEED) * high
