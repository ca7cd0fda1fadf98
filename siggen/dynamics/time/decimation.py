"""Decimation: samples at the output rate from states at the integration steps, through one linear-phase FIR low-pass.

Filter: windowed sinc, Kaiser window (reference: standard literature). An acceleration that jumps has a spectrum falling
as 1/f only, so its point values would alias. Instead the second difference of the displacement is filtered, which is
exactly the mean of the acceleration under a triangle of two steps; its droop (sin(x)/x)² is divided out in the pass
band (derived).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit

PASS_EDGE = 0.45
"""Highest frequency passed unchanged, in units of the output rate."""
STOP_EDGE = 0.5
"""Frequency from which the filter stops, in units of the output rate: nothing folds into the band."""
QUADRATURE_NODES = 160
"""Exact to rounding for cosines up to 170 rad, the largest phase at any number of steps per sample."""
ATTENUATION_DB = 90.0
"""Design attenuation; leaves margin to the promised 80 dB and a ripple of 3e-4 dB in the pass band."""


def half_length(steps_per_sample: int) -> int:
    """Return the number of integration steps that the filter reaches to either side of an output sample."""
    width = 2.0 * np.pi * (STOP_EDGE - PASS_EDGE) / steps_per_sample
    return int(np.ceil(0.5 * (ATTENUATION_DB - 7.95) / (2.285 * width)))


@lru_cache(maxsize=16)
def value_taps(steps_per_sample: int) -> FloatArray:
    """Return the taps (2 half + 1,) that low-pass values known at the steps; gain 1 at frequency 0."""
    half = half_length(steps_per_sample)
    return _frozen(_low_pass(np.arange(-half, half + 1.0), half + 1.0, steps_per_sample, droop=False))


@lru_cache(maxsize=16)
def second_difference_taps(steps_per_sample: int) -> FloatArray:
    """Return the taps (2 half + 1,) that turn a displacement at the steps into its low-passed second difference.

    They are a low-pass on second differences, compensated for their droop, written out on the values.
    """
    half = half_length(steps_per_sample)
    low_pass = _low_pass(np.arange(-half + 1.0, half), half + 1.0, steps_per_sample, droop=True)
    return _frozen(np.diff(np.pad(low_pass, 2), n=2))


def _low_pass(place: FloatArray, reach: float, steps_per_sample: int, *, droop: bool) -> FloatArray:
    """Return a windowed ideal low-pass at `place` (in steps), optionally with the inverse of the droop (sin(x)/x)²."""
    cut = np.pi * (PASS_EDGE + STOP_EDGE) / steps_per_sample
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE_NODES)
    omega = 0.5 * cut * (nodes + 1.0)
    gain = (0.5 * omega / np.sin(0.5 * omega)) ** 2 if droop else np.ones_like(omega)
    ideal = (np.cos(place[:, None] * omega) * (weights * gain)).sum(axis=1) * 0.5 * cut / np.pi
    beta = 0.1102 * (ATTENUATION_DB - 8.7)
    taps = ideal * np.i0(beta * np.sqrt(1.0 - (place / reach) ** 2)) / np.i0(beta)
    return np.asarray(taps / taps.sum())


def _frozen(taps: FloatArray) -> FloatArray:
    taps.setflags(write=False)
    return taps


class Decimator:
    """Takes states step by step and gives low-passed linear combinations of them at the output rate.

    The first state taken is the one `half_length` steps before the first sample.
    """

    def __init__(self, rows: FloatArray, taps: FloatArray, steps_per_sample: int) -> None:
        self._channels = len(rows)
        self._rows = np.zeros((-(-self._channels // 4) * 4, rows.shape[1]))
        self._rows[: self._channels] = rows
        self._taps = taps
        self._steps_per_sample = steps_per_sample
        self._pending = np.empty((0, len(self._rows)))

    def take(self, states: FloatArray) -> FloatArray:
        """Filter the next states (steps, 2n) as far as the filter reaches; return the next samples (channels, k)."""
        pending = np.concatenate([self._pending, _project(states, self._rows)])
        ready = max(0, (len(pending) - len(self._taps)) // self._steps_per_sample + 1)
        values = np.empty((len(self._rows), ready))
        _filter(pending, self._taps, self._steps_per_sample, values)
        self._pending = pending[ready * self._steps_per_sample :]
        return values[: self._channels]


@njit(cache=True)
def _project(states: FloatArray, rows: FloatArray) -> FloatArray:
    """Return rows · state (steps, channels) of each state (steps, 2n); rows are (channels, 2n)."""
    result = np.empty((states.shape[0], rows.shape[0]))
    for i in range(states.shape[0]):
        for c in range(rows.shape[0]):
            total = 0.0
            for j in range(rows.shape[1]):
                total += rows[c, j] * states[i, j]
            result[i, c] = total
    return result


@njit(cache=True)
def _filter(values: FloatArray, taps: FloatArray, steps_per_sample: int, result: FloatArray) -> None:
    """Write the filtered values (steps, channels) at every steps_per_sample-th step into `result` (channels, samples).

    Channels come in groups of four, so that the compiler can work on four at once without reordering sums.
    """
    for k in range(result.shape[1]):
        first = k * steps_per_sample
        for g in range(0, result.shape[0], 4):
            a, b, c, d = 0.0, 0.0, 0.0, 0.0
            for m in range(taps.size):
                tap = taps[m]
                a += tap * values[first + m, g]
                b += tap * values[first + m, g + 1]
                c += tap * values[first + m, g + 2]
                d += tap * values[first + m, g + 3]
            result[g, k], result[g + 1, k], result[g + 2, k], result[g + 3, k] = a, b, c, d
