"""Equations of motion about the static equilibrium at the mean mesh stiffness, in the form the integrators take.

With q = q_s + w and K_0 q_s + p F_s = f (derived):  M ẅ + C_0 ẇ + K_0 w = -p (F - F_s) + Σ_k v_k u_k(t),
F = mesh force at δ_s + pᵀw; inputs u_k act beside the constant torque, along constant vectors v_k.
The state is z = [w, ẇ]. Small deviations instead of the static twist of the shafts keep double precision over long
records.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh.mesh_force import MeshLaw, mesh_force, mesh_stiffness
from siggen.dynamics.structure.free_rotation import static_solution
from siggen.dynamics.structure.structure import Structure


class Equations(NamedTuple):
    """Constant numbers of the equations of motion (a named tuple, since compiled code takes no dataclass).

    `stiffness_by_mass`, `damping_by_mass` (n, n): M⁻¹K_0, M⁻¹C_0; `mesh_input` (n,): M⁻¹p; `mesh_vector` (n,): p;
    `static_deflection` (n,): q_s; `reference_stiffness`: mean mesh stiffness that q_s belongs to;
    `static_force`: F_s; `static_approach`: δ_s; `side`: +1 if the mean torque loads the drive flank, else -1;
    `external_input` (m, n): M⁻¹ v_k.
    """

    stiffness_by_mass: FloatArray
    damping_by_mass: FloatArray
    mesh_input: FloatArray
    mesh_vector: FloatArray
    static_deflection: FloatArray
    reference_stiffness: float
    static_force: float
    static_approach: float
    side: float
    external_input: FloatArray


def equations_of_motion(
    structure: Structure,
    law: MeshLaw,
    torque_nm: float,
    reference_stiffness: float,
    input_vectors: FloatArray | None = None,
) -> Equations:
    """Return the equations for a constant motor torque [N m], about the static state at `reference_stiffness` [N/m].

    Raises
    ------
    ValueError
        If the torque is not finite, or torque and load do not balance on the rigid-body mode of the structure.
    """
    if not np.isfinite(torque_nm):
        raise ValueError(f"torque_nm: received {torque_nm}; allowed are finite torques")
    half = law.half_backlash_m
    return equations_about(structure, torque_nm, reference_stiffness, half, -half, input_vectors)


def equations_about(
    structure: Structure,
    torque_nm: float,
    reference_stiffness: float,
    drive_gap_m: float,
    back_gap_m: float,
    input_vectors: FloatArray | None = None,
) -> Equations:
    """Return the equations for flanks that touch at the approach `drive_gap_m` or, on the other side, `back_gap_m`.

    `input_vectors` (m, n) are the generalised forces per unit of the inputs; None: no inputs.
    """
    p = structure.mesh_vector
    loaded = structure.stiffness + reference_stiffness * p[:, None] * p[None, :]
    elastic = static_solution(structure, loaded, structure.torque_vector * torque_nm)
    force = float(reference_stiffness * (p * elastic).sum())
    side = 1.0 if force >= 0.0 else -1.0
    touching = drive_gap_m if side > 0.0 else back_gap_m
    gap = static_solution(structure, loaded, p * (reference_stiffness * touching))
    vectors = np.empty((0, p.size)) if input_vectors is None else input_vectors
    return Equations(
        stiffness_by_mass=inverse_times(structure.mass, structure.stiffness),
        damping_by_mass=inverse_times(structure.mass, structure.damping),
        mesh_input=inverse_times(structure.mass, p),
        mesh_vector=np.array(p),
        static_deflection=elastic + gap,
        reference_stiffness=reference_stiffness,
        static_force=force,
        static_approach=force / reference_stiffness + touching,
        side=side,
        external_input=np.ascontiguousarray(inverse_times(structure.mass, vectors.T).T),
    )


def inverse_times(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Return matrix⁻¹ · right in row order: one memory layout, hence one compilation of the kernels."""
    return np.ascontiguousarray(np.linalg.solve(matrix, right), dtype=np.float64)


def start_state(structure: Structure, law: MeshLaw, equations: Equations, pitches: float) -> FloatArray:
    """Return z (2n,) at rest in the static equilibrium at the actual mesh stiffness, rigid rotation zero."""
    p = equations.mesh_vector
    actual = mesh_stiffness(law, pitches)
    loaded = structure.stiffness + actual * p[:, None] * p[None, :]
    penetration = equations.static_force / equations.reference_stiffness
    deviation = static_solution(structure, loaded, -p * ((actual - equations.reference_stiffness) * penetration))
    return np.concatenate([deviation, np.zeros_like(deviation)])


def state_matrix(equations: Equations, stiffness: float, damping: float) -> FloatArray:
    """Return A (2n, 2n) of ż = A z with a constant mesh stiffness [N/m] and mesh damping [N s/m]."""
    n = equations.mesh_vector.size
    dyad = equations.mesh_input[:, None] * equations.mesh_vector[None, :]
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    matrix[n:, :n] = -(equations.stiffness_by_mass + stiffness * dyad)
    matrix[n:, n:] = -(equations.damping_by_mass + damping * dyad)
    return matrix


@njit(cache=True)
def approach_of(equations: Equations, state: FloatArray) -> tuple[float, float]:
    """Return the approach δ [m] and its rate [m/s] of a state (2n,)."""
    n = equations.mesh_vector.size
    approach, rate = equations.static_approach, 0.0
    for i in range(n):
        approach += equations.mesh_vector[i] * state[i]
        rate += equations.mesh_vector[i] * state[n + i]
    return approach, rate


def no_inputs(pitches: FloatArray) -> FloatArray:
    """Return the inputs (steps + 1, 0) of a motion that has none, at the pinion angles `pitches` (steps + 1,)."""
    return np.empty((pitches.size, 0))


@njit(cache=True)
def external_push(external_input: FloatArray, inputs: FloatArray, push: FloatArray) -> None:
    """Write the accelerations (n,) by inputs (m,) along `external_input` (m, n) into `push`; without, it has none."""
    push[:] = 0.0
    for k in range(inputs.size):
        for i in range(push.size):
            push[i] += inputs[k] * external_input[k, i]


@njit(cache=True)
def state_rate(equations: Equations, law: MeshLaw, state: FloatArray, pitches: float, rate: FloatArray) -> None:
    """Write ż (2n,) of the state z (2n,) at the pinion angle `pitches` into `rate`."""
    n = equations.mesh_vector.size
    approach, approach_rate = approach_of(equations, state)
    excess = mesh_force(law, approach, approach_rate, pitches) - equations.static_force
    for i in range(n):
        rate[i] = state[n + i]
        total = -equations.mesh_input[i] * excess
        for j in range(n):
            total -= equations.stiffness_by_mass[i, j] * state[j] + equations.damping_by_mass[i, j] * state[n + j]
        rate[n + i] = total


@njit(cache=True)
def linear_rate(model: tuple[Equations, MeshLaw], state: FloatArray, pitches: float, rate: FloatArray) -> None:
    """Write ż of `state_rate` for a model (equations, law); the form that integrators call."""
    state_rate(model[0], model[1], state, pitches, rate)
