"""PinkStream: 1/f noise without end as a sum of first-order processes on one white noise, stationary from its start.

Poles and zeros alternate evenly over the logarithm of frequency, so the amplitude falls as 1/√f on average (reference:
standard literature); poles at e^(-2π f/f_s). A coupling capacitor is one pole more and a zero at frequency 0. Partial
fractions give y = g w + Σ r_i s_i, s_i ← a_i s_i + w, whose states begin with their covariance 1/(1 - a_i a_j)
(derived).
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry

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
