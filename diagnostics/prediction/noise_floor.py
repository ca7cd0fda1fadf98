"""Spectral density between the lines, by octaves: what the path makes of broadband forces, and the sensor's noise.

The median over an octave does not see the lines of gears and shafts, as long as they fill less than half of it, so that
it tells paths, mountings and sensors apart where levels of lines, which differ by resonance from gearbox to gearbox, do
not. Source: derived; the density is that of Welch 1967.

How rough the density between the lines is over frequency, and how far channels differ in it: damping and modes.

Behind modes of a few per cent damping the density rises and falls by some nepers within an octave; where damping is
heavy it is smooth, and behind one mode alone it is the same curve in all channels. Neither moves levels by octaves.
White noise leaves the scatter of the estimate, which depends on length and rate alone, which pieces share with
training records. Source: derived; the density is that of Welch 1967.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from diagnostics.signal.spectrum import power

Densities = Mapping[str, tuple[np.ndarray, np.ndarray]]
"""Frequencies [Hz] and density per Hz of every channel."""

ROUGHNESS = "floor_roughness"
DIFFERENCE = "floor_difference"

BAND_HZ = (450.0, 1154.0)
"""Above rigid motion on the bolts and below the shafts on their bearings, where modes of the housing rule."""

BIN_HZ = 32.0
"""About one order of a pinion, so that every bin has room between lines; a mode of 2 % at 800 Hz is as wide."""

QUANTILE = 0.3
"""Below the median, since lines of both shafts may fill half a bin."""

LEAST_IN_BIN = 4

FLOOR = "noise_floor"
LOWEST_HZ = 100.0
"""Below, rigid motion and unbalance rule."""

RATE_PER_BANDWIDTH = 2.56
"""Sampling rate over the frequency up to which recorders are flat; above, filters decide."""

SEGMENT_S = 0.5
"""2 Hz apart: a line under a Hann window covers some 6 Hz, harmonics of a pinion at 20 Hz or more leave most free."""


def _roughness(fs_hz: float, densities: Densities) -> dict[str, float]:
    """Return roughness and difference of the noise floor [Np]; nothing where rate or length do not reach for it.

    `floor_roughness`: root mean square, over bins and channels, of the log density off its straight line over log
    frequency. `floor_difference`, of two channels or more: of the log density off the mean over channels, each
    channel's own mean taken off, so that gains do not count.
    """
    if fs_hz / RATE_PER_BANDWIDTH < BAND_HZ[1]:
        return {}
    found = [_log_floor(*density) for density in densities.values()]
    if not all(floor.size for floor in found):
        return {}
    level = np.array([floor - floor.mean() for floor in found])
    centre_hz = BAND_HZ[0] + BIN_HZ * (np.arange(level.shape[1]) + 0.5)
    x = np.log(centre_hz) - np.log(centre_hz).mean()
    rough = level - np.outer(level @ x / (x @ x), x)
    values = {ROUGHNESS: float(np.sqrt(np.mean(rough**2)))}
    if len(level) > 1:
        values[DIFFERENCE] = float(np.sqrt(np.mean((level - level.mean(axis=0)) ** 2)))
    return values


def floor_features(channels: Mapping[str, np.ndarray], fs_hz: float) -> dict[str, float]:
    """Return what distances take from between the lines: `noise_floor` and `floor_roughness`.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Signals [m/s^2] by channel name.
    fs_hz : float
        Sampling frequency [Hz].
    """
    densities = {name: spectral_density(np.asarray(x, dtype=np.float64), fs_hz) for name, x in channels.items()}
    return _medians(fs_hz, densities) | _roughness(fs_hz, densities)


def _log_floor(frequency_hz: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Return the log of a low quantile of the density in every bin of the band; empty where bins hold too little."""
    edges = np.arange(BAND_HZ[0], BAND_HZ[1] + 0.5 * BIN_HZ, BIN_HZ)
    ends = np.searchsorted(frequency_hz, edges - 1e-6)
    if np.diff(ends).min() < LEAST_IN_BIN:
        return np.empty(0)
    lows = [np.quantile(density[a:b], QUANTILE) for a, b in itertools.pairwise(ends)]
    return np.asarray(np.log(np.maximum(lows, np.finfo(np.float64).tiny)))


def octaves_hz(fs_hz: float) -> list[tuple[float, float]]:
    """Return octaves from 100 Hz up to the bandwidth of a sampling rate; the last may be half an octave short."""
    highest_hz = fs_hz / RATE_PER_BANDWIDTH
    count = max(0, int(np.floor(np.log2(highest_hz / LOWEST_HZ) + 0.5)))
    lows = [LOWEST_HZ * 2.0**k for k in range(count)]
    return [(low, min(2.0 * low, highest_hz)) for low in lows]


def spectral_density(signal: np.ndarray, fs_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies [Hz] and the density per Hz of a signal (n,), 2 Hz apart unless it is shorter than 0.5 s.

    Welch's method as of `scipy.signal.welch`, which takes most of a second to load: Hann windows that overlap by half,
    each without its mean.
    """
    from scipy import fft

    size = min(signal.size, round(SEGMENT_S * fs_hz))
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(size) / size)
    pieces = np.lib.stride_tricks.sliding_window_view(signal, size)[:: size - size // 2]
    lines = fft.rfft((pieces - pieces.mean(axis=1, keepdims=True)) * window, axis=1)
    density = power(lines).mean(axis=0) / (fs_hz * float(window @ window))
    density[1 : (size + 1) // 2] *= 2.0
    return np.arange(density.size) * (fs_hz / size), density


def _medians(fs_hz: float, densities: Densities) -> dict[str, float]:
    """Return the median spectral density [(m/s^2)^2/Hz] of every octave and channel by name.

    `noise_floor_100hz__lid` is the octave from 100 Hz on in channel `lid`.
    """
    found = {}
    for channel, (frequency_hz, density) in densities.items():
        for low_hz, high_hz in octaves_hz(fs_hz):
            inside = density[(frequency_hz >= low_hz) & (frequency_hz < high_hz)]
            found[f"{FLOOR}_{low_hz:g}hz__{channel}"] = float(np.median(inside)) if inside.size else np.nan
    return found
