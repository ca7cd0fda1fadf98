"""Level of a channel's noise in ten bands, measured in the half turn of the pinion in which it is weakest.

What the averages of both shafts leave is noise and motion that differs from turn to turn, such as the strokes of a
damaged tooth on one tooth after another of the mating gear. That motion stands near one angle of the pinion. Noise
stands at all angles. So one half turn, the quietest over all bands together, is left open and the rest is faded out.
Source: derived. Proof that this hides motion and shows noise: docs/understand/audit.md, "Noise or motion".
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from diagnostics.signal.asynchronous_part import band_signal

NOISE_BANDS = 10
LOWEST_NOISE_HZ, HIGHEST_NOISE_SHARE = 100.0, 0.4
OPEN_SHARE = 0.5
"""Part of the turn that is left open, a Hann window."""

SECTORS = 16
FEWEST_ORDERS = SECTORS
"""Narrower bands do not fill all sectors and have no say in which half turn is quiet."""

NOISE_LEVELS = tuple(f"noise_band{k}_db" for k in range(NOISE_BANDS))


def noise_levels(rest: np.ndarray, revolutions: int, bin_hz: float, fs_hz: float) -> dict[str, float]:
    """Return the median power per Hz in bands of equal ratio, in dB; NaN where the record does not reach.

    Parameters
    ----------
    rest : (n,) float64
        What the averages of both shafts leave, in equal steps of angle.
    revolutions : int
        Of the pinion.
    bin_hz : float
        Mean frequency step of its spectrum [Hz].
    fs_hz : float
        Sampling frequency of the record [Hz], which the bands reach up to.
    """
    from scipy import fft

    edges = (np.geomspace(LOWEST_NOISE_HZ, HIGHEST_NOISE_SHARE * fs_hz, NOISE_BANDS + 1) / bin_hz).astype(int).tolist()
    spectrum = fft.rfft(rest)
    every = dict(zip(NOISE_LEVELS, pairwise(edges), strict=True))
    bands = {name: (low, high) for name, (low, high) in every.items() if low < high <= spectrum.size}
    gate = np.tile(quiet_gate(spectrum, list(bands.values()), revolutions, rest.size // revolutions), revolutions)
    power = np.square(np.abs(fft.rfft(rest * gate) / rest.size)) / (float(np.square(gate).mean()) * bin_hz)
    found = dict.fromkeys(NOISE_LEVELS, math.nan)
    for name, (low, high) in bands.items():
        level = float(np.median(power[low:high]))
        found[name] = 10.0 * math.log10(level) if level > 0.0 else math.nan
    return found


def quiet_gate(spectrum: np.ndarray, bands: list[tuple[int, int]], revolutions: int, steps: int) -> np.ndarray:
    """Return a Hann window over the half turn in which all bands together are weakest, (steps,) float64.

    Every band counts by its power over its own mean, so that a strong band does not outvote the others.
    """
    profile = np.zeros(SECTORS)
    for low, high in bands:
        if high - low < FEWEST_ORDERS * revolutions:
            continue
        power = np.square(np.abs(band_signal(spectrum, low, high)))
        sector = (np.arange(power.size) * (revolutions * SECTORS / power.size) % SECTORS).astype(int)
        by_angle = np.bincount(sector, power, SECTORS) / np.bincount(sector, minlength=SECTORS)
        profile += by_angle / (by_angle.mean() or 1.0)
    width = round(OPEN_SHARE * SECTORS)
    running = np.convolve(np.r_[profile, profile[: width - 1]], np.ones(width), "valid")
    middle = (int(np.argmin(running)) + 0.5 * width) / SECTORS
    apart = (np.arange(steps) / steps - middle + 0.5) % 1.0 - 0.5
    return np.where(np.abs(apart) < 0.5 * OPEN_SHARE, 0.5 + 0.5 * np.cos(2.0 * np.pi * apart / OPEN_SHARE), 0.0)
