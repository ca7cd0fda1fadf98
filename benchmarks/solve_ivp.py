"""Alternative: `scipy.integrate.solve_ivp` behind siggen's own integrator protocol, with the same compiled equations.

So transient, filter and decimation are the same, and an error is an error of the integration alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from siggen.dynamics.equations import Equations, state_rate
from siggen.dynamics.mesh_force import MeshLaw

FloatArray = NDArray[np.float64]

RELATIVE_TOLERANCE = 1e-8
ABSOLUTE_TOLERANCE = 1e-14
"""In m and m/s; displacements are around 1e-6 m, and samples come from their second differences."""


class SolveIvp:
    """Advances the state with one call of `solve_ivp` per block; a method of scipy chooses its own steps."""

    def __init__(self, method: str, equations: Equations, law: MeshLaw, step_s: float) -> None:
        self._method, self._equations, self._law, self._step_s = method, equations, law, step_s

    def advance(self, pitches: FloatArray, trajectory: FloatArray) -> None:
        """Fill rows 1.. of `trajectory` (steps + 1, 2n) from row 0, with the pinion angles `pitches` (steps + 1,)."""
        time_s = self._step_s * np.arange(pitches.size)
        speed = (pitches[-1] - pitches[0]) / time_s[-1]

        def rate(t: float, state: FloatArray) -> FloatArray:
            result = np.empty_like(state)
            state_rate(self._equations, self._law, state, pitches[0] + speed * t, result)
            return result

        solution = solve_ivp(
            rate,
            (0.0, time_s[-1]),
            trajectory[0].copy(),
            method=self._method,
            t_eval=time_s,
            rtol=RELATIVE_TOLERANCE,
            atol=ABSOLUTE_TOLERANCE,
        )
        trajectory[1:] = solution.y.T[1:]


def solve_ivp_integrators(*methods: str) -> Mapping[str, Callable[[Equations, MeshLaw, float], SolveIvp]]:
    """Return integrators by the name of scipy's method, as in `siggen.dynamics.response.INTEGRATORS`."""

    def maker(method: str) -> Callable[[Equations, MeshLaw, float], SolveIvp]:
        return lambda equations, law, step_s: SolveIvp(method, equations, law, step_s)

    return {method: maker(method) for method in methods}
