"""OddReference: a healthy recording that is unlike the others: of another unit, sensor place, machine or load.

Two recordings are as far apart as their levels in third octaves are (rms over bands, of the channel that differs most).
Recordings hang together that no more than a limit parts, directly or over others; what is not in the largest such group
is odd. Source: derived; the limits stand on docs/start/check_a_machine.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import log

import numpy as np

from diagnostics.machine.comparable import SPEED_RATIO
from diagnostics.recordings.measured_recording import MeasuredRecording

NEAR_DB, FAR_DB = 6.0, 15.0
"""Between recordings at one speed, and at different ones: modes then move lines of a healthy machine by up to 12 dB."""
SPREADS = 2.0
"""Limit over the median distance to the nearest other recording: machines that repeat badly have a wider one."""
LOWEST_HZ, USED_BAND = 20.0, 1.0 / 2.56
"""Lowest band, and the share of the sampling rate that recorders pass whole."""
FEWEST_NEAR = 3
"""References at one speed that tell which of them is odd."""
FEWEST_BINS = 3
"""Of the spectrum in a band."""
SILENCE = 1e-30
LISTED = 5


@dataclass(frozen=True, slots=True)
class OddReference:
    """Which reference, its channel that differs most, and how far the nearest of the others is [dB]."""

    index: int
    channel: str
    distance_db: float


def third_octave_levels(recording: MeasuredRecording, most_hz: float, seconds: float) -> np.ndarray:
    """Return levels (channels, bands) [dB re 1 m/s^2] of the first seconds, up to a frequency; NaN in narrow bands."""
    size = round(seconds * recording.fs_hz)
    signals = np.stack([signal[:size] for signal in recording.channels.values()])
    weights = np.hanning(signals.shape[1])
    centred = signals - signals.mean(axis=1, keepdims=True)
    power = 2.0 * np.abs(np.fft.rfft(centred * weights)) ** 2 / (signals.shape[1] * (weights**2).sum())
    frequency_hz = np.fft.rfftfreq(signals.shape[1], 1.0 / recording.fs_hz)
    edges_hz = LOWEST_HZ * 2.0 ** (np.arange(1 + int(3.0 * np.log2(most_hz / LOWEST_HZ))) / 3.0)
    found = np.full((len(signals), edges_hz.size - 1), np.nan)
    for k, (low, high) in enumerate(pairwise(edges_hz)):
        inside = (frequency_hz >= low) & (frequency_hz < high)
        if np.count_nonzero(inside) >= FEWEST_BINS:
            found[:, k] = 10.0 * np.log10(power[:, inside].sum(axis=1) + SILENCE)
    return found


def odd_references(levels: np.ndarray, speed_hz: np.ndarray, channels: Sequence[str]) -> tuple[OddReference, ...]:
    """Return the references that are unlike the others, in their order.

    Parameters
    ----------
    levels : (references, channels, bands) float64
        Of `third_octave_levels`.
    speed_hz : (references,) float64
    channels : sequence of str
    """
    by_channel = np.sqrt(np.nanmean((levels[:, None] - levels[None]) ** 2, axis=3))
    distance = by_channel.max(axis=2)
    near = np.abs(np.log(speed_hz[:, None] / speed_hz)) <= log(SPEED_RATIO)
    typical = float(np.median((distance + np.diag(np.full(len(distance), np.inf))).min(axis=1)))
    linked = distance <= np.maximum(np.where(near, NEAR_DB, FAR_DB), SPREADS * typical)
    odd = _outside(linked)
    for k, beside in enumerate(near):  # at its own speed a reference has the narrower limit
        if np.count_nonzero(beside) >= FEWEST_NEAR:
            odd[k] |= _outside(linked[np.ix_(beside, beside)])[np.count_nonzero(beside[:k])]
    return tuple(_odd(int(k), np.flatnonzero(~odd), by_channel, channels) for k in np.flatnonzero(odd))


def odd_sentences(odd: Sequence[OddReference], references: Sequence[str]) -> list[str]:
    """Return one sentence per odd reference, and how many more there are."""
    found = [
        f"reference {one.index + 1} of {len(references)}, {references[one.index]}, is unlike the others: third octaves "
        f"of {one.channel} are {one.distance_db:.0f} dB off the nearest one. Is it of this machine, sensor place, unit "
        "and load? If not, leave it out of `baseline`."
        for one in odd[:LISTED]
    ]
    return found + ([f"{len(odd) - LISTED} more references are unlike the others."] if len(odd) > LISTED else [])


def _outside(linked: np.ndarray) -> np.ndarray:
    """Return which nodes of a symmetric graph (n, n) lie outside of its largest connected part."""
    from scipy.sparse.csgraph import connected_components

    _, part = connected_components(linked, directed=False)
    return np.asarray(part != np.bincount(part).argmax())


def _odd(k: int, others: np.ndarray, by_channel: np.ndarray, channels: Sequence[str]) -> OddReference:
    nearest = others[by_channel[k, others].max(axis=1).argmin()]
    worst = int(by_channel[k, nearest].argmax())
    return OddReference(k, channels[worst], float(by_channel[k, nearest, worst]))
