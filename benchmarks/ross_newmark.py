"""Alternative: the time integration of ROSS (`ross.utils.newmark`), an optional import, on the linear mesh law.

`Rotor.run_time_response`, and `MultiRotor` with `update_mesh_stiffness`, hand it mass, damping and stiffness anew at
every step. Here it gets those of siggen's 8-DOF gearbox, with siggen's mesh stiffness, ready made: its assembly of a
rotor is not in the cost. It knows no backlash, tooth pairs or friction: for the full law there is nothing to compare.
See https://github.com/petrobras/ross
"""

from __future__ import annotations

import numpy as np
from ross.utils import newmark  # type: ignore[import-not-found, unused-ignore]

from siggen.arrays import FloatArray
from siggen.dynamics.time.linear_motion import LinearMotion


def ross_newmark(motion: LinearMotion, mesh_stiffness: FloatArray, step_s: float, path: FloatArray) -> None:
    """Fill `path` (steps + 1, 2n) after row 0, which must be at rest; the mesh stiffness (steps + 1,) is in N/m."""
    structure, equations, law = motion.structure, motion.equations, motion.law
    p, start = structure.mesh_vector, path[0, : structure.mass.shape[0]].copy()
    mesh = np.outer(p, p)
    damping = structure.damping + law.damping_n_s_per_m * mesh
    penetration = equations.static_force / equations.reference_stiffness
    # it begins at zero, so displacements count from the start
    stiffness = [structure.stiffness + k * mesh for k in mesh_stiffness.tolist()]
    force = [
        -p * ((k - equations.reference_stiffness) * penetration) - matrix @ start
        for k, matrix in zip(mesh_stiffness.tolist(), stiffness, strict=True)
    ]

    def system(step: int, **_state: object) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        return structure.mass, damping, stiffness[step], force[step]

    moved = newmark(system, step_s * np.arange(len(path)), start.size)
    path[:, : start.size] = moved + start
