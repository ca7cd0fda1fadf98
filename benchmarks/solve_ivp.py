"""Alternative: `scipy.integrate.solve_ivp` behind siggen's own integrator protocol, with the same compiled equations.

So transient, filter and decimation are the same, and an error is an error of the integration alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal

import numpy as np
from scipy import integrate

from siggen.arrays import FloatArray
from siggen.dynamics.mesh.mesh_force import MeshLaw
from siggen.dynamics.time.equations import Equations, state_rate

Method = Literal["RK45", "DOP853", "LSODA"]

RELATIVE_TOLERANCE = 1e-5
ABSOLUTE_TOLERANCE = 1e-11
"""In m and m/s. Looser tolerances cost accuracy; tighter ones only time, since the low-pass then sets the error."""


class SolveIvp:
    """Advances the state with one call of `solve_ivp` per block; a method of scipy chooses its own steps."""

    def __init__(self, method: Method, equations: Equations, law: MeshLaw, step_s: float) -> None:
        self._method, self._equations, self._law, self._step_s = method, equations, law, step_s

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> None:  # noqa: ARG002
        """Fill rows 1.. of `trajectory` (steps + 1, 2n) from row 0, at constant speed and without inputs."""
        time_s = self._step_s * np.arange(pitches.size)
        speed = (pitches[-1] - pitches[0]) / time_s[-1]

        def rate(t: float, state: FloatArray) -> FloatArray:
            result = np.empty_like(state)
            state_rate(self._equations, self._law, state, pitches[0] + speed * t, result)
            return result

        solution = integrate.solve_ivp(
            rate,
            (0.0, time_s[-1]),
            trajectory[0].copy(),
            method=self._method,
            t_eval=time_s,
            rtol=RELATIVE_TOLERANCE,
            atol=ABSOLUTE_TOLERANCE,
        )
        trajectory[1:] = solution.y.T[1:]


def solve_ivp_integrators(*methods: Method) -> Mapping[str, Callable[[Equations, MeshLaw, float], SolveIvp]]:
    """Return integrators by the name of scipy's method, as in `siggen.dynamics.time.linear_motion.INTEGRATORS`."""

    def maker(method: Method) -> Callable[[Equations, MeshLaw, float], SolveIvp]:
        return lambda equations, law, step_s: SolveIvp(method, equations, law, step_s)

    return {method: maker(method) for method in methods}
