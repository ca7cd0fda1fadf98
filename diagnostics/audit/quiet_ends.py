"""Level of the lowest and the highest bins of raw records, where machines leave noise alone; what channels share there.

Below 8 Hz no shaft turns, and in the last thirty-second below half the rate converters have filtered lines away. What
channels share there is the mean product of their spectra, over blocks of bins, each divided by its own level: two
channels with a noise of their own share nothing. Source: derived.
"""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np

LOW_HZ, HIGH_PARTS = 8.0, 32
SHARED_PARTS = (8, 16, 32)
"""Parts of the band at whose last ones channels are compared."""

BLOCK, FEWEST_BINS = 50, 4
TINY = 1e-30


def quiet_ends(channels: dict[str, np.ndarray], fs_hz: float) -> dict[str, float]:
    """Return levels [dB] and what channels share, -1 to 1, by name; undefined where a record is too short.

    Parameters
    ----------
    channels : dict of str to (n,) float64
    fs_hz : float
        Sampling frequency [Hz].
    """
    from scipy import fft

    spectra = {name: fft.rfft((x - x.mean()) * np.hanning(x.size))[1:-1] for name, x in channels.items()}
    found = {}
    for name, lines in spectra.items():
        low = lines[: int(LOW_HZ * channels[name].size / fs_hz)]
        found[f"level below {LOW_HZ:g} Hz of {name}"] = _level(low)
        found[f"level of the highest bins of {name}"] = _level(lines[-(lines.size // HIGH_PARTS) :])
    for first, second in combinations(spectra, 2):
        for parts in SHARED_PARTS if spectra[first].size == spectra[second].size else ():
            kept = slice(-(spectra[first].size // parts), None)
            name = f"last 1/{parts} of the band that {first} and {second} share"
            found[name] = _shared(spectra[first][kept], spectra[second][kept])
    return found


def _level(lines: np.ndarray) -> float:
    """Return the mean level of lines in dB, by logarithms, so that no line rules it."""
    if lines.size < FEWEST_BINS:
        return math.nan
    return float(np.mean(10.0 * np.log10(np.square(np.abs(lines)) / lines.size + TINY)))


def _shared(first: np.ndarray, second: np.ndarray) -> float:
    blocks = first.size // BLOCK
    if not blocks:
        return math.nan
    own, other = (lines[-blocks * BLOCK :].reshape(blocks, BLOCK) for lines in (first, second))
    product = (own * other.conj()).real.mean(axis=1)
    size = np.sqrt(np.square(np.abs(own)).mean(axis=1) * np.square(np.abs(other)).mean(axis=1))
    return float(np.mean(product / (size + TINY)))
