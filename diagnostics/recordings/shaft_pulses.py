"""Pulse times of the pinion of a recording: from its tacho, or from the mesh lines in a range of speed of any width.

A range wider than one to two holds several candidates, since a comb of mesh harmonics also fits in part at twice, half
or two thirds of the speed. It is searched in parts narrower than that; what is found is judged by the lines of the
shafts themselves (see `surest_speed`). Where no lines of the shaft show, or the gear's teeth are a multiple of the
pinion's, so that its lines fall between, the fastest comb that holds practically all power in mesh lines is taken:
slower ones hold it too, with empty lines between, faster ones lose lines. Where two speeds fit alike, or the best one
lies outside the range, none is taken. Source: derived; the search is in `tacholess_angle`.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from diagnostics.recordings.comb_pulses import distinct_speeds, mean_speed, pulses_around
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.recordings.surest_speed import JUDGED_S, LINES_COMPARED, surest_speed
from diagnostics.signal.order_spectrum import order_spectrum
from diagnostics.signal.tacholess_angle import LEAST_CLARITY, MeshRidge, mesh_ridge
from siggen.errors import UsageError

PART_RATIO = 1.6
"""High over low of one part; below two, so that a part holds one mesh harmonic only."""

NARROW_RATIO = 1.05
"""The same where the wide parts give no speed; lines of two stages hardly ever lie that near."""

CLEAR_ENOUGH = 0.5
"""Clarity, relative to the clearest part, from which a part's speed is a candidate."""

POWER_KEPT = 0.99
"""Share of the power in mesh lines that a faster comb must still hold; what lies between true lines is sidebands and
noise, at -20 dB and below."""

LEAST_MESH_SHARE = 0.5
"""Share of the power that mesh lines must hold where the shaft does not show."""

FEWEST_REVOLUTIONS = 2
SEARCHED_S = 12.0
"""Seconds in which the speed is searched; the pulses are then taken from the whole recording."""


@dataclass(frozen=True, slots=True)
class ShaftPulses:
    """Pulse times (k,) [s] of the pinion, and where they come from: `tacho` or the channel whose mesh lines led."""

    times_s: np.ndarray
    source: str

    @property
    def speed_hz(self) -> float:
        """Mean speed of the pinion."""
        return float((self.times_s.size - 1) / (self.times_s[-1] - self.times_s[0]))


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
        Slowest and fastest pinion speed; needed without a tacho.

    Raises
    ------
    UsageError
        Naming the file: no tacho and no range, no mesh line found, or fewer than two revolutions of either shaft.
    """
    if recording.tacho_s is not None:
        found = ShaftPulses(recording.tacho_s, "tacho")
    elif speed_range_hz is None:
        raise UsageError(
            f"{recording.path}: neither tacho nor speed; name the tacho's column with --tacho, or the range the pinion "
            "can have run in with --speed-range LOW,HIGH"
        )
    else:
        found = _from_mesh(recording, teeth, speed_range_hz)
    turns = found.times_s.size - 1
    if min(turns, turns * teeth[0] / teeth[1]) < FEWEST_REVOLUTIONS:
        needed = int(np.ceil(FEWEST_REVOLUTIONS * max(1.0, teeth[1] / teeth[0])))
        raise UsageError(
            f"{recording.path}: {turns} whole pinion revolutions; averages of both shafts need {needed}. Record longer."
        )
    return found


def _from_mesh(
    recording: MeasuredRecording, teeth: tuple[int, int], speed_range_hz: tuple[float, float]
) -> ShaftPulses:
    try:
        return _in_wide_parts(recording, teeth, speed_range_hz)
    except UsageError as error:
        found = _in_narrow_parts(recording, teeth, speed_range_hz)
        if found is None:
            raise UsageError(f"{recording.path}: {error}") from error
        return found


def _in_wide_parts(
    recording: MeasuredRecording, teeth: tuple[int, int], speed_range_hz: tuple[float, float]
) -> ShaftPulses:
    pinion, gear = teeth
    channel, speeds = _candidates(recording, pinion, range_parts(speed_range_hz), speed_range_hz)
    signal, fs_hz = recording.channels[channel], recording.fs_hz
    chosen = surest_speed(recording, channel, teeth, speeds, speed_range_hz) if gear % pinion else None
    if chosen is None:
        doubled = [2.0 * speed for speed in speeds if 2.0 * np.median(speed) <= speed_range_hz[1]]
        judged = signal[: round(JUDGED_S * fs_hz)]
        chosen = _by_power(judged, fs_hz, pinion, distinct_speeds([*speeds, *doubled]))
        if gear % pinion:
            _check_mesh_rules(judged, fs_hz, pinion, chosen)
    return ShaftPulses(pulses_around(signal, fs_hz, pinion, chosen), channel)


def _in_narrow_parts(
    recording: MeasuredRecording, teeth: tuple[int, int], speed_range_hz: tuple[float, float]
) -> ShaftPulses | None:
    """Return the pulses at a speed whose shaft shows, though lines of another stage are stronger than the mesh lines.

    Those lines lead in the wide part that holds both; a narrow part holds one of them alone.
    """
    pinion, gear = teeth
    if gear % pinion == 0:
        return None
    try:
        channel, speeds = _candidates(recording, pinion, range_parts(speed_range_hz, NARROW_RATIO), speed_range_hz)
        chosen = surest_speed(recording, channel, teeth, speeds, speed_range_hz)
    except UsageError:
        return None
    if chosen is None:
        return None
    return ShaftPulses(pulses_around(recording.channels[channel], recording.fs_hz, pinion, chosen), channel)


def _check_mesh_rules(signal: np.ndarray, fs_hz: float, teeth: int, speed_hz: np.ndarray) -> None:
    """Check that mesh lines hold most of the power; without lines of the shaft nothing else speaks for a comb."""
    pulses = pulses_around(signal, fs_hz, teeth, speed_hz)
    share = 0.5 * line_power(signal, fs_hz, teeth, pulses, 0.45 * fs_hz) / float(np.var(signal))
    if share < LEAST_MESH_SHARE:
        raise UsageError(
            f"{mean_speed(pulses):.4g} Hz would fit, but neither do lines of that shaft show nor is most power "
            "in its mesh lines. Check teeth, give a narrower --speed-range, or a tacho."
        )


def _by_power(signal: np.ndarray, fs_hz: float, teeth: int, speeds: list[np.ndarray]) -> np.ndarray:
    """Return the fastest speed over time whose mesh lines hold practically all of the power."""
    if len(speeds) == 1:
        return speeds[0]
    pulses = [pulses_around(signal, fs_hz, teeth, speed) for speed in speeds]
    highest_hz = min(LINES_COMPARED * teeth * max(mean_speed(own) for own in pulses), 0.45 * fs_hz)
    power = np.array([line_power(signal, fs_hz, teeth, own, highest_hz) for own in pulses])
    kept = np.flatnonzero(power >= POWER_KEPT * power.max())
    return speeds[max(kept, key=lambda k: mean_speed(pulses[k]))]


def line_power(signal: np.ndarray, fs_hz: float, teeth: int, pulses_s: np.ndarray, highest_hz: float) -> float:
    """Return the power in the mesh lines up to a frequency, in squared units of the signal."""
    spectrum = order_spectrum(signal, pulses_s, fs_hz, teeth)
    count = max(1, int(highest_hz / (teeth * mean_speed(pulses_s))))
    lines = np.arange(1, count + 1) * teeth * spectrum.revolutions
    return float(np.sum(spectrum.amplitude_m_s2[lines[lines < spectrum.order.size]] ** 2))


def _candidates(
    recording: MeasuredRecording,
    teeth: int,
    parts: list[tuple[float, float]],
    speed_range_hz: tuple[float, float],
) -> tuple[str, list[np.ndarray]]:
    """Return the clearest channel and the speeds over time that its parts of the range show."""
    samples = round(SEARCHED_S * recording.fs_hz)
    found: dict[str, list[MeshRidge]] = {
        name: [mesh_ridge(signal[:samples], recording.fs_hz, teeth, part) for part in parts]
        for name, signal in recording.channels.items()
    }
    channel = max(found, key=lambda name: max(ridge.clarity for ridge in found[name]))
    clearest = max(ridge.clarity for ridge in found[channel])
    if clearest < LEAST_CLARITY:
        raise UsageError(
            f"no mesh line stands above the noise within {speed_range_hz[0]:g} to {speed_range_hz[1]:g} Hz of pinion "
            f"speed (clarity {clearest:.2f}, at least {LEAST_CLARITY:g}). Check range and teeth, or give a tacho."
        )
    return channel, [ridge.speed_hz for ridge in found[channel] if ridge.clarity >= CLEAR_ENOUGH * clearest]


def range_parts(speed_range_hz: tuple[float, float], ratio: float = PART_RATIO) -> list[tuple[float, float]]:
    """Return overlapping parts of a range, each of this ratio of high to low, and an overlap of at most 10 %.

    Raises
    ------
    UsageError
        If the range is empty or not positive.
    """
    low, high = speed_range_hz
    if not 0.0 < low < high < np.inf:
        raise UsageError(f"speed range: received {low:g} to {high:g} Hz; allowed is 0 < low < high")
    count = int(np.ceil(np.log(high / low) / np.log(ratio)))
    edges = low * (high / low) ** (np.arange(count + 1) / count)
    return [(float(a), float(min(min(1.1, ratio**0.5) * b, high))) for a, b in itertools.pairwise(edges)]
