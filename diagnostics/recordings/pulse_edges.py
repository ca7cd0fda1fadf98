"""Times of a tacho's pulses from its sampled waveform. Source: standard literature (level crossing with hysteresis)."""

from __future__ import annotations

import numpy as np

HYSTERESIS = 0.2
"""Share of the swing that the waveform must fall below the middle before the next rise counts."""


def pulse_edges(waveform: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return the times of rising edges through the middle of the swing, (k,) [s], interpolated between samples.

    Parameters
    ----------
    waveform : (n,) float
        Voltage or logic level of the tacho.
    fs_hz : float
        Sampling frequency [Hz].
    """
    low, high = np.quantile(waveform, [0.001, 0.999])
    if not high > low:
        return np.empty(0)
    middle, reset = 0.5 * (low + high), 0.5 * (low + high) - HYSTERESIS * (high - low)
    # +1 above the middle, -1 below the reset level, in between the last of both holds
    level = np.where(waveform >= middle, 1, np.where(waveform < reset, -1, 0))
    last = np.maximum.accumulate(np.where(level != 0, np.arange(level.size), 0))
    held = level[last]
    after = np.flatnonzero((held[1:] == 1) & (held[:-1] == -1)) + 1
    step = waveform[after] - waveform[after - 1]
    share = np.where(step > 0, (middle - waveform[after - 1]) / np.where(step > 0, step, 1.0), 1.0)
    return np.asarray((after - 1 + np.clip(share, 0.0, 1.0)) / fs_hz)
