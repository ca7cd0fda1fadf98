"""Spectral density between the lines, by octaves: what the path makes of broadband forces, and the sensor's noise.

The median over an octave does not see the lines of gears and shafts, as long as they fill less than half of it, so that
it tells paths, mountings and sensors apart where levels of lines, which differ by resonance from gearbox to gearbox, do
not. Source: derived; the density is that of Welch 1967.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

FLOOR = "noise_floor"
LOWEST_HZ = 100.0
"""Below, rigid motion and unbalance rule."""

RATE_PER_BANDWIDTH = 2.56
"""Sampling rate over the frequency up to which recorders are flat; above, filters decide."""

SEGMENT_S = 0.5
"""2 Hz apart: a line under a Hann window covers some 6 Hz, harmonics of a pinion at 20 Hz or more leave most free."""


def octaves_hz(fs_hz: float) -> list[tuple[float, float]]:
    """Return octaves from 100 Hz up to the bandwidth of a sampling rate; the last may be half an octave short."""
    highest_hz = fs_hz / RATE_PER_BANDWIDTH
    count = max(0, int(np.floor(np.log2(highest_hz / LOWEST_HZ) + 0.5)))
    lows = [LOWEST_HZ * 2.0**k for k in range(count)]
    return [(low, min(2.0 * low, highest_hz)) for low in lows]


def spectral_density(signal: np.ndarray, fs_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies [Hz] and the density per Hz of a signal (n,), 2 Hz apart unless it is shorter than 0.5 s."""
    from scipy.signal import welch

    frequency_hz, density = welch(signal, fs_hz, nperseg=min(signal.size, round(SEGMENT_S * fs_hz)))
    return frequency_hz, density


def noise_floor(channels: Mapping[str, np.ndarray], fs_hz: float) -> dict[str, float]:
    """Return the median spectral density [(m/s^2)^2/Hz] of every octave and channel by name.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Signals [m/s^2] by channel name.
    fs_hz : float
        Sampling frequency [Hz].

    Returns
    -------
    dict of str to float
        `noise_floor_100hz__lid` is the octave from 100 Hz on in channel `lid`.
    """
    found = {}
    for channel, signal in channels.items():
        frequency_hz, density = spectral_density(np.asarray(signal, dtype=np.float64), fs_hz)
        for low_hz, high_hz in octaves_hz(fs_hz):
            inside = density[(frequency_hz >= low_hz) & (frequency_hz < high_hz)]
            found[f"{FLOOR}_{low_hz:g}hz__{channel}"] = float(np.median(inside)) if inside.size else np.nan
    return found
