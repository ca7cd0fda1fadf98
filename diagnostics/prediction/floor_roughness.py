"""How rough the density between the lines is over frequency, and how far channels differ in it: damping and modes.

Behind modes of a few per cent damping the density rises and falls by some nepers within an octave; where damping is
heavy it is smooth, and behind one mode alone it is the same curve in all channels. Neither moves levels by octaves.
White noise leaves the scatter of the estimate, which depends on length and rate alone, which pieces share with
training records. Source: derived; the density is that of Welch 1967.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np

from diagnostics.prediction.noise_floor import RATE_PER_BANDWIDTH, noise_floor, spectral_density

ROUGHNESS = "floor_roughness"
DIFFERENCE = "floor_difference"

BAND_HZ = (450.0, 1154.0)
"""Above rigid motion on the bolts and below the shafts on their bearings, where modes of the housing rule."""

BIN_HZ = 32.0
"""About one order of a pinion, so that every bin has room between lines; a mode of 2 % at 800 Hz is as wide."""

QUANTILE = 0.3
"""Below the median, since lines of both shafts may fill half a bin."""

LEAST_IN_BIN = 4


def floor_roughness(channels: Mapping[str, np.ndarray], fs_hz: float) -> dict[str, float]:
    """Return roughness and difference of the noise floor [Np]; nothing where rate or length do not reach for it.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Signals by channel name.
    fs_hz : float
        Sampling frequency [Hz].

    Returns
    -------
    dict of str to float
        `floor_roughness`: root mean square, over bins and channels, of the log density off its straight line over log
        frequency. `floor_difference`, of two channels or more: of the log density off the mean over channels, each
        channel's own mean taken off, so that gains do not count.
    """
    if fs_hz / RATE_PER_BANDWIDTH < BAND_HZ[1]:
        return {}
    found = [_log_floor(np.asarray(signal, dtype=np.float64), fs_hz) for signal in channels.values()]
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
    """Return what distances take from between the lines: `noise_floor` and `floor_roughness`."""
    return noise_floor(channels, fs_hz) | floor_roughness(channels, fs_hz)


def _log_floor(signal: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return the log of a low quantile of the density in every bin of the band; empty where bins hold too little."""
    frequency_hz, density = spectral_density(signal, fs_hz)
    edges = np.arange(BAND_HZ[0], BAND_HZ[1] + 0.5 * BIN_HZ, BIN_HZ)
    ends = np.searchsorted(frequency_hz, edges - 1e-6)
    if np.diff(ends).min() < LEAST_IN_BIN:
        return np.empty(0)
    lows = [np.quantile(density[a:b], QUANTILE) for a, b in itertools.pairwise(ends)]
    return np.asarray(np.log(np.maximum(lows, np.finfo(np.float64).tiny)))
