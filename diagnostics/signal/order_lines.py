"""Lines of a record in the order domain and the noise between them, from its Hann spectrum over whole revolutions.

A line is the largest amplitude within two bins of its order, so that lines near the noise come out too high, as they do
where the ranges of healthy gearboxes were measured. Source: standard literature; noise bandwidth of the Hann window
1.5 bins, derived.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from diagnostics.signal.synchronous_average import hann_weights

REACH_BINS = 2
HANN_NOISE_BINS = 1.5
NOISE_REACH_ORDERS = 8.0
FEWEST_NOISE_BINS = 16


@dataclass(frozen=True, slots=True)
class OrderLines:
    """Hann amplitude spectrum over whole pinion revolutions.

    Attributes
    ----------
    amplitude : (bins,) float64
        Single-sided; a sine of amplitude a at a whole order gives a.
    revolutions : int
        Bins per pinion order.
    bin_hz : float
        Width of a bin at the mean speed [Hz].
    """

    amplitude: np.ndarray
    revolutions: int
    bin_hz: float

    def line(self, order: float) -> float:
        """Return the amplitude of the line at an order: the maximum within two bins; NaN outside the band."""
        centre = round(order * self.revolutions)
        if centre - REACH_BINS < 0 or centre + REACH_BINS >= self.amplitude.size:
            return math.nan
        return float(self.amplitude[centre - REACH_BINS : centre + REACH_BINS + 1].max())


def order_lines(turns: np.ndarray, duration_s: float) -> OrderLines:
    """Return the Hann spectrum of whole revolutions.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        Signal at equal angle steps, one row per revolution.
    duration_s : float
        Time from the first to the last pulse [s].
    """
    from scipy import fft

    samples = turns.size
    amplitude = 4.0 * np.abs(fft.rfft(turns.ravel() * hann_weights(samples))) / samples
    return OrderLines(amplitude, turns.shape[0], 1.0 / duration_s)


def noise_density(lines: OrderLines, teeth: tuple[int, int], harmonic: int = 1) -> float:
    """Return the power density between the lines within 8 orders of a mesh line [unit^2/Hz]; NaN without such bins.

    Parameters
    ----------
    lines : OrderLines
        Spectrum of the record.
    teeth : (int, int)
        Teeth of pinion and gear. Bins within two of a pinion order are left out, and those of the gear's orders too
        where the record is long enough to leave at least 16 bins.
    harmonic : int
        Mesh harmonic, from 1.
    """
    centre = harmonic * teeth[0]
    first, last = (round((centre + side * NOISE_REACH_ORDERS) * lines.revolutions) for side in (-1, 1))
    bins = np.arange(max(first, 0), min(last, lines.amplitude.size - 1) + 1)
    order = bins / lines.revolutions
    between = _distance_bins(order, 1.0, lines.revolutions) > REACH_BINS
    fine = between & (_distance_bins(order, teeth[0] / teeth[1], lines.revolutions) > REACH_BINS)
    kept = fine if np.count_nonzero(fine) >= FEWEST_NOISE_BINS else between
    if not kept.any():
        return math.nan
    power = 0.5 * float(np.mean(np.square(lines.amplitude[bins[kept]])))
    return power / (HANN_NOISE_BINS * lines.bin_hz)


def _distance_bins(order: np.ndarray, spacing: float, revolutions: int) -> np.ndarray:
    """Return how many bins each order lies away from the nearest multiple of a spacing."""
    return np.asarray(np.abs(order - np.round(order / spacing) * spacing) * revolutions)
