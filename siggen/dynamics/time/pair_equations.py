"""PairEquations: constant numbers of the equations of motion under the forces of tooth pairs (`pair_motion`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Structure, friction_tilt_vector, vector
from siggen.dynamics.time.equations import Equations, inverse_times


class PairEquations(NamedTuple):
    """Constant numbers of the equations of motion and how sliding enters them.

    `rows` (2n + 6, n), one array for speed (see `packed_tables`): the columns of -M⁻¹K and of -M⁻¹C, p, r_0, r_1, and
    M⁻¹ p, M⁻¹ r_0, M⁻¹ r_1; where gears tilt (2n + 9, n) with t, M⁻¹ t and M⁻¹ t_x behind; `static_tilt`: of the state;
    `static_force`, `static_approach`: state that deviations count from; `rigid_sliding_0`,
    `rigid_sliding_1`: sliding speed at s of the rigid rotation is the first plus s times the second [m/s, 1/s];
    `external_input` (m, n): see `Equations`.
    """

    rows: FloatArray
    static_force: float
    static_approach: float
    rigid_sliding_0: float
    rigid_sliding_1: float
    external_input: FloatArray
    static_tilt: float


def pair_equations(structure: Structure, equations: Equations, speed_hz: float) -> PairEquations:
    """Return the numbers of a structure about a state, at a mean speed of the pinion."""
    omega = 2.0 * np.pi * speed_hz
    p = dict(zip(structure.coordinates, structure.mesh_vector, strict=True))
    rolling = {"theta_1": 1.0, "theta_2": -p["theta_1"] / p["theta_2"]}
    rigid = structure.sliding_vectors @ vector(structure.coordinates, rolling) * omega
    inputs = inverse_times(structure.mass, structure.sliding_vectors.T).T
    parts = [-equations.stiffness_by_mass.T, -equations.damping_by_mass.T, equations.mesh_vector[None]]
    parts += [structure.sliding_vectors, equations.mesh_input[None], inputs]
    static_tilt = 0.0
    if structure.tilt_vector is not None:
        arms = np.stack([structure.tilt_vector, friction_tilt_vector(structure)], axis=1)
        turned = inverse_times(structure.mass, arms).T
        parts += [structure.tilt_vector[None], turned]
        static_tilt = float(structure.tilt_vector @ equations.static_deflection)
    return PairEquations(
        np.ascontiguousarray(np.concatenate(parts)),
        equations.static_force,
        equations.static_approach,
        float(rigid[0]),
        float(rigid[1]),
        equations.external_input,
        static_tilt,
    )
