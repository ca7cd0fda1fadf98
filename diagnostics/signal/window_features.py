"""Sixty-four numbers of a window of about a second that know neither its level nor an angle.

The window is resampled to 12.8 kHz, its mean removed, divided by its standard deviation. Densities have a Hann window.
Floor, lines and tails of bands, the course of the floor, envelopes of three bands. Source: derived, to tell generated
from measured records.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np

RATE_HZ, WINDOW_S = 12_800.0, 1.0
EDGES_HZ = (5, 50, 150, 300, 600, 1000, 1500, 2000, 2500, 3000, 3500, 4000, 4800)
BANDS = tuple(pairwise(EDGES_HZ))
ENVELOPES_HZ = ((500, 1500), (1500, 3000), (3000, 4800))
CURVE_BINS, CURVE_FROM_HZ, PIECES, LINE_MEDIANS = 60, 150.0, 20, 20.0
TINY = 1e-30

FEATURES = (
    *("kurtosis", "skewness", "largest absolute value", "rate of zero crossings", "flatness 5-4800 Hz [dB]"),
    *(f"{what} {low}-{high} Hz [dB]" for what in ("floor", "tonality", "top") for low, high in BANDS),
    *(f"share of lines {low}-{high} Hz" for low, high in BANDS),
    *("slope of the floor [dB]", "scatter of the floor [dB]", "roughness of the floor [dB]", "range of the floor [dB]"),
    *(f"envelope {what} {low}-{high} Hz" for low, high in ENVELOPES_HZ for what in ("kurtosis", "variation")),
    "variation of the level",
)


def signal_windows(signal: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return the whole windows of a signal at 12.8 kHz, (windows, 12800) float64.

    Parameters
    ----------
    signal : (n,) float64
    fs_hz : float
        Sampling frequency [Hz]; from 9.6 kHz on, so that 4.8 kHz are held.
    """
    from scipy.signal import resample_poly

    ratio = Fraction(RATE_HZ / fs_hz).limit_denominator(2000)
    size = round(RATE_HZ * WINDOW_S)
    resampled = resample_poly(signal - signal.mean(), ratio.numerator, ratio.denominator)
    return np.asarray(resampled[: resampled.size // size * size].reshape(-1, size))


def window_features(window: np.ndarray) -> np.ndarray:
    """Return the features of one window, (64,) float64, in the order of `FEATURES`; NaN for a constant window.

    Parameters
    ----------
    window : (n,) float64
        At 12.8 kHz.
    """
    from scipy import fft

    spread = float(window.std())
    if not spread > 0.0:
        return np.full(len(FEATURES), math.nan)
    x = (window - window.mean()) / spread
    power = np.square(np.abs(fft.rfft(x * np.hanning(x.size)))) + TINY
    hz = np.arange(power.size) * RATE_HZ / x.size
    density = power * (2.0 / (RATE_HZ * float(np.square(np.hanning(x.size)).sum())))
    bands = [density[(hz >= low) & (hz < high)] for low, high in BANDS]
    middle = np.array([np.median(band) for band in bands])
    shape = [np.mean(x**4), np.mean(x**3), np.abs(x).max(), np.mean(np.signbit(x[1:]) != np.signbit(x[:-1]))]
    every = density[(hz >= EDGES_HZ[0]) & (hz < EDGES_HZ[-1])]
    flatness = 10.0 * (np.log10(every).mean() - math.log10(every.mean()))
    return np.array(
        [
            *shape,
            flatness,
            *_db(middle),
            *_db(np.array([band.mean() for band in bands]) / middle),
            *_db(np.array([band.max() for band in bands]) / middle),
            *(np.mean(band > LINE_MEDIANS * level) for band, level in zip(bands, middle, strict=True)),
            *_curve(density, hz),
            *(number for low, high in ENVELOPES_HZ for number in _envelope(x, low, high)),
            _level_variation(x),
        ]
    )


def _db(values: np.ndarray) -> np.ndarray:
    return np.asarray(10.0 * np.log10(values))


def _curve(density: np.ndarray, hz: np.ndarray) -> list[float]:
    """Return slope of the floor, its scatter about that line, scatter of neighbours' differences, and range."""
    kept = density[(hz >= CURVE_FROM_HZ) & (hz < EDGES_HZ[-1])]
    floor = _db(np.array([np.median(part) for part in np.array_split(kept, CURVE_BINS)]))
    place = np.arange(CURVE_BINS)
    slope, start = np.polyfit(place, floor, 1)
    return [slope * CURVE_BINS, (floor - slope * place - start).std(), np.diff(floor).std(), np.ptp(floor)]


def _envelope(x: np.ndarray, low: float, high: float) -> tuple[float, float]:
    """Return kurtosis and coefficient of variation of the magnitude of a band's analytic signal."""
    from scipy import fft

    bin_hz = RATE_HZ / x.size
    kept = fft.rfft(x)[math.ceil(low / bin_hz) : math.ceil(high / bin_hz)]
    envelope = np.abs(fft.ifft(kept))
    centred = envelope - envelope.mean()
    variance = float(np.square(centred).mean())
    return float((centred**4).mean() / (variance**2 + TINY)), math.sqrt(variance) / (float(envelope.mean()) + TINY)


def _level_variation(x: np.ndarray) -> float:
    levels = np.array([piece.std() for piece in np.array_split(x, PIECES)])
    return float(levels.std() / levels.mean())
