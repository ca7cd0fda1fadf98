"""Newmark's method of average acceleration (β = 1/4, γ = 1/2) in numpy.

The matrix of a step is inverted once, at the mean mesh stiffness; the forces of the mesh come from a function. With
`mesh_stiffness` the matrix follows the stiffness of each step by a correction of rank one, which solves a linear law
in one iteration. Without, the force is iterated with the mean stiffness, not with the tangent. Source: Newmark (1959),
here in terms of the acceleration at the end.
"""

from __future__ import annotations

import numpy as np

from benchmarks.driven_rate import Rate
from siggen.arrays import FloatArray
from siggen.dynamics.time.equations import Equations, state_matrix

RESIDUAL = 1e-6
"""Of the acceleration by the static force of the mesh: what is left of a step's balance."""
ITERATIONS = 20


def newmark(
    equations: Equations,
    damping_n_s_per_m: float,
    rate: Rate,
    step_s: float,
    path: FloatArray,
    mesh_stiffness: FloatArray | None = None,
) -> None:
    """Fill `path` (steps + 1, 2n) after row 0; `rate` gives ż of time and state, `mesh_stiffness` (steps + 1,) [N/m].

    Where a damper switches within a step the iteration may turn in circles; then the last of ITERATIONS is kept.
    """
    n = path.shape[1] // 2
    linear = -state_matrix(equations, equations.reference_stiffness, np.array([damping_n_s_per_m]))[n:]
    half, quarter = 0.5 * step_s, 0.25 * step_s**2
    inverse = np.linalg.inv(np.eye(n) + half * linear[:, n:] + quarter * linear[:, :n])
    push, p = inverse @ equations.mesh_input[0], equations.mesh_vector[0]
    enough = RESIDUAL * abs(equations.static_force[0]) * float(np.linalg.norm(equations.mesh_input[0]))
    acceleration = rate(0.0, path[0])[n:]
    for i in range(1, len(path)):
        place, speed = path[i - 1, :n], path[i - 1, n:]
        place = place + step_s * speed + quarter * acceleration
        speed = speed + half * acceleration
        softer = 0.0 if mesh_stiffness is None else quarter * (mesh_stiffness[i] - equations.reference_stiffness[0])
        for _ in range(ITERATIONS):
            state = np.concatenate([place + quarter * acceleration, speed + half * acceleration])
            residual = rate(i * step_s, state)[n:] - acceleration
            if np.sqrt(residual @ residual) <= enough:
                break
            change = inverse @ residual
            if softer != 0.0:
                change -= push * (softer * (p @ change) / (1.0 + softer * (p @ push)))
            acceleration = acceleration + change
        path[i] = state
