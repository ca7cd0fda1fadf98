"""PairMotion: a structure under the forces of single tooth pairs, as what `response` steps through time.

Equations (derived, signs by power): M ẅ + C w' + K w = -p (ΣN - F_s) - r_0 ΣF - r_1 Σ s F, about the static state at
the mean mesh stiffness; p and r are the mesh and sliding vectors of the structure. The phase of the mesh is prescribed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from siggen.dynamics.equations import Equations, approach_of, equations_about, inverse_times
from siggen.dynamics.free_rotation import static_solution
from siggen.dynamics.pair_law import (
    COLUMNS,
    FLANK,
    FRICTION,
    NORMAL,
    POSITION,
    SLIDING,
    STIFFNESS,
    PairLaw,
    pair_forces,
    pair_slots,
    static_approach_m,
)
from siggen.dynamics.runge_kutta import runge_kutta_step
from siggen.dynamics.structure import Structure, vector
from siggen.dynamics.transient import transient_s

FloatArray = NDArray[np.float64]

SUMS = (
    "mesh_force_n",
    "mesh_stiffness_n_per_m",
    "mesh_damping_n_s_per_m",
    "approach_m",
    "approach_rate_m_s",
    "friction_force_n",
    "friction_moment_pinion_nm",
    "friction_moment_gear_nm",
)
PER_PAIR = ("force_n", "load_share", "friction_n", "sliding_m_s", "position_m")


class PairEquations(NamedTuple):
    """Linear equations of motion and how sliding enters them.

    `sliding_vectors`, `sliding_input` (2, n): r and M⁻¹ r; `rigid_sliding_0`, `rigid_sliding_1`: sliding speed at s of
    the rigid rotation is the first plus s times the second [m/s, 1/s].
    """

    linear: Equations
    sliding_vectors: FloatArray
    sliding_input: FloatArray
    rigid_sliding_0: float
    rigid_sliding_1: float


class PairMotion:
    """Steps with the classical Runge-Kutta method; works with any structure."""

    def __init__(
        self,
        structure: Structure,
        law: PairLaw,
        *,
        torque_nm: float,
        speed_hz: float,
        reference_stiffness_n_per_m: float,
        step_s: float,
    ) -> None:
        self.structure = structure
        self.law = law
        self.equations = equations_about(structure, torque_nm, reference_stiffness_n_per_m, 0.0, -law.backlash_m)
        self.pair_equations = _pair_equations(structure, self.equations, speed_hz)
        damping = law.damping_root_kg * float(np.sqrt(reference_stiffness_n_per_m))
        self.transient_s = transient_s(structure, self.equations, damping)
        self.teeth = law.kind_of_tooth_1.size
        self.largest_approach_m = law.backlash_m
        self.base_pitch_m = law.base_pitch_m
        self.internal_names = _names(structure, pair_slots(law))
        self._pairs = np.zeros((pair_slots(law), COLUMNS))
        self._step_s = step_s

    def start(self, pitches: float) -> FloatArray:
        """Return the state (2n,) at rest in which the pairs at this angle carry the torque, without friction."""
        equations, p = self.equations, self.equations.mesh_vector
        approach = static_approach_m(self.law, equations.static_force, pitches)
        stiffness = equations.reference_stiffness
        loaded = self.structure.stiffness + stiffness * p[:, None] * p[None, :]
        moved = p * (stiffness * (approach - equations.static_approach))
        deviation = static_solution(self.structure, loaded, moved)
        return np.concatenate([deviation, np.zeros_like(deviation)])

    def advance(self, pitches: FloatArray, trajectory: FloatArray) -> None:
        """Fill rows 1.. of `trajectory` (steps + 1, 2n) from row 0, with the pinion angles `pitches` (steps + 1,)."""
        _advance(self.pair_equations, self.law, self._pairs, self._step_s, pitches, trajectory)

    def rate(self, state: FloatArray, pitches: float) -> FloatArray:
        """Return ż (2n,) of a state, for other solvers."""
        rate = np.empty_like(state)
        pair_rate((self.pair_equations, self.law, self._pairs), state, pitches, rate)
        return rate

    def steps_apart(self, states: FloatArray, pitches: FloatArray) -> int:
        """Return at how many states no pair carries."""
        return _steps_apart(self.pair_equations, self.law, self._pairs, states, pitches)

    def pairs(self, states: FloatArray, pitches: FloatArray) -> FloatArray:
        """Return the table of pairs of every state (k, slots, COLUMNS), see `pair_law`."""
        result = np.empty((len(states), *self._pairs.shape))
        _all_pairs(self.pair_equations, self.law, states, pitches, result)
        return result

    def internals(self, states: FloatArray, pitches: FloatArray) -> FloatArray:
        """Return the values named in `internal_names` (k, names) of states (k, 2n)."""
        n = self.equations.mesh_vector.size
        pairs = self.pairs(states, pitches)
        normal, friction, position = (pairs[:, :, column] for column in (NORMAL, FRICTION, POSITION))
        total = normal.sum(axis=1)
        stiffness = np.where(pairs[:, :, FLANK] != 0.0, pairs[:, :, STIFFNESS], 0.0).sum(axis=1)
        sums = [
            total,
            stiffness,
            self.law.damping_root_kg * np.sqrt(stiffness),
            self.equations.static_approach + (states[:, :n] * self.equations.mesh_vector).sum(axis=1),
            (states[:, n:] * self.equations.mesh_vector).sum(axis=1),
            friction.sum(axis=1),
            (position * friction).sum(axis=1),
            ((self.law.line_of_action_m - position) * friction).sum(axis=1),
        ]
        share = normal / np.where(total == 0.0, 1.0, total)[:, None]
        single = np.stack([normal, share, friction, pairs[:, :, SLIDING], position], axis=2)
        moved = states[:, :n] + self.equations.static_deflection
        return np.concatenate([np.stack(sums, axis=1), single.reshape(len(states), -1), moved], axis=1)


def _names(structure: Structure, slots: int) -> tuple[str, ...]:
    """Return the names of the internals; pair n of an engagement has the number n mod slots."""
    pairs = tuple(f"pair_{slot}_{name}" for slot in range(slots) for name in PER_PAIR)
    units = {True: "rad", False: "m"}
    turning = ("theta", "phi")
    return (*SUMS, *pairs, *(f"{name}_{units[name.startswith(turning)]}" for name in structure.coordinates))


def _pair_equations(structure: Structure, equations: Equations, speed_hz: float) -> PairEquations:
    omega = 2.0 * np.pi * speed_hz
    p = dict(zip(structure.coordinates, structure.mesh_vector, strict=True))
    rolling = {"theta_1": 1.0, "theta_2": -p["theta_1"] / p["theta_2"]}
    rigid = structure.sliding_vectors @ vector(structure.coordinates, rolling) * omega
    inputs = np.ascontiguousarray(inverse_times(structure.mass, structure.sliding_vectors.T).T)
    return PairEquations(equations, np.array(structure.sliding_vectors), inputs, float(rigid[0]), float(rigid[1]))


@njit(cache=True)
def _load_pairs(
    equations: PairEquations, law: PairLaw, pairs: FloatArray, state: FloatArray, pitches: float
) -> tuple[float, float, float]:
    """Write the table of pairs of a state; return ΣN, ΣF and Σ s F."""
    n = equations.linear.mesh_vector.size
    approach, approach_rate = approach_of(equations.linear, state)
    sliding_0, sliding_1 = equations.rigid_sliding_0, equations.rigid_sliding_1
    for i in range(n):
        sliding_0 += equations.sliding_vectors[0, i] * state[n + i]
        sliding_1 += equations.sliding_vectors[1, i] * state[n + i]
    pair_forces(law, approach, approach_rate, pitches, sliding_0, sliding_1, pairs)
    normal, friction, moment = 0.0, 0.0, 0.0
    for i in range(pairs.shape[0]):
        normal += pairs[i, NORMAL]
        friction += pairs[i, FRICTION]
        moment += pairs[i, POSITION] * pairs[i, FRICTION]
    return normal, friction, moment


@njit(cache=True)
def pair_rate(
    model: tuple[PairEquations, PairLaw, FloatArray], state: FloatArray, pitches: float, rate: FloatArray
) -> None:
    """Write ż (2n,) of a state into `rate`; the form that integrators call."""
    equations, law, pairs = model
    linear = equations.linear
    n = linear.mesh_vector.size
    normal, friction, moment = _load_pairs(equations, law, pairs, state, pitches)
    excess = normal - linear.static_force
    for i in range(n):
        rate[i] = state[n + i]
        total = -linear.mesh_input[i] * excess
        total -= equations.sliding_input[0, i] * friction + equations.sliding_input[1, i] * moment
        for j in range(n):
            total -= linear.stiffness_by_mass[i, j] * state[j] + linear.damping_by_mass[i, j] * state[n + j]
        rate[n + i] = total


@njit(cache=True)
def _advance(
    equations: PairEquations,
    law: PairLaw,
    pairs: FloatArray,
    step_s: float,
    pitches: FloatArray,
    trajectory: FloatArray,
) -> None:
    scratch = np.empty((3, trajectory.shape[1]))
    model = (equations, law, pairs)
    for i in range(pitches.size - 1):
        start, end = trajectory[i], trajectory[i + 1]
        runge_kutta_step(pair_rate, model, step_s, pitches[i], pitches[i + 1], start, end, scratch)


@njit(cache=True)
def _steps_apart(
    equations: PairEquations, law: PairLaw, pairs: FloatArray, states: FloatArray, pitches: FloatArray
) -> int:
    count = 0
    for i in range(states.shape[0]):
        _load_pairs(equations, law, pairs, states[i], pitches[i])
        touching = False
        for j in range(pairs.shape[0]):
            touching = touching or pairs[j, FLANK] != 0.0
        if not touching:
            count += 1
    return count


@njit(cache=True)
def _all_pairs(
    equations: PairEquations, law: PairLaw, states: FloatArray, pitches: FloatArray, result: FloatArray
) -> None:
    for i in range(states.shape[0]):
        _load_pairs(equations, law, result[i], states[i], pitches[i])
