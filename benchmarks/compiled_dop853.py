"""The method of Dormand and Prince of order 8(5,3), adaptive and compiled as a whole: scipy's without its Python.

Coefficients, control of steps and dense output are those of scipy's DOP853 (Hairer, Norsett and Wanner, Solving
Ordinary Differential Equations I, section II.10), so what it costs less than scipy's is what calls from Python cost.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate._ivp import dop853_coefficients as table

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit

STAGES, ALL_STAGES = table.N_STAGES, table.N_STAGES_EXTENDED
A, B, C = np.ascontiguousarray(table.A), np.ascontiguousarray(table.B), np.ascontiguousarray(table.C)
E3, E5, D = np.ascontiguousarray(table.E3), np.ascontiguousarray(table.E5), np.ascontiguousarray(table.D)
POWERS = table.INTERPOLATOR_POWER
SAFETY, LEAST, MOST = 0.9, 0.2, 10.0


@entry()
def dop853(
    rate: Any, model: Any, start: FloatArray, rate_hz: float, step_s: float, tolerance: tuple[float, float]
) -> FloatArray:
    """Return states at every sample of the model's grid, of which there are as many as the last argument tells.

    Parameters
    ----------
    rate : compiled function
        rate(model, place, state, found): writes the rate at a place on the grid of the model.
    start : (n,) state
    rate_hz : points of the grid per second
    step_s : between two samples that are wanted; the model's grid ends with the last one
    tolerance : relative and absolute one
    """
    rtol, atol = tolerance
    count = round((model[-2].size - 1) / rate_hz / step_s)
    states = np.empty((count + 1, start.size))
    states[0] = start
    k = np.empty((ALL_STAGES, start.size))
    state, new, work = start.copy(), start.copy(), start.copy()
    dense = np.empty((POWERS, start.size))
    t, h, following, rejected = 0.0, 0.1 * step_s, 1, False
    rate(model, 0.0, state, k[0])
    while following <= count:
        _stages(rate, model, rate_hz, t, h, state, k, work, 1, STAGES)
        for i in range(state.size):
            total = 0.0
            for s in range(STAGES):
                total += B[s] * k[s, i]
            new[i] = state[i] + h * total
        rate(model, (t + h) * rate_hz, new, k[STAGES])
        error = _error(k, h, state, new, rtol, atol)
        if not error < 1.0:
            h *= max(LEAST, SAFETY * error ** (-1.0 / 8.0)) if np.isfinite(error) else LEAST
            rejected = True
            continue
        if t + h >= following * step_s:
            _dense(rate, model, rate_hz, t, h, state, new, k, work, dense)
        while following <= count and t + h >= following * step_s - 1e-15:
            _interpolated(dense, (following * step_s - t) / h, state, states[following])
            following += 1
        t += h
        factor = MOST if error == 0.0 else min(MOST, SAFETY * error ** (-1.0 / 8.0))
        h *= min(1.0, factor) if rejected else factor
        rejected = False
        state[:] = new
        k[0] = k[STAGES]
    return states


@njit()
def _stages(
    rate: Any,
    model: Any,
    rate_hz: float,
    t: float,
    h: float,
    state: FloatArray,
    k: FloatArray,
    work: FloatArray,
    first: int,
    end: int,
) -> None:
    for s in range(first, end):
        for i in range(state.size):
            total = 0.0
            for j in range(s):
                total += A[s, j] * k[j, i]
            work[i] = state[i] + h * total
        rate(model, (t + C[s] * h) * rate_hz, work, k[s])


@njit()
def _error(k: FloatArray, h: float, state: FloatArray, new: FloatArray, rtol: float, atol: float) -> float:
    fifth, third = 0.0, 0.0
    for i in range(state.size):
        five, three = 0.0, 0.0
        for s in range(STAGES + 1):
            five += E5[s] * k[s, i]
            three += E3[s] * k[s, i]
        scale = atol + rtol * max(abs(state[i]), abs(new[i]))
        fifth += (five / scale) ** 2
        third += (three / scale) ** 2
    if fifth == 0.0 and third == 0.0:
        return 0.0
    return float(abs(h) * fifth / np.sqrt((fifth + 0.01 * third) * state.size))


@njit()
def _dense(
    rate: Any,
    model: Any,
    rate_hz: float,
    t: float,
    h: float,
    state: FloatArray,
    new: FloatArray,
    k: FloatArray,
    work: FloatArray,
    dense: FloatArray,
) -> None:
    _stages(rate, model, rate_hz, t, h, state, k, work, STAGES + 1, ALL_STAGES)
    for i in range(state.size):
        moved = new[i] - state[i]
        dense[0, i] = moved
        dense[1, i] = h * k[0, i] - moved
        dense[2, i] = 2.0 * moved - h * (k[STAGES, i] + k[0, i])
        for row in range(POWERS - 3):
            total = 0.0
            for s in range(ALL_STAGES):
                total += D[row, s] * k[s, i]
            dense[3 + row, i] = h * total


@njit()
def _interpolated(dense: FloatArray, x: float, state: FloatArray, found: FloatArray) -> None:
    for i in range(state.size):
        value = 0.0
        for back in range(POWERS):
            value = (value + dense[POWERS - 1 - back, i]) * (x if back % 2 == 0 else 1.0 - x)
        found[i] = state[i] + value
