"""Pulse times of the pinion of a recording: from its tacho, or from the mesh lines in a range of speed of any width.

A range wider than one to two holds several candidates, since a comb of mesh harmonics also fits at twice and at half
the speed. It is searched in parts narrower than that, and the lowest speed among the clear ones is doubled as long as
its odd mesh lines are next to nothing beside the even ones. Source: derived; the search itself is in `tacholess_angle`.
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

NEARLY_AS_CLEAR = 0.5
"""At half the true speed at least every second line stands, so about half of the clarity is left or more."""

LEAST_ODD_SHARE = 0.1
"""Odd over even mesh lines, rms of amplitudes; at half the true speed the odd ones are far sidebands or noise."""

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
        channel, ridge = _clearest(recording, teeth, speed_range_hz)
        signal, speeds = recording.channels[channel], ridge.speed_hz
        pulses = _pulses_around(signal, recording.fs_hz, teeth, speeds)
        while 2.0 * np.median(speeds) <= speed_range_hz[1] and (
            odd_share(signal, recording.fs_hz, teeth, pulses) < LEAST_ODD_SHARE
        ):
            speeds = 2.0 * speeds
            pulses = _pulses_around(signal, recording.fs_hz, teeth, speeds)
    except UsageError as error:
        raise UsageError(f"{recording.path}: {error}") from error
    return ShaftPulses(pulses, channel)


def _pulses_around(signal: np.ndarray, fs_hz: float, teeth: int, speeds_hz: np.ndarray) -> np.ndarray:
    margin = 0.02 * float(speeds_hz.mean())
    return tacholess_pulses(signal, fs_hz, teeth, (float(speeds_hz.min()) - margin, float(speeds_hz.max()) + margin))


def odd_share(signal: np.ndarray, fs_hz: float, teeth: int, pulses_s: np.ndarray) -> float:
    """Return the rms amplitude of the odd mesh lines over that of the even ones, among the first ten in the band."""
    spectrum = order_spectrum(signal, pulses_s, fs_hz, teeth)
    highest = min(LINES_COMPARED, int(0.5 * fs_hz * float(np.diff(pulses_s).min()) / teeth))
    lines = spectrum.amplitude_m_s2[np.arange(1, highest + 1) * teeth * spectrum.revolutions]
    return float(np.sqrt(np.mean(lines[::2] ** 2) / np.mean(lines[1::2] ** 2))) if highest > 1 else np.inf


def _clearest(recording: MeasuredRecording, teeth: int, speed_range_hz: tuple[float, float]) -> tuple[str, MeshRidge]:
    """Return the channel and ridge of the clearest part of the range, the lower speed among nearly equal ones."""
    samples = round(SEARCHED_S * recording.fs_hz)
    found = [
        (name, mesh_ridge(signal[:samples], recording.fs_hz, teeth, part))
        for part in range_parts(speed_range_hz)
        for name, signal in recording.channels.items()
    ]
    clearest = max(ridge.clarity for _, ridge in found)
    if clearest < LEAST_CLARITY:
        raise UsageError(
            f"no mesh line stands above the noise within {speed_range_hz[0]:g} to {speed_range_hz[1]:g} Hz of pinion "
            f"speed (clarity {clearest:.2f}, at least {LEAST_CLARITY:g}). Check range and teeth, or give a tacho."
        )
    near = [entry for entry in found if entry[1].clarity >= NEARLY_AS_CLEAR * clearest]
    lowest = min(float(np.median(ridge.speed_hz)) for _, ridge in near)
    same = [entry for entry in near if float(np.median(entry[1].speed_hz)) < 1.05 * lowest]
    return max(same, key=lambda entry: entry[1].clarity)


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
