"""What the audit measures of one channel of a record: realism quantities, indicators, averaged waveform, noise sketch.

Levels in dB are 20 log10 of amplitudes. Sideband k over its mesh line: mean of the two k-th sidebands over the line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from diagnostics.audit.noise_sketch import noise_sketch
from diagnostics.audit.order_lines import OrderLines, noise_density, order_lines
from diagnostics.audit.synchronous_ratio import synchronous_ratio_db
from diagnostics.indicators.energy_ratio import energy_ratio
from diagnostics.indicators.fm4 import fm4
from diagnostics.indicators.kurtosis import kurtosis
from diagnostics.indicators.rms import rms
from diagnostics.indicators.sideband_index import sideband_index
from diagnostics.indicators.sideband_ratio import sideband_ratio
from diagnostics.signal.difference_signal import separated_average
from diagnostics.signal.order_domain import AngleGrid, resample_to_angle

WAVEFORM_HARMONICS = 20
"""Averaged waveforms are kept up to this mesh harmonic and its first sidebands."""

SIDEBAND_HARMONICS, SIDEBAND_ORDERS = 3, 3


@dataclass(frozen=True, slots=True)
class ChannelQuantities:
    """Numbers by name, complex lines (orders,) of the averaged waveform, and the noise sketch (k,) complex64."""

    values: dict[str, float]
    waveform: np.ndarray
    sketch: np.ndarray


def channel_quantities(
    signal: np.ndarray, fs_hz: float, grid: AngleGrid, tacho_s: np.ndarray, teeth: tuple[int, int]
) -> ChannelQuantities:
    """Measure one channel.

    Parameters
    ----------
    signal : (n,) float
        The channel [m/s^2].
    fs_hz : float
        Sampling frequency [Hz].
    grid : AngleGrid
        Angle steps of the record.
    tacho_s : (k,) float64
        Its pulse times.
    teeth : (int, int)
        Teeth of pinion and gear.
    """
    from scipy import fft

    raw = np.asarray(signal, dtype=np.float64)
    turns = resample_to_angle(raw, fs_hz, grid).reshape(grid.revolutions, grid.samples_per_revolution)
    lines = order_lines(turns, float(tacho_s[-1] - tacho_s[0]))
    average = averaged_turn(turns, teeth)
    spectrum = 2.0 * fft.rfft(average) / average.size
    values = {
        "rms": rms(raw),
        "kurtosis": kurtosis(raw),
        "synchronous_ratio_db": synchronous_ratio_db(turns),
        **line_levels(lines, teeth),
        **average_indicators(average, np.abs(spectrum), teeth[0]),
    }
    kept = spectrum[: WAVEFORM_HARMONICS * teeth[0] + 2].astype(np.complex64)
    return ChannelQuantities(values, kept, noise_sketch(raw, fs_hz, turns, grid, tacho_s))


def averaged_turn(turns: np.ndarray, teeth: tuple[int, int]) -> np.ndarray:
    """Return the average over whole hunting periods of the gear where the record holds one, else over all revolutions.

    Over z2 / gcd revolutions what is locked to the gear cancels exactly. Source: McFadden 1987.
    """
    period = teeth[1] // math.gcd(*teeth)
    revolutions = turns.shape[0] // period * period or turns.shape[0]
    return np.asarray(turns[:revolutions].mean(axis=0))


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


def average_indicators(average: np.ndarray, amplitude: np.ndarray, teeth: int) -> dict[str, float]:
    """Return FM4, energy ratio, sideband index and sideband energy ratio of an averaged revolution."""
    parts = separated_average(average, teeth)
    return {
        "fm4": fm4(parts.difference, average),
        "energy_ratio": energy_ratio(parts.difference, parts.regular),
        "sideband_index": sideband_index(amplitude, teeth),
        "sideband_energy_ratio": sideband_ratio(amplitude, teeth, 1, 3),
    }


def level_db(amplitude: float, reference: float) -> float:
    """Return 20 log10(amplitude / reference); NaN where one of them is not positive."""
    return 20.0 * math.log10(amplitude / reference) if amplitude > 0.0 and reference > 0.0 else math.nan
