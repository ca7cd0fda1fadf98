"""A short fingerprint of the noise of a channel: phases of the spectrum of what is left without its synchronous parts.

Two signals that hold the same noise samples, whatever their gain and gears, have the same phases; independent noise has
independent ones, so that the mean product of two sketches of k phases scatters around zero by about 1/sqrt(k). Source:
phase-only correlation, standard literature.
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.order_domain import AngleGrid

SEGMENT_SAMPLES = 4096
PHASES = 1024
SMALLEST_SHARE = 1e-5
"""What is left below this share of the signal's rms is rounding and interpolation, not noise."""


def noise_sketch(
    signal: np.ndarray, fs_hz: float, average: np.ndarray, grid: AngleGrid, tacho_s: np.ndarray
) -> np.ndarray:
    """Return unit phases (1024,) complex64 of the residual of the first 4096 samples between pulses, or empty.

    Parameters
    ----------
    signal : (n,) float64
        The channel.
    fs_hz : float
        Sampling frequency [Hz].
    average : (steps,) float64
        Synchronous average of the pinion in this channel.
    grid : AngleGrid
        Times of the angle steps.
    tacho_s : (k,) float64
        Pulse times.

    Notes
    -----
    The segment is cut at fixed samples, not at fixed angles, because copied noise has the same sample index. Empty
    where the record is too short or holds no noise.
    """
    from scipy import fft

    first = int(0.25 * signal.size)
    piece = signal[first : first + SEGMENT_SAMPLES]
    time_s = (first + np.arange(piece.size)) / fs_hz
    if piece.size < SEGMENT_SAMPLES or time_s[0] < tacho_s[0] or time_s[-1] > tacho_s[-1] or grid.revolutions < 4:
        return np.empty(0, dtype=np.complex64)
    turn = np.interp(time_s, grid.time_s, np.arange(grid.time_s.size) / grid.samples_per_revolution)
    left = piece - _periodic(average, turn)
    if float(left.std()) < SMALLEST_SHARE * float(np.sqrt(np.mean(np.square(signal)))):
        return np.empty(0, dtype=np.complex64)
    # the upper half of the band, where what is locked to the gear is weakest
    spectrum = fft.rfft(left * np.hanning(left.size))[-PHASES:]
    size = np.abs(spectrum)
    return np.asarray(spectrum / np.where(size > 0, size, 1.0), dtype=np.complex64)


def _periodic(average: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Return an averaged revolution at given turns, by a periodic cubic spline."""
    from scipy.ndimage import map_coordinates

    position = (turn % 1.0) * average.size
    return np.asarray(map_coordinates(average, position[None, :], order=3, mode="grid-wrap"))
