"""Spectral kurtosis over short spectra: how impulsive the signal is in each frequency band.

SK(f) = <|X|^4> / <|X|^2>^2 - 2 over frames: 0 for stationary Gaussian noise, -1 for a steady tone, positive for
impulses. Source: Antoni 2006; MATLAB's `pkurtosis` takes the same formula.
"""

from __future__ import annotations

import numpy as np

from diagnostics.signal.spectrum import power
from siggen.errors import UsageError

FRAME_SAMPLES = 512
"""10 ms at 51.2 kHz, bands of 100 Hz: shorter than half a revolution at 30 Hz, so a once-per-revolution event stands
out."""

FEWEST_FRAMES = 8
FRAMES_AT_ONCE = 64
"""What is made of so many frames stays in the second cache."""


def spectral_kurtosis(signal: np.ndarray, frame_samples: int = FRAME_SAMPLES) -> np.ndarray:
    """Return SK at the frame's frequencies, (frame_samples // 2 + 1,); NaN where a band is empty.

    Parameters
    ----------
    signal : (n,) float64
        The record, in equal steps of time.
    frame_samples : int
        Samples per Hann frame; frames overlap by half, so the number of frames is about 2 n / frame_samples.

    Raises
    ------
    UsageError
        If the record holds fewer than eight frames.
    """
    from scipy import fft

    hop = frame_samples // 2
    if signal.size < (FEWEST_FRAMES + 1) * hop:
        raise UsageError(
            f"spectral kurtosis: received {signal.size} samples; {FEWEST_FRAMES} frames of {frame_samples} samples "
            f"need {(FEWEST_FRAMES + 1) * hop}. Use longer records or shorter frames."
        )
    frames = np.lib.stride_tricks.sliding_window_view(signal, frame_samples)[::hop]
    weights = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(frame_samples) / frame_samples)
    mean, square = np.zeros(hop + 1), np.zeros(hop + 1)
    for first in range(0, len(frames), FRAMES_AT_ONCE):
        found = power(fft.rfft(frames[first : first + FRAMES_AT_ONCE] * weights, axis=1))
        mean += found.sum(axis=0) / len(frames)
        square += np.square(found).sum(axis=0) / len(frames)
    empty = mean <= 1e-24 * mean.max(initial=0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(empty, np.nan, square / mean**2 - 2.0))
