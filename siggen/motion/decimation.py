"""Decimation: samples at the output rate from states at the integration steps, through one linear-phase FIR low-pass.

Filter: windowed sinc, Kaiser window (reference: standard literature). An acceleration that jumps has a spectrum falling
as 1/f only, so its point values would alias. Instead the second difference of the displacement is filtered, which is
exactly the mean of the acceleration under a triangle of two steps; its droop (sin(x)/x)² is divided out in the pass
band (derived).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit

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
        # copies, so that all filters are of one type, for which one version is compiled
        self._taps, self._steps_per_sample = taps.copy(), steps_per_sample
        channel, columns = np.nonzero(rows)
        self._columns = columns.copy()
        self._weights = rows[channel, self._columns]
        self._ends = np.cumsum(np.count_nonzero(rows, axis=1))
        self._pending = np.empty((len(rows), 0))

    def take(self, states: FloatArray) -> FloatArray:
        """Filter the next states (steps, 2n) as far as the filter reaches; return the next samples (channels, k)."""
        projected = _project(states, self._columns, self._weights, self._ends)
        pending = np.concatenate([self._pending, projected], axis=1)
        ready = max(0, (pending.shape[1] - self._taps.size) // self._steps_per_sample + 1)
        values = np.zeros((len(pending), ready))
        _filter(pending, self._taps, self._steps_per_sample, values)
        self._pending = pending[:, ready * self._steps_per_sample :].copy()
        return values


@entry(cache=True)
def _project(
    states: FloatArray, columns: NDArray[np.int64], weights: FloatArray, ends: NDArray[np.int64]
) -> FloatArray:
    """Return rows · state (channels, steps) of each state (steps, 2n); of rows the `columns` that are not 0 alone.

    `ends` (channels,) is where the weights of each row end. What is 0 adds nothing to the last bit either.
    """
    result, steps = np.empty((ends.size, states.shape[0])), states.shape[0]
    for i in range(0, steps, 4):
        # four sums at a time do not wait for each other
        i_1, i_2, i_3 = min(i + 1, steps - 1), min(i + 2, steps - 1), min(i + 3, steps - 1)
        begin = 0
        for c in range(ends.size):
            t_0, t_1, t_2, t_3 = 0.0, 0.0, 0.0, 0.0
            for k in range(begin, ends[c]):
                j, weight = columns[k], weights[k]
                t_0 += weight * states[i, j]
                t_1 += weight * states[i_1, j]
                t_2 += weight * states[i_2, j]
                t_3 += weight * states[i_3, j]
            result[c, i_3], result[c, i_2], result[c, i_1], result[c, i] = t_3, t_2, t_1, t_0
            begin = ends[c]
    return result


@entry(cache=True)
def _filter(values: FloatArray, taps: FloatArray, steps_per_sample: int, result: FloatArray) -> None:
    """Add the filtered values (channels, steps) at every steps_per_sample-th step to `result` (channels, samples), 0.

    Eight taps at a time on all samples: steps that are whole samples apart lie side by side, so that the compiler works
    on several samples at once, each with its taps in their order.
    """
    samples, together = result.shape[1], taps.size - taps.size % 8
    apart = np.empty((steps_per_sample, -(-values.shape[1] // steps_per_sample)))
    for c in range(result.shape[0]):
        for phase in range(steps_per_sample):
            for i in range(phase, values.shape[1], steps_per_sample):
                apart[phase, i // steps_per_sample] = values[c, i]
        for m in range(0, together, 8):
            _add_eight(result[c], taps, apart, m)
        for m in range(together, taps.size):
            _add_one(result[c], taps[m], _behind(apart, m, samples))


@njit(cache=True)
def _behind(apart: FloatArray, steps: int, samples: int) -> FloatArray:
    """Return the values (samples,) so many steps behind the first step of each sample."""
    first = steps // apart.shape[0]
    return apart[steps % apart.shape[0], first : first + samples]


@njit(cache=True)
def _add_eight(result: FloatArray, taps: FloatArray, apart: FloatArray, m: int) -> None:
    """Add eight taps from one on times the values (samples,) behind them, one after the other."""
    samples = result.size
    a, b, c = _behind(apart, m, samples), _behind(apart, m + 1, samples), _behind(apart, m + 2, samples)
    d, e, f = _behind(apart, m + 3, samples), _behind(apart, m + 4, samples), _behind(apart, m + 5, samples)
    g, h = _behind(apart, m + 6, samples), _behind(apart, m + 7, samples)
    t, u, v, w = taps[m], taps[m + 1], taps[m + 2], taps[m + 3]
    x, y, z, q = taps[m + 4], taps[m + 5], taps[m + 6], taps[m + 7]
    for k in range(result.size):
        first = result[k] + t * a[k] + u * b[k] + v * c[k] + w * d[k]
        result[k] = first + x * e[k] + y * f[k] + z * g[k] + q * h[k]


@njit(cache=True)
def _add_one(result: FloatArray, tap: float, values: FloatArray) -> None:
    for k in range(result.size):
        result[k] += tap * values[k]
