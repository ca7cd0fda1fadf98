"""Newmark's method of constant mean acceleration with Newton's method in every step, compiled as a whole.

Reference: Newmark (1959), β = 1/4 and γ = 1/2: of second order, no damping of its own. What a step's end needs is
solved for its acceleration, a = f(t + h, x(a), v(a)). The tangent is that of the linear part, whose inverse is found
once: the mesh's own stiffness moves it by little where steps are short, so a step takes few evaluations.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry

BETA, GAMMA = 0.25, 0.5
SETTLED, MOST = 1e-7, 20
"""Largest last correction of the accelerations, relative to the largest of them, and how many there may be."""


def inverse_tangent(linear: FloatArray, step_s: float) -> FloatArray:
    """Return the inverse (n, n) of da - df for a step, of the matrix (2n, 2n) of the linear part."""
    n = len(linear) // 2
    stiffness, damping = linear[n:, :n], linear[n:, n:]
    return np.ascontiguousarray(np.linalg.inv(np.eye(n) - BETA * step_s**2 * stiffness - GAMMA * step_s * damping))


@entry()
def newmark(
    rate: Any, model: Any, inverse: FloatArray, start: FloatArray, step: float, step_s: float, path: FloatArray
) -> None:
    """Fill `path` (steps + 1, 2n) with states.

    Parameters
    ----------
    rate : compiled function
        rate(model, place, state, found): writes the rate at a place on the grid of the model.
    model
    inverse : (n, n) of `inverse_tangent`
    start : (2n,) state
    step : on the grid of the model
    step_s : the same in seconds
    path
    """
    n = start.size // 2
    path[0] = start
    found, wanted = np.empty(2 * n), np.empty(n)
    rate(model, 0.0, start, found)
    before, last = found[n:].copy(), found[n:].copy()
    now = np.empty(n)
    for k in range(1, len(path)):
        state = path[k]
        for i in range(n):
            now[i] = 2.0 * last[i] - before[i]
        for _ in range(MOST):
            for i in range(n):
                mean = (0.5 - BETA) * last[i] + BETA * now[i]
                state[i] = path[k - 1, i] + step_s * (path[k - 1, n + i] + step_s * mean)
                state[n + i] = path[k - 1, n + i] + step_s * ((1.0 - GAMMA) * last[i] + GAMMA * now[i])
            rate(model, k * step, state, found)
            largest, corrected = 0.0, 0.0
            for i in range(n):
                wanted[i] = found[n + i] - now[i]
            for i in range(n):
                change = 0.0
                for j in range(n):
                    change += inverse[i, j] * wanted[j]
                now[i] += change
                largest, corrected = max(largest, abs(now[i])), max(corrected, abs(change))
            if corrected <= SETTLED * largest:
                break
        before[:], last[:] = last, now
