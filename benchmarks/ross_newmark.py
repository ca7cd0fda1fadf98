"""Alternative: the time integration of ROSS (`ross.utils.newmark`), an optional import.

`Rotor.run_time_response`, and `MultiRotor` with `update_mesh_stiffness`, hand it mass, damping and stiffness anew at
every step. Here it gets those of siggen's gearbox ready made: its assembly of a rotor is not in the cost. Forces that
depend on the state, which `add_to_RHS` allows for, are those of the state before the step. So the linear law goes into
the stiffness, and of tooth pairs, backlash and friction what the mean stiffness leaves over is a force one step late.
See https://github.com/petrobras/ross
"""

from __future__ import annotations

import numpy as np
from ross.utils import newmark  # type: ignore[import-not-found, unused-ignore]

from benchmarks.driven_rate import Rate
from siggen.arrays import FloatArray
from siggen.dynamics.time.linear_motion import LinearMotion
from siggen.dynamics.time.pair_motion import PairMotion

Matrices = tuple[FloatArray, FloatArray, FloatArray, FloatArray]


def ross_linear(motion: LinearMotion, mesh_stiffness: FloatArray, step_s: float, path: FloatArray) -> None:
    """Fill `path` (steps + 1, 2n) after row 0, which must be at rest; the mesh stiffness (steps + 1,) is in N/m."""
    structure, equations, law = motion.structure, motion.equations, motion.law
    p, start = structure.mesh.vector, path[0, : structure.mass.shape[0]].copy()
    mesh = np.outer(p, p)
    damping = structure.damping + law.damping_n_s_per_m * mesh
    penetration = equations.static_force[0] / equations.reference_stiffness[0]
    # it begins at zero, so displacements count from the start
    stiffness = [structure.stiffness + k * mesh for k in mesh_stiffness.tolist()]
    force = [
        -p * ((k - equations.reference_stiffness[0]) * penetration) - matrix @ start
        for k, matrix in zip(mesh_stiffness.tolist(), stiffness, strict=True)
    ]

    def system(step: int, **_state: object) -> Matrices:
        return structure.mass, damping, stiffness[step], force[step]

    path[:, : start.size] = newmark(system, step_s * np.arange(len(path)), start.size) + start


def ross_pairs(motion: PairMotion, rate: Rate, step_s: float, path: FloatArray) -> None:
    """Fill displacements of `path` (steps + 1, 2n) after row 0, which must be at rest; `rate` gives ż."""
    structure, start = motion.structure, path[0, : motion.structure.mass.shape[0]].copy()
    reference = float(motion.equations.reference_stiffness[0])
    mesh = np.outer(structure.mesh.vector, structure.mesh.vector)
    damping = structure.damping + motion.law.damping_root_kg * float(np.sqrt(reference)) * mesh
    mass, stiffness = structure.mass, structure.stiffness + reference * mesh

    def system(step: int, *, y: FloatArray, ydot: FloatArray, **_state: object) -> Matrices:
        now = rate(step * step_s, np.concatenate([start + y, ydot]))[start.size :]
        return mass, damping, stiffness, mass @ now + damping @ ydot + stiffness @ y

    path[:, : start.size] = newmark(system, step_s * np.arange(len(path)), start.size) + start
