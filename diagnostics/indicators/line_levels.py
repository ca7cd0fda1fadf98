"""Levels of lines and noise of one channel in dB, which the audit compares with measured healthy gearboxes.

Levels are 20 log10 of amplitudes. Sideband k over its mesh line: mean of the two k-th sidebands over the line. A line
is the largest amplitude within two bins, as where the ranges were measured; indicators read whole orders of averages.

Synchronous signal-to-noise ratio: variance of averages over ten revolutions against what they leave.

An average over m revolutions keeps 1/m of the variance of the rest, which is taken off: without that correction pure
noise would show 1/(m - 1). Source: derived.
"""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.background_levels import BACKGROUND_LEVELS, background_levels
from diagnostics.signal.spectrum import OrderLines, noise_density

REVOLUTIONS_AVERAGED = 10

SIDEBAND_HARMONICS, SIDEBAND_ORDERS = 3, 3
LEVELS = (
    *("synchronous_ratio_db", "sideband1_db", "sideband2_db", "asymmetry_db"),
    *(f"harmonic{h}_db" for h in (2, 3, 4, 5)),
    *("noise_density_db", "strongest_sideband_db"),
    *BACKGROUND_LEVELS,
)


def synchronous_ratio_db(turns: np.ndarray) -> float:
    """Return 10 log10 of synchronous over remaining variance [dB]; NaN where nothing is synchronous or nothing remains.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        Signal at equal angle steps, one row per revolution.
    """
    size = min(REVOLUTIONS_AVERAGED, turns.shape[0])
    if size < 2:
        return math.nan
    groups = turns[: turns.shape[0] // size * size].reshape(-1, size, turns.shape[1])
    average = groups.mean(axis=1)
    # sum of squares about the average = whole sum minus size * average^2, without a copy of the record
    rest = (float(np.square(groups).sum()) - size * float(np.square(average).sum())) / (average.size * (size - 1))
    signal = float(np.mean(np.square(average - average.mean(axis=1, keepdims=True)))) - rest / size
    if signal <= 0.0 or rest <= 1e-24 * signal:
        return math.nan
    return 10.0 * math.log10(signal / rest)


def record_levels(turns: np.ndarray, lines: OrderLines, teeth: tuple[int, int], fs_hz: float) -> dict[str, float]:
    """Return all levels of one channel.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        The channel at equal angle steps, one row per pinion revolution.
    lines : OrderLines
        Its Hann spectrum.
    teeth : (int, int)
        Teeth of pinion and gear.
    fs_hz : float
        Sampling frequency [Hz].
    """
    return {
        "synchronous_ratio_db": synchronous_ratio_db(turns),
        **line_levels(lines, teeth),
        **background_levels(turns, turns.shape[0] * lines.bin_hz, teeth, fs_hz),
    }


def line_levels(lines: OrderLines, teeth: tuple[int, int]) -> dict[str, float]:
    """Return sidebands, asymmetry, mesh harmonics and noise of the Hann spectrum over whole revolutions."""
    mesh = teeth[0]
    first = lines.line(mesh)
    upper, lower = lines.line(mesh + 1), lines.line(mesh - 1)
    density = noise_density(lines, teeth)
    return {
        "sideband1_db": level_db(0.5 * (upper + lower), first),
        "sideband2_db": level_db(0.5 * (lines.line(mesh + 2) + lines.line(mesh - 2)), first),
        "asymmetry_db": level_db(upper, lower),
        **{f"harmonic{h}_db": level_db(lines.line(h * mesh), first) for h in (2, 3, 4, 5)},
        "noise_density_db": 10.0 * math.log10(density / (0.5 * first**2)) if density > 0 and first > 0 else math.nan,
        "strongest_sideband_db": strongest_sideband_db(lines, teeth),
    }


def strongest_sideband_db(lines: OrderLines, teeth: tuple[int, int]) -> float:
    """Return the strongest pinion sideband of mesh 1-3 over its mesh line that stands 10 dB above the noise [dB].

    Minus infinity where none does: then the record has no sidebands that anybody could see. Noise alone exceeds ten
    times its mean power in one bin with probability exp(-10).
    """
    best = -math.inf
    for harmonic in range(1, SIDEBAND_HARMONICS + 1):
        floor = noise_density(lines, teeth, harmonic) * 1.5 * lines.bin_hz
        line = lines.line(harmonic * teeth[0])
        for offset in (k * sign for k in range(1, SIDEBAND_ORDERS + 1) for sign in (-1, 1)):
            amplitude = lines.line(harmonic * teeth[0] + offset)
            if 0.5 * amplitude**2 > 10.0 * (floor if math.isfinite(floor) else 0.0):
                best = max(best, level_db(amplitude, line))
    return best


def level_db(amplitude: float, reference: float) -> float:
    """Return 20 log10(amplitude / reference); NaN where one of them is not positive."""
    return 20.0 * math.log10(amplitude / reference) if amplitude > 0.0 and reference > 0.0 else math.nan
