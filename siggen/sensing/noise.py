"""Noise of a given density: shaped, white or pink, from forces or of the electronics.

ShapedNoise: noise of a given density without end, drawn in an order that blocks do not change.

White noise of variance f_s/2 has the one-sided density 1. It passes the filter of least phase with the wanted
amplitude, found from its cepstrum (reference: standard literature). Cut to so many taps, it smooths densities over
f_s/taps.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.compiled import entry
from siggen.sensing.filters import filter_length, frequencies

FADED_SHARE = 0.25
"""Last taps, over which a filter fades out."""
FINER = 4
"""Times finer is the grid of the cepstrum, so that it does not fold."""


def least_phase(density: FloatArray) -> ComplexArray:
    """Return the response (k,) of least phase with an amplitude (k,) > 0 from 0 to half the sampling rate, evenly."""
    size = 2 * (density.size - 1)
    cepstrum = np.fft.irfft(np.log(density), size)
    cepstrum[1 : size // 2] *= 2.0
    cepstrum[size // 2 + 1 :] = 0.0
    return np.asarray(np.exp(np.fft.rfft(cepstrum)))


def shape_taps(density: Callable[[FloatArray], FloatArray], taps: int, fs_hz: float) -> FloatArray:
    """Return the filter (taps,) with the amplitude that `density` gives at frequencies (k,) [Hz]."""
    size = FINER * taps
    pulse = np.fft.irfft(least_phase(density(frequencies(size, fs_hz))), size)[:taps]
    faded = int(FADED_SHARE * taps)
    pulse[-faded:] *= 0.5 + 0.5 * np.cos(np.pi * (np.arange(faded) + 0.5) / faded)
    return np.asarray(pulse)


class ShapedNoise:
    """Noise whose one-sided density is the squared amplitude of a filter (taps,) [unit per √Hz]."""

    def __init__(self, taps: FloatArray, fs_hz: float, rng: np.random.Generator) -> None:
        self._taps = taps * np.sqrt(0.5 * fs_hz)
        self._rng = rng
        self._before = rng.standard_normal(taps.size - 1)

    def take(self, count: int) -> FloatArray:
        """Return the next values (count,)."""
        values = np.concatenate([self._before, self._rng.standard_normal(count)])
        length = filter_length(values.size, 0)
        spectrum = np.fft.rfft(values, length)
        spectrum *= np.fft.rfft(self._taps, length)
        self._before = values[count:].copy()
        return np.asarray(np.fft.irfft(spectrum, length)[self._taps.size - 1 : values.size])


# ForceDensity: one-sided densities of force noise over frequency, and noise that has them.
#
# Sources: noise behind |H|² = 1/(1 + (f/f_c)²)^m, the filter of a contact of finite width, whose power over all
# frequencies is f_c (√π/2) Γ(m - 1/2)/Γ(m) times its density at 0 (derived); D_0 √(1 + (f_r/f)^q) of machines and
# foundations below f_r (model).


def contact_filter(frequency_hz: FloatArray, corner_hz: float, steepness: float) -> FloatArray:
    """Return |H| (k,) = (1 + (f/f_c)²)^(-m/2)."""
    return np.asarray((1.0 + (frequency_hz / corner_hz) ** 2) ** (-0.5 * steepness))


def contact_bandwidth_hz(corner_hz: float, steepness: float) -> float:
    """Return ∫ |H|² df from 0 to infinity."""
    return corner_hz * 0.5 * math.sqrt(math.pi) * math.gamma(steepness - 0.5) / math.gamma(steepness)


def rising_floor(frequency_hz: FloatArray, corner_hz: float, exponent: float) -> FloatArray:
    """Return √(1 + (f_r/f)^q) (k,); at frequency 0 as at the first one above."""
    from_first = np.maximum(frequency_hz, frequency_hz[1])
    return np.asarray(np.sqrt(1.0 + (corner_hz / from_first) ** exponent))


def tabulated(frequency_hz: FloatArray, knots_hz: Sequence[float], density: Sequence[float]) -> FloatArray:
    """Return densities (k,) between knots, straight in log-log; beyond the first and last knot they stay."""
    knots, values = np.asarray(knots_hz, dtype=float), np.asarray(density, dtype=float)
    safe = np.maximum(frequency_hz, knots[0])
    return np.asarray(np.exp(np.interp(np.log(safe), np.log(knots), np.log(values))))


# Noise of a given power density as the spectrum of a stationary record, white or falling as 1/f.
#
# The record is taken as periodic over its length N: each bin of the discrete spectrum is an independent complex normal
# number with E|X|² = S N f_s / 2, S the one-sided density (derived from Parseval's theorem). Such noise is stationary
# by construction, so that filters have no transient on it.


def noise_spectrum(
    density: float, length: int, fs_hz: float, rng: np.random.Generator, *, pink_corner_hz: float | None = None
) -> ComplexArray:
    """Return the spectrum (length // 2 + 1,), as of `numpy.fft.rfft`, of noise without a mean.

    Parameters
    ----------
    density : one-sided, in units per √Hz; at the corner if pink
    length, fs_hz : of the record
    pink_corner_hz : where 1/f noise has the density; None: white
    """
    bins = length // 2 + 1
    parts = rng.standard_normal((bins, 2))
    spectrum: ComplexArray = parts.view(np.complex128)[:, 0] * (density * 0.5 * np.sqrt(length * fs_hz))
    if length % 2 == 0:
        spectrum[-1] = spectrum[-1].real * np.sqrt(2.0)
    spectrum[0] = 0.0
    if pink_corner_hz is not None:
        spectrum[1:] *= np.sqrt(pink_corner_hz * length / (fs_hz * np.arange(1, bins)))
    return spectrum


# PinkStream: 1/f noise without end as a sum of first-order processes on one white noise, stationary from its start.
#
# Poles and zeros alternate evenly over the logarithm of frequency, so the amplitude falls as 1/√f on average
# (reference: standard literature); poles at e^(-2π f/f_s). A coupling capacitor is one pole more and a zero at
# frequency 0. Partial fractions give y = g w + Σ r_i s_i, s_i ← a_i s_i + w, whose states begin with their covariance
# 1/(1 - a_i a_j) (derived).

LOWEST_HZ = 0.01
"""Below, the noise is white: a wander over more than 16 s."""
PER_DECADE = 3
"""Poles per decade: the amplitude stays within 2 % of 1/√f up to a tenth of the sampling rate. It is 8 to 13 % above at
0.3 of it and 25 to 34 % near half of it, far below what else a sensor shows there."""


class PinkStream:
    """Noise of a one-sided density at a corner, falling as 1/f, behind a first-order high-pass if there is one."""

    def __init__(
        self, density: float, corner_hz: float, high_pass_hz: float | None, fs_hz: float, rng: np.random.Generator
    ) -> None:
        # a coupling half way between a pole and the next zero: partial fractions need poles apart
        lowest_hz = LOWEST_HZ if high_pass_hz is None else _quarter_below(high_pass_hz)
        poles, zeros = _ladder(lowest_hz, fs_hz)
        shape = np.abs(_gain(poles, zeros, corner_hz / fs_hz))
        if high_pass_hz is not None:
            poles, zeros = np.append(poles, np.exp(-2.0 * np.pi * high_pass_hz / fs_hz)), np.append(zeros, 1.0)
            shape *= 0.5 * (1.0 + poles[-1])
        self._poles, self._direct = poles, density / shape * np.sqrt(0.5 * fs_hz)
        self._shares = self._direct * _residues(poles, zeros)
        self._rng = rng
        covariance = 1.0 / (1.0 - poles[:, None] * poles)
        self._states = np.linalg.cholesky(covariance) @ rng.standard_normal(poles.size)

    def take(self, count: int) -> FloatArray:
        """Return the next values (count,)."""
        white = self._rng.standard_normal(count)
        return _filtered(white, self._poles, self._shares, self._direct, self._states)


def _quarter_below(high_pass_hz: float) -> float:
    """Return a lowest frequency near `LOWEST_HZ` from which the corner is whole steps and a quarter away."""
    steps = round(PER_DECADE * np.log10(high_pass_hz / LOWEST_HZ))
    return float(high_pass_hz * 10.0 ** (-(steps + 0.25) / PER_DECADE))


def _ladder(lowest_hz: float, fs_hz: float) -> tuple[FloatArray, FloatArray]:
    """Return poles and zeros of z⁻¹, from the lowest frequency to half the sampling rate."""
    count = int(np.ceil(PER_DECADE * np.log10(0.5 * fs_hz / lowest_hz)))
    ratio = 10.0 ** (1.0 / PER_DECADE)
    pole_hz = lowest_hz * ratio ** np.arange(count)
    return np.exp(-2.0 * np.pi * pole_hz / fs_hz), np.exp(-2.0 * np.pi * pole_hz * np.sqrt(ratio) / fs_hz)


def _gain(poles: FloatArray, zeros: FloatArray, per_sample: float) -> np.complex128:
    delay = np.exp(-2j * np.pi * per_sample)
    return np.complex128(np.prod((1.0 - zeros * delay) / (1.0 - poles * delay)))


def _residues(poles: FloatArray, zeros: FloatArray) -> FloatArray:
    """Return r_i of Π (1 - z_i d)/(1 - a_i d) = 1 + Σ r_i d/(1 - a_i d), d the delay of a sample."""
    found = np.empty(poles.size)
    for i, pole in enumerate(poles):
        others = np.delete(poles, i)
        # one factor after the other: products of all would underflow
        found[i] = (pole - zeros[i]) * np.prod((pole - np.delete(zeros, i)) / (pole - others))
    return found


@entry(cache=True)
def _filtered(
    white: FloatArray, poles: FloatArray, shares: FloatArray, direct: float, states: FloatArray
) -> FloatArray:
    """Return direct w + Σ shares s with the states before w came in; leaves `states` at the end."""
    result = np.empty_like(white)
    for k in range(white.size):
        total = direct * white[k]
        for i in range(poles.size):
            total += shares[i] * states[i]
            states[i] = poles[i] * states[i] + white[k]
        result[k] = total
    return result
