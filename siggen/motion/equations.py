"""Equations of motion about the static equilibrium at the mean mesh stiffness, in the form the integrators take.

With q = q_s + w and K_0 q_s + Σ p F_s = f over the meshes (derived):
M ẅ + C_0 ẇ + K_0 w = -Σ p (F - F_s) + Σ_k v_k u_k(t), F = mesh force at δ_s + pᵀw; inputs u_k act beside the constant
torque, along constant vectors v_k. The state is z = [w, ẇ]. Small deviations instead of the static twist of the shafts
keep double precision over long records.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.drivetrain.structure import MeshVectors, Structure, rolling, static_solution, vector, without_drift
from siggen.mesh import pair_columns as columns
from siggen.mesh.mesh_force import MeshLaw, mesh_force, mesh_stiffness
from siggen.mesh.node_forces import write_forces
from siggen.mesh.pair_law import PairLaw


class Equations(NamedTuple):
    """Constant numbers of the equations of motion (a named tuple, since compiled code takes no dataclass).

    `stiffness_by_mass`, `damping_by_mass` (n, n): M⁻¹K_0, M⁻¹C_0; `external_input` (m, n): M⁻¹ v_k;
    `static_deflection` (n,): q_s. Of each mesh (meshes, ...): `mesh_input` (n,) M⁻¹p; `mesh_vector` (n,) p;
    `reference_stiffness`: mean mesh stiffness that q_s belongs to; `static_force`: F_s; `static_approach`: δ_s;
    `side`: +1 if the mean torque loads the drive flank, else -1.
    """

    stiffness_by_mass: FloatArray
    damping_by_mass: FloatArray
    mesh_input: FloatArray
    mesh_vector: FloatArray
    static_deflection: FloatArray
    reference_stiffness: FloatArray
    static_force: FloatArray
    static_approach: FloatArray
    side: FloatArray
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
        If torque and load do not balance on the rigid-body mode of the structure.
    """
    half = law.half_backlash_m
    touching_m = np.array([[half, -half]])
    return equations_about(structure, torque_nm, np.array([reference_stiffness]), touching_m, input_vectors)


def equations_about(
    structure: Structure,
    torque_nm: float,
    reference_stiffness: FloatArray,
    touching_m: FloatArray,
    input_vectors: FloatArray | None = None,
    steady: FloatArray | float = 0.0,
) -> Equations:
    """Return the equations about the static state of a torque, and of steady forces beside it.

    Parameters
    ----------
    structure : Structure
    torque_nm : float
    reference_stiffness : (meshes,)
    touching_m : (meshes, 2)
        Approach at which drive flanks touch, and back flanks.
    input_vectors : (m, n) or None
        Generalised forces per unit of the inputs; None: no inputs.
    steady : (n,)
        Balanced generalised forces.
    """
    p = np.array([mesh.vector for mesh in structure.meshes])
    loaded = structure.stiffness + mesh_springs(structure, reference_stiffness)
    elastic = static_solution(structure, loaded, structure.torque_vector * torque_nm + steady)
    force = np.array([float(k * (row * elastic).sum()) for k, row in zip(reference_stiffness, p, strict=True)])
    touching = np.where(force >= 0.0, touching_m[:, 0], touching_m[:, 1])
    pushed = p * (reference_stiffness * touching)[:, None]
    gap = static_solution(structure, loaded, np.add.reduce(pushed))
    vectors = np.empty((0, p.shape[1])) if input_vectors is None else input_vectors
    return Equations(
        stiffness_by_mass=inverse_times(structure.mass, structure.stiffness),
        damping_by_mass=inverse_times(structure.mass, structure.damping),
        mesh_input=np.stack([inverse_times(structure.mass, row) for row in p]),
        mesh_vector=p,
        static_deflection=elastic + gap,
        reference_stiffness=np.array(reference_stiffness),
        static_force=force,
        static_approach=force / reference_stiffness + touching,
        side=np.where(force >= 0.0, 1.0, -1.0),
        external_input=np.ascontiguousarray(inverse_times(structure.mass, vectors.T).T),
    )


def mesh_springs(structure: Structure, stiffness: FloatArray) -> FloatArray:
    """Return Σ k p pᵀ (n, n) of the meshes with a constant stiffness (meshes,) [N/m] each."""
    parts = zip(stiffness, structure.meshes, strict=True)
    return np.asarray(np.add.reduce([k * mesh.vector[:, None] * mesh.vector[None, :] for k, mesh in parts]))


def inverse_times(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Return matrix⁻¹ · right in row order: one memory layout, hence one compilation of the kernels."""
    return np.ascontiguousarray(np.linalg.solve(matrix, right), dtype=np.float64)


def start_state(structure: Structure, law: MeshLaw, equations: Equations, pitches: float) -> FloatArray:
    """Return z (2n,) at rest in the static equilibrium at the actual mesh stiffness, rigid rotation zero."""
    p, actual = equations.mesh_vector[0], mesh_stiffness(law, pitches)
    loaded = structure.stiffness + actual * p[:, None] * p[None, :]
    reference = equations.reference_stiffness[0]
    penetration = equations.static_force[0] / reference
    deviation = static_solution(structure, loaded, -p * ((actual - reference) * penetration))
    return np.concatenate([deviation, np.zeros_like(deviation)])


def state_matrix(equations: Equations, stiffness: FloatArray, damping: FloatArray) -> FloatArray:
    """Return A (2n, 2n) of ż = A z with a constant stiffness [N/m] and damping [N s/m] (meshes,) of every mesh."""
    n = equations.mesh_vector.shape[1]
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    on_place, on_speed = equations.stiffness_by_mass, equations.damping_by_mass
    for m in range(len(equations.mesh_vector)):
        dyad = equations.mesh_input[m][:, None] * equations.mesh_vector[m][None, :]
        on_place, on_speed = on_place + stiffness[m] * dyad, on_speed + damping[m] * dyad
    matrix[n:, :n], matrix[n:, n:] = -on_place, -on_speed
    return matrix


@entry(cache=True)
def approach_of(equations: Equations, mesh: int, state: FloatArray) -> tuple[float, float]:
    """Return the approach δ [m] of a mesh and its rate [m/s] in a state (2n,)."""
    n = equations.mesh_vector.shape[1]
    approach, rate = equations.static_approach[mesh], 0.0
    for i in range(n):
        approach += equations.mesh_vector[mesh, i] * state[i]
        rate += equations.mesh_vector[mesh, i] * state[n + i]
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


@entry(cache=True)
def state_rate(equations: Equations, law: MeshLaw, state: FloatArray, pitches: float, rate: FloatArray) -> None:
    """Write ż (2n,) of the state z (2n,) at the pinion angle `pitches` into `rate`."""
    n = equations.mesh_vector.shape[1]
    approach, approach_rate = approach_of(equations, 0, state)
    excess = mesh_force(law, approach, approach_rate, pitches) - equations.static_force[0]
    for i in range(n):
        rate[i] = state[n + i]
        total = -equations.mesh_input[0, i] * excess
        for j in range(n):
            total -= equations.stiffness_by_mass[i, j] * state[j] + equations.damping_by_mass[i, j] * state[n + j]
        rate[n + i] = total


@njit(cache=True)
def linear_rate(model: tuple[Equations, MeshLaw], state: FloatArray, pitches: float, rate: FloatArray) -> None:
    """Write ż of `state_rate` for a model (equations, law); the form that integrators call."""
    state_rate(model[0], model[1], state, pitches, rate)


# PairEquations: constant numbers of the equations of motion under the forces of tooth pairs (`pair_motion`).

FORCE, APPROACH, TILT = range(3)
"""Columns of `PairEquations.static`."""
UPRIGHT, TILTING = 6, 9
"""Rows of a mesh in `PairEquations.rows`, without and with tilt."""


class PairEquations(NamedTuple):
    """Constant numbers of the equations of motion and how sliding enters them.

    `rows` (2n + 6 meshes, n), one array for speed (see `packed_tables`): the columns of -M⁻¹K and of -M⁻¹C; then of
    each mesh p, r_0, r_1, M⁻¹ p, M⁻¹ r_0, M⁻¹ r_1, and where gears tilt t, M⁻¹ t and M⁻¹ t_x; those of the
    friction without drift (`shaft_lines.without_drift`). `static` (meshes, 3):
    force, approach and tilt that deviations count from. `rigid_sliding` (meshes, 2): sliding speed at s of the rigid
    rotation is the first plus s times the second [m/s, 1/s]. `places` (meshes, 2): base pitches that a mesh has turned
    are the first times those of the first mesh, plus the second. `external_input` (m, n): see `Equations`.
    """

    rows: FloatArray
    static: FloatArray
    rigid_sliding: FloatArray
    places: FloatArray
    external_input: FloatArray


def pair_equations(structure: Structure, equations: Equations, speed_hz: float, places: FloatArray) -> PairEquations:
    """Return the numbers of a structure about a state, at a mean speed of its first shaft."""
    omega = 2.0 * np.pi * speed_hz
    parts = [-equations.stiffness_by_mass.T, -equations.damping_by_mass.T]
    static, rigid = [], []
    for number, mesh in enumerate(structure.meshes):
        parts += _mesh_rows(structure, equations, number)
        tilt = 0.0 if mesh.tilt is None else float(mesh.tilt @ equations.static_deflection)
        static.append([equations.static_force[number], equations.static_approach[number], tilt])
        rigid.append(mesh.sliding @ _rolling(structure, mesh) * omega)
    return PairEquations(
        np.ascontiguousarray(np.concatenate(parts)), np.array(static), np.array(rigid), places,
        equations.external_input,
    )  # fmt: skip


def _mesh_rows(structure: Structure, equations: Equations, number: int) -> list[FloatArray]:
    mesh = structure.meshes[number]
    inputs = inverse_times(structure.mass, without_drift(structure, mesh.sliding).T).T
    rows = [mesh.vector[None], mesh.sliding, equations.mesh_input[number][None], inputs]
    if mesh.tilt is not None:
        arms = np.stack([mesh.tilt, mesh.friction_tilt], axis=1)
        rows += [mesh.tilt[None], inverse_times(structure.mass, arms).T]
    return rows


def _rolling(structure: Structure, mesh: MeshVectors) -> FloatArray:
    """Return how fast the gears of a mesh turn (n,) per speed of the first shaft when nothing deforms."""
    turning = rolling(structure)
    return vector(structure.coordinates, {name: turning[structure.coordinates.index(name)] for name in mesh.turning})


# The rate of a state under the forces of tooth pairs, compiled; equations: `pair_motion`.


@njit(cache=True)
def at_speed(equations: PairEquations, speed_deviation: float) -> PairEquations:
    """Return the equations at the speed Ω_0 (1 + speed_deviation)."""
    return PairEquations(
        equations.rows,
        equations.static,
        equations.rigid_sliding * (1.0 + speed_deviation),
        equations.places,
        equations.external_input,
    )


# Inlined: taking arrays out of tuples again and again costs as much as the forces (see `packed_tables`).
@njit(cache=True, inline="always")
def load_pairs(
    equations: PairEquations, mesh: int, law: PairLaw, pairs: FloatArray, state: FloatArray, pitches: float
) -> tuple[float, float, float, float, float]:
    """Write the table of pairs of a mesh in a state; return ΣN, ΣF, Σ s F, Σμ and Σ ζ F."""
    rows, node = equations.rows, pairs[0, pairs.shape[1] - columns.NODE_ROWS :].reshape(columns.NODE_ROWS, 1)
    n = rows.shape[1]
    block = (rows.shape[0] - 2 * n) // equations.static.shape[0]
    first = 2 * n + mesh * block
    approach, approach_rate = equations.static[mesh, APPROACH], 0.0
    sliding_0, sliding_1 = equations.rigid_sliding[mesh, 0], equations.rigid_sliding[mesh, 1]
    for i in range(n):
        approach += rows[first, i] * state[i]
        approach_rate += rows[first, i] * state[n + i]
        sliding_0 += rows[first + 1, i] * state[n + i]
        sliding_1 += rows[first + 2, i] * state[n + i]
    node[columns.NODE_APPROACH, 0], node[columns.NODE_RATE, 0] = approach, approach_rate
    node[columns.NODE_SLIDING_0, 0], node[columns.NODE_SLIDING_1, 0] = sliding_0, sliding_1
    if block > UPRIGHT:
        tilt, tilt_rate = equations.static[mesh, TILT], 0.0
        for i in range(n):
            tilt += rows[first + 6, i] * state[i]
            tilt_rate += rows[first + 6, i] * state[n + i]
        node[columns.NODE_TILT, 0], node[columns.NODE_TILT_RATE, 0] = tilt, tilt_rate
    write_forces(law, pitches * equations.places[mesh, 0] + equations.places[mesh, 1], pairs)
    return (
        node[columns.NODE_NORMAL, 0],
        node[columns.NODE_FRICTION, 0],
        node[columns.NODE_ARM, 0],
        node[columns.NODE_MOMENT, 0],
        node[columns.NODE_TURN, 0],
    )


# Inlined for the same reason; the forces themselves are not, since that would make five compilations of them.
@entry(cache=True, inline="always")
def pair_rate(
    model: tuple[PairEquations, tuple[PairLaw, ...], tuple[FloatArray, ...]],
    state: FloatArray,
    pitches: float,
    rate: FloatArray,
) -> None:
    """Write ż (2n,) of a state into `rate`; the form that integrators call."""
    equations, laws, pairs = model
    rows = equations.rows
    n = rows.shape[1]
    block = (rows.shape[0] - 2 * n) // equations.static.shape[0]
    for i in range(n):
        rate[i] = state[n + i]
        rate[n + i] = 0.0
    for m in range(len(laws)):
        normal, friction, moment, across, rubbed = load_pairs(equations, m, laws[m], pairs[m], state, pitches)
        excess, first = normal - equations.static[m, FORCE], 2 * n + m * block
        for i in range(n):
            rate[n + i] -= rows[first + 3, i] * excess + rows[first + 4, i] * friction + rows[first + 5, i] * moment
        if block > UPRIGHT:
            for i in range(n):
                rate[n + i] -= rows[first + 7, i] * across + rows[first + 8, i] * rubbed
    # Columns outside, so that the inner loop carries no sum and runs on several rates at once; displacement and
    # velocity of a coordinate together, which halves the traffic to memory.
    for j in range(n):
        displacement, velocity = state[j], state[n + j]
        for i in range(n):
            rate[n + i] += rows[j, i] * displacement + rows[n + j, i] * velocity


@entry(cache=True)
def steps_apart(
    equations: PairEquations, mesh: int, law: PairLaw, pairs: FloatArray, states: FloatArray, pitches: FloatArray
) -> int:
    """Return at how many states (k, 2n) no pair of a mesh touches."""
    count = 0
    for i in range(states.shape[0]):
        load_pairs(equations, mesh, law, pairs, states[i], pitches[i])
        touching = False
        for j in range(pairs.shape[0]):
            touching = touching or pairs[j, columns.FLANK] != 0.0
        if not touching:
            count += 1
    return count
