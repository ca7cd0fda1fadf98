"""The shape of the change of a spectrum from the reference: what a filter, an amplifier or a resonance alters.

Each of 64 equal bands has its median power over frames of 256 samples, 10 ms at 25.6 kHz: strokes of one tooth are in
few of them, and no line is alone in so wide a band. The change from the reference less its median over the bands is a
shape: its slope, its first cosines, and means over 16 and 32 bands; of every channel, and of all together, since one
program treats all. Source: derived; medians of short frames scatter by 0.05 dB, those of single lines by 0.5 dB.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

FRAME, BANDS = 256, 64
LOWEST, COSINES = 8, 4
"""Bands of slope and cosines begin above an eighth of the whole, where lines of the mesh are strong; cosines."""

MERGED = (16, 32)
TINY = 1e-30


def floor_levels(signal: np.ndarray) -> np.ndarray:
    """Return the median power of equal bands up to half the rate, (64,) float32 [dB], of samples (n,) float64."""
    from scipy import fft

    if signal.size < FRAME:
        return np.full(BANDS, np.nan, np.float32)
    frames = np.lib.stride_tricks.sliding_window_view(signal, FRAME)[:: FRAME // 2] * np.hanning(FRAME)
    power = np.square(np.abs(fft.rfft(frames, axis=1)))[:, 1:]
    decibels = 10.0 * np.log10(np.median(power, axis=0) + TINY)
    return np.asarray(decibels.reshape(BANDS, -1).mean(axis=1), dtype=np.float32)


def shape_changes(floors: Mapping[str, np.ndarray], reference: np.ndarray) -> dict[str, np.ndarray]:
    """Return the numbers of the shape of every record's change, by name, (records,) each [dB].

    Parameters
    ----------
    floors : mapping of str to (records, 64) float32
        By channel, as of `floor_levels`.
    reference : (records,) int
        Row of the record that each stands beside; of those without one (-1) numbers mean nothing.
    """
    changes = {name: (own - own[reference]).astype(np.float64) for name, own in floors.items()}
    if len(changes) > 1:
        changes["all channels"] = np.mean(list(changes.values()), axis=0)
    return {f"{what} of {name}": v for name, own in changes.items() for what, v in _numbers(own).items()}


def _numbers(change: np.ndarray) -> dict[str, np.ndarray]:
    middle = np.median(change, axis=1, keepdims=True)
    shape = change - middle
    high, share = shape[:, LOWEST:], (np.arange(BANDS - LOWEST) + 0.5) / (BANDS - LOWEST)
    found = {"change of the floor": middle[:, 0], "slope of the floor": 12.0 * np.mean(high * (share - 0.5), axis=1)}
    for turns in range(1, COSINES + 1):
        found[f"cosine {turns} of the floor"] = np.mean(high * np.cos(np.pi * turns * share), axis=1)
    for bands in MERGED:
        merged = shape.reshape(len(shape), bands, -1).mean(axis=2)
        found |= {f"floor in band {k + 1} of {bands}": merged[:, k] for k in range(bands)}
    return found
