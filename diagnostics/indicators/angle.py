"""Indicators that only signals of angles have: lines of shafts, ripple of the speed, level about the mean.

Accelerations hold no usable line at the first shaft orders, and no mean: their channels do not have these columns.
"""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import BOOK, OF_CHANNEL, indicator, only_of
from diagnostics.records.channel_quantities import ANGULAR_SPEED, TRANSMISSION_ERROR
from diagnostics.signal.shaft_lines import band_rms
from diagnostics.signal.spectrum import HANN_HALF_WIDTH_BINS

OF_ANGLES = (ANGULAR_SPEED, TRANSMISSION_ERROR)


@only_of(*OF_ANGLES)
@indicator(
    "rms_without_mean",
    "RMS about the mean",
    signal="record of a speed or transmission error",
    formula="sqrt(mean (x − mean x)²)",
    unit=OF_CHANNEL,
    known="mean and sine: A/√2",
    undefined="never",
    source=BOOK,
)
def rms_without_mean(signal: np.ndarray) -> float:
    """Return the standard deviation of a record: the rms of a speed is its mean. Source: standard literature."""
    return float(signal.std())


@only_of(*OF_ANGLES)
@indicator(
    "shaft_amplitude_{shaft}_k{shaft_order}",
    "Amplitude at a shaft order",
    signal="speed or transmission error over M whole revolutions, Hann window, bins of 1/M order",
    formula="A(k), k = 1 … 3",
    unit=OF_CHANNEL,
    known="A cos(k θ): A; white noise over n steps: σ √(6/n) in rms",
    undefined="the mean or an order 1 to 3 of the other shaft lies within 2/M orders",
    source=BOOK,
)
def shaft_amplitude(shaft_lines: np.ndarray, shaft_order: int) -> float:
    """Return the amplitude at a whole order of a shaft, as of `shaft_lines`; NaN where it is not resolved."""
    return float(shaft_lines[shaft_order])


@only_of(ANGULAR_SPEED)
@indicator(
    "speed_ripple",
    "Speed ripple",
    signal="speed over angle, Hann window, from half the slower shaft's order to half the mesh order",
    formula="rms in the band/mean",
    known="mean times 1 + m cos(k θ): m/√2",
    undefined="the speed has no mean, or the slower shaft turns less than four times",
    source=BOOK,
)
def speed_ripple(angle_signal: np.ndarray, ripple_bins: tuple[int, int]) -> float:
    """Return the rms of the speed's variation in the band over its mean; NaN where drift would reach into the band.

    Parameters
    ----------
    angle_signal : (n,) float64
        Speed at equal angle steps, in any unit.
    ripple_bins : (int, int)
        The band, in bins of its spectrum; from bin 2 on the mean and slow drift stay outside of it.
    """
    mean = abs(float(angle_signal.mean()))
    if not mean > 0.0 or ripple_bins[0] < HANN_HALF_WIDTH_BINS:
        return math.nan
    return band_rms(angle_signal, ripple_bins) / mean
