"""Pulse times of the pinion of a recording: from its tacho, or from the mesh lines in a range of speed of any width.

A range wider than one to two holds several candidates, since a comb of mesh harmonics also fits in part at twice, half
or two thirds of the speed. It is searched in parts narrower than that; among what is found, the fastest comb that holds
practically all power in mesh lines is taken: slower ones hold it too, with empty lines between, faster ones lose lines.
Source: derived; the search itself is in `tacholess_angle`.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.report.examples import order_spectrum
from diagnostics.signal.tacholess_angle import LEAST_CLARITY, MeshRidge, mesh_ridge, tacholess_pulses
from siggen.errors import UsageError

PART_RATIO = 1.6
"""High over low of one part; below two, so that a part holds one mesh harmonic only."""

CLEAR_ENOUGH = 0.5
"""Clarity, relative to the clearest part, from which a part's speed is a candidate."""

POWER_KEPT = 0.99
"""Share of the power in mesh lines that a faster comb must still hold; what lies between true lines is sidebands and
noise, at -20 dB and below."""

LINES_COMPARED = 10

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
        found = _from_mesh(recording, teeth[0], speed_range_hz)
    turns = found.times_s.size - 1
    if min(turns, turns * teeth[0] / teeth[1]) < FEWEST_REVOLUTIONS:
        needed = int(np.ceil(FEWEST_REVOLUTIONS * max(1.0, teeth[1] / teeth[0])))
        raise UsageError(
            f"{recording.path}: {turns} whole pinion revolutions; averages of both shafts need {needed}. Record longer."
        )
    return found


def _from_mesh(recording: MeasuredRecording, teeth: int, speed_range_hz: tuple[float, float]) -> ShaftPulses:
    try:
        channel, candidates = _candidates(recording, teeth, speed_range_hz)
        signal, fs_hz = recording.channels[channel], recording.fs_hz
        found = [_pulses_around(signal, fs_hz, teeth, speeds) for speeds in candidates]
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from error
    if len(found) == 1:
        return ShaftPulses(found[0], channel)
    fastest_hz = max(_mean_speed(pulses) for pulses in found)
    highest_hz = min(LINES_COMPARED * teeth * fastest_hz, 0.45 * fs_hz)
    power = np.array([line_power(signal, fs_hz, teeth, pulses, highest_hz) for pulses in found])
    kept = [pulses for pulses, share in zip(found, power / power.max(), strict=True) if share >= POWER_KEPT]
    return ShaftPulses(max(kept, key=_mean_speed), channel)


def _mean_speed(pulses_s: np.ndarray) -> float:
    return float((pulses_s.size - 1) / (pulses_s[-1] - pulses_s[0]))


def _pulses_around(signal: np.ndarray, fs_hz: float, teeth: int, speeds_hz: np.ndarray) -> np.ndarray:
    margin = 0.02 * float(speeds_hz.mean())
    low_high = (float(speeds_hz.min()) - margin, float(speeds_hz.max()) + margin)
    return tacholess_pulses(signal, fs_hz, teeth, low_high, doubts=False)  # half and double are compared by the caller


def line_power(signal: np.ndarray, fs_hz: float, teeth: int, pulses_s: np.ndarray, highest_hz: float) -> float:
    """Return the power in the mesh lines up to a frequency, in squared units of the signal."""
    spectrum = order_spectrum(signal, pulses_s, fs_hz, teeth)
    count = max(1, int(highest_hz / (teeth * _mean_speed(pulses_s))))
    lines = np.arange(1, count + 1) * teeth * spectrum.revolutions
    return float(np.sum(spectrum.amplitude_m_s2[lines[lines < spectrum.order.size]] ** 2))


def _candidates(
    recording: MeasuredRecording, teeth: int, speed_range_hz: tuple[float, float]
) -> tuple[str, list[np.ndarray]]:
    """Return the clearest channel and the speeds over time that its parts of the range show, and twice those."""
    samples = round(SEARCHED_S * recording.fs_hz)
    found: dict[str, list[MeshRidge]] = {
        name: [mesh_ridge(signal[:samples], recording.fs_hz, teeth, part) for part in range_parts(speed_range_hz)]
        for name, signal in recording.channels.items()
    }
    channel = max(found, key=lambda name: max(ridge.clarity for ridge in found[name]))
    clearest = max(ridge.clarity for ridge in found[channel])
    if clearest < LEAST_CLARITY:
        raise UsageError(
            f"no mesh line stands above the noise within {speed_range_hz[0]:g} to {speed_range_hz[1]:g} Hz of pinion "
            f"speed (clarity {clearest:.2f}, at least {LEAST_CLARITY:g}). Check range and teeth, or give a tacho."
        )
    clear = [ridge.speed_hz for ridge in found[channel] if ridge.clarity >= CLEAR_ENOUGH * clearest]
    doubled = [2.0 * speeds for speeds in clear if 2.0 * np.median(speeds) <= speed_range_hz[1]]
    distinct: list[np.ndarray] = []
    for speeds in (*clear, *doubled):
        if all(abs(np.median(speeds) / np.median(known) - 1.0) > 0.01 for known in distinct):
            distinct.append(speeds)
    return channel, distinct


def range_parts(speed_range_hz: tuple[float, float]) -> list[tuple[float, float]]:
    """Return overlapping parts of a range, each narrower than one to two.

    Raises
    ------
    UsageError
        If the range is empty or not positive.
    """
    low, high = speed_range_hz
    if not 0.0 < low < high < np.inf:
        raise UsageError(f"speed range: received {low:g} to {high:g} Hz; allowed is 0 < low < high")
    count = int(np.ceil(np.log(high / low) / np.log(PART_RATIO)))
    edges = low * (high / low) ** (np.arange(count + 1) / count)
    return [(float(a), float(min(1.1 * b, high))) for a, b in itertools.pairwise(edges)]
