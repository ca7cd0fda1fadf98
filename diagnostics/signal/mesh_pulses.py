"""Pulse times of the pinion without a tacho, at a speed that is certain.

The speed in the range that most speaks for is taken if it is certain enough (see `speed_search`); two speeds of which
neither is certain are refused, and so is a range outside of which lines fit far better.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from diagnostics.signal.speed_search import NARROW_RATIO, SpeedFound, pulses_of, speed_search
from siggen.errors import UsageError

CERTAIN = 0.95
"""Certainty below which no speed is taken; docs/scripts/speed_machines.py counts how often it is kept."""

CONTESTED = 0.1
"""Certainty of two speeds together from which they compete; below it nothing stands above the noise."""


@dataclass(frozen=True, slots=True)
class MeshPulses:
    """Pulse times (k,) [s] of the pinion, the channel whose mesh lines led, and the certainty of the speed (0 to 1)."""

    times_s: np.ndarray
    channel: str
    certainty: float


def mesh_pulses(
    channels: Mapping[str, np.ndarray], fs_hz: float, teeth: tuple[int, int], speed_range_hz: tuple[float, float]
) -> MeshPulses:
    """Return the pulses of the pinion from the lines of both shafts.

    Parameters
    ----------
    channels : mapping of str to (n,) float64
        Signals by channel.
    fs_hz : float
        Sampling frequency [Hz].
    teeth : (int, int)
        Of pinion and gear.
    speed_range_hz : (float, float)
        Slowest and fastest pinion speed [Hz].

    Raises
    ------
    UsageError
        If the range is empty, the signals are too short or sampled too slowly, or no speed is certain.
    """
    found = speed_search(channels, fs_hz, teeth, speed_range_hz)
    if found.certainty < CERTAIN:
        # a louder stage leads in a wide part that holds both; a narrow part holds one of them alone
        narrow = speed_search(channels, fs_hz, teeth, speed_range_hz, NARROW_RATIO)
        found = max(found, narrow, key=lambda one: one.evidence)
    if found.certainty < CERTAIN:
        raise UsageError(_uncertain(found, speed_range_hz))
    channel, pulses_s = pulses_of(channels, fs_hz, found)
    return MeshPulses(pulses_s, channel, found.certainty)


def _uncertain(found: SpeedFound, speed_range_hz: tuple[float, float]) -> str:
    low, high = speed_range_hz
    rival, share = found.rivals[0] if found.rivals else (0.0, 0.0)
    if share > found.certainty and not low <= rival <= high:
        return (
            f"the lines fit {rival:.4g} Hz of the first shaft best, outside of {low:g} to {high:g} Hz "
            f"({found.speed_hz:.4g} Hz inside). Check range and teeth, or give a tacho."
        )
    if share > 0.1 * found.certainty and share + found.certainty > CONTESTED:
        return (
            f"speeds of {found.speed_hz:.4g} ({found.certainty:.0%}) and {rival:.4g} Hz ({share:.0%}) are not told "
            f"apart; allowed is a certainty of {CERTAIN:.0%}. Give a narrower range, a longer recording or a "
            "tacho."
        )
    return (
        f"no lines of these shafts stand above the noise within {low:g} to {high:g} Hz of the first shaft (best "
        f"{found.speed_hz:.4g} Hz, certain to {found.certainty:.0%}; allowed is {CERTAIN:.0%}). Check range and teeth, "
        "give a longer recording or a tacho."
    )
