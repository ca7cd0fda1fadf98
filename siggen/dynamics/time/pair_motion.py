"""PairMotion: a structure under the forces of single tooth pairs, as what `response` steps through time.

Equations (derived, signs by power): M ẅ + C w' + K w = -p (ΣN - F_s) - r_0 ΣF - r_1 Σ s F, about the static state at
the mean mesh stiffness; p and r are the mesh and sliding vectors of the structure. The phase of the mesh is prescribed.
Where gears tilt, - t Σμ - t_x Σ ζ F come to the right side, with the moments μ of the pairs across the face and the
centre ζ = μ/N at which they rub; what tilting adds to the sliding speed, some 1e-6 of it, is left out.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.mesh import pair_columns as columns
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_forces import static_approach_m, write_forces
from siggen.dynamics.mesh.pair_internals import (
    PairContact,
    as_back_flanks,
    pair_internal_names,
    pair_internals,
    with_units,
)
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.dynamics.structure.free_rotation import free_rotations, static_solution
from siggen.dynamics.structure.load_lock import LOCK_HZ
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.equations import equations_about, external_push
from siggen.dynamics.time.pair_equations import PairEquations, pair_equations
from siggen.dynamics.time.runge_kutta import runge_kutta_step
from siggen.dynamics.time.transient import transient_s

LARGEST_SHIFT = 0.02
"""Of a base pitch: gears that shafts let move farther apart no longer mesh at their centre distance."""
MOTION = ("approach_m", "approach_rate_m_s")
ACROSS = ("mesh_tilt_rad", "mesh_moment_nm")
MEAN_ANGLES = 24
GOLDEN = 0.6180339887498949
"""Angles spread over all teeth and the path of contact."""


class MeanState(NamedTuple):
    """Motor torque, pinion speed and mesh stiffness of a mean; errors count against a light force at least."""

    torque_nm: float
    speed_hz: float
    stiffness_n_per_m: float
    light_force_n: float = 0.0


class PairMotion:
    """Steps with the classical Runge-Kutta method; works with any structure.

    `input_vectors` (m, n) are those of `equations_about`; `speed_input` is the number of the input that is Ω/Ω_0 - 1,
    or -1 where the speed is constant.
    """

    coarse_inputs = False
    starts_settled = True

    def __init__(
        self,
        structure: Structure,
        law: PairLaw,
        *,
        mean: MeanState,
        step_s: float,
        contact: PairContact | None = None,
        input_vectors: FloatArray | None = None,
        speed_input: int = -1,
    ) -> None:
        self.structure = structure
        self.law = law
        self.contact = contact
        self.equations = equations_about(
            structure, mean.torque_nm, mean.stiffness_n_per_m, 0.0, -law.backlash_m, input_vectors
        )
        self.pair_equations = pair_equations(structure, self.equations, mean.speed_hz)
        damping = law.damping_root_kg * float(np.sqrt(mean.stiffness_n_per_m))
        held_hz = 2.0 * LOCK_HZ if law.places[layout.ROUGHNESSES] > 0 else 0.0
        self.transient_s = transient_s(structure, self.equations, damping, held_hz)
        self.teeth = law.teeth
        self.largest_approach_m = law.backlash_m
        self.base_pitch_m = law.base_pitch_m
        self.tilts = structure.tilt_vector is not None
        across = ACROSS if self.tilts else ()
        self._bodies = structure.bodies
        moved = (structure.coordinates[i] for i in self._bodies)
        self.internal_names = (*pair_internal_names(law.slots, contact), *MOTION, *across, *with_units(moved))
        self._pairs = pair_table(law)
        self._step_s = step_s
        self._speed_input = speed_input

    def start(self, pitches: float) -> FloatArray:
        """Return the state (2n,) at rest in which the pairs at this angle carry the torque, moved by mean friction.

        A load that is held softly turns by it, for which it would need a second.

        Raises
        ------
        ValueError
            If shafts are so soft that gears tilt or move beyond the model.
        """
        if self.tilts:
            self._refuse_soft_shafts()
        state = self._standing(pitches)
        state[: self._rest.size] += self._rest
        return state

    def _standing(self, pitches: float) -> FloatArray:
        """Return the state (2n,) at rest in which the pairs at this angle carry the torque, without friction."""
        equations, p = self.equations, self.equations.mesh_vector
        approach = static_approach_m(self.law, equations.static_force, pitches)
        stiffness = equations.reference_stiffness
        loaded = self.structure.stiffness + stiffness * p[:, None] * p[None, :]
        moved = p * (stiffness * (approach - equations.static_approach))
        deviation = static_solution(self.structure, loaded, moved)
        return np.concatenate([deviation, np.zeros_like(deviation)])

    @cached_property
    def _rest(self) -> FloatArray:
        """The deflection (n,) by the mean of friction and its moments over the mesh, at rest and mean speed.

        None where nothing holds the load: friction then brakes it.
        """
        p = self.structure.mesh_vector
        loaded = self.structure.stiffness + self.equations.reference_stiffness * p[:, None] * p[None, :]
        if self.law.places[layout.ROUGHNESSES] == 0 or free_rotations(self.structure, loaded).shape[1] > 0:
            return np.zeros_like(p)
        angles = np.asarray(np.arange(MEAN_ANGLES) * self.teeth * GOLDEN % self.teeth, dtype=np.float64)
        pairs = self.pairs(np.stack([self._standing(angle) for angle in angles]), angles)
        friction, (r_0, r_1) = pairs[:, :, columns.FRICTION], self.structure.sliding_vectors
        push = -r_0 * friction.sum() - r_1 * (pairs[:, :, columns.POSITION] * friction).sum()
        return static_solution(self.structure, loaded, push / MEAN_ANGLES)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> NDArray[np.bool_] | None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""
        column = self._speed_input
        _advance(self.pair_equations, self.law, self._pairs, self._step_s, column, pitches, inputs, trajectory)
        return None

    def rate(self, state: FloatArray, pitches: float) -> FloatArray:
        """Return ż (2n,) of a state, for other solvers."""
        rate = np.empty_like(state)
        pair_rate((self.pair_equations, self.law, self._pairs), state, pitches, rate)
        return rate

    def refuse_outside(self, states: FloatArray) -> None:
        """Raise if the gears tilt so far in any of the states (k, 2n) that an end of the face meets the other flank.

        Raises
        ------
        ValueError
            With the tilt and its limit.
        """
        if self.structure.tilt_vector is not None:
            n = self.structure.tilt_vector.size
            tilt = self.pair_equations.static_tilt + states[:, :n] @ self.structure.tilt_vector
            approach = self.pair_equations.static_approach + states[:, :n] @ self.equations.mesh_vector
            self._refuse_tilt(tilt, approach, "in motion")

    def steps_apart(self, states: FloatArray, pitches: FloatArray) -> int:
        """Return at how many states no pair carries."""
        return _steps_apart(self.pair_equations, self.law, self._pairs, states, pitches)

    def _refuse_soft_shafts(self) -> None:
        """Raise where the static deflection alone is beyond the model."""
        static = self.pair_equations
        self._refuse_tilt(np.array([static.static_tilt]), np.array([static.static_approach]), "under the mean torque")
        moved = dict(zip(self.structure.coordinates, self.equations.static_deflection, strict=True))
        shift = max(abs(moved[name]) for name in ("x_1", "y_1", "x_2", "y_2"))
        if not shift <= LARGEST_SHIFT * self.base_pitch_m:
            raise ValueError(
                f"dynamics.shafts: a gear moves by {1e3 * shift:.3g} mm under the mean torque; allowed: at most "
                f"{1e3 * LARGEST_SHIFT * self.base_pitch_m:.3g} mm. Take thicker or shorter shafts, or a smaller torque"
            )

    def _refuse_tilt(self, tilt_rad: FloatArray, approach_m: FloatArray, when: str) -> None:
        """Raise where an end of the face lies behind the flank that it faces by more than the backlash.

        Flanks that have parted, and those on the back flank, are counted as if they just touched: there the gap is that
        in the middle of the face.
        """
        half_face, backlash = self.law.half_face_m, self.law.backlash_m
        approach_m = np.maximum(approach_m, 0.0)
        beyond = half_face * np.abs(tilt_rad) - approach_m - backlash
        worst = int(np.argmax(beyond)) if tilt_rad.size and half_face > 0.0 else -1
        if worst >= 0 and not beyond[worst] <= 0.0:
            raise ValueError(
                f"dynamics.shafts: the flanks tilt by {1e6 * abs(tilt_rad[worst]):.0f} urad {when}; allowed: at most "
                f"{1e6 * (backlash + approach_m[worst]) / half_face:.0f}, where an end of the face meets the other "
                "flank. Take thicker or shorter shafts, a gear nearer the middle, a narrower face, more backlash or a "
                "smaller torque"
            )

    def pairs(self, states: FloatArray, pitches: FloatArray, inputs: FloatArray | None = None) -> FloatArray:
        """Return the table of pairs of every state (k, slots, COLUMNS), see `pair_law`; without inputs at Ω_0."""
        result = np.stack([pair_table(self.law)] * len(states))
        speed_deviation = (
            np.zeros(len(states)) if inputs is None or self._speed_input < 0 else inputs[:, self._speed_input]
        )
        _all_pairs(self.pair_equations, self.law, states, pitches, np.ascontiguousarray(speed_deviation), result)
        return result

    def internals(self, states: FloatArray, pitches: FloatArray, inputs: FloatArray | None = None) -> FloatArray:
        """Return the values named in `internal_names` (k, names) of states (k, 2n)."""
        n = self.equations.mesh_vector.size
        pairs = self.pairs(states, pitches, inputs)
        found = pair_internals(pairs, self.law.line_of_action_m, self.contact)
        approach = [
            self.equations.static_approach + (states[:, :n] * self.equations.mesh_vector).sum(axis=1),
            (states[:, n:] * self.equations.mesh_vector).sum(axis=1),
        ]
        if self.tilts:
            approach += [pairs[:, 0, columns.TILT], pairs[:, :, columns.MOMENT].sum(axis=1)]
        moved = (states[:, :n] + self.equations.static_deflection)[:, self._bodies]
        if self.structure.flanks.side < 0.0:
            found = as_back_flanks(found, self.law.slots, self.law.line_of_action_m, self.contact)
            approach[:2] = [-self.law.backlash_m - approach[0], -approach[1]]
        return np.concatenate([found, np.stack(approach, axis=1), moved], axis=1)


@njit(cache=True)
def _at_speed(equations: PairEquations, speed_deviation: float) -> PairEquations:
    """Return the equations at the speed Ω_0 (1 + speed_deviation)."""
    ratio = 1.0 + speed_deviation
    return PairEquations(
        equations.rows,
        equations.static_force,
        equations.static_approach,
        equations.rigid_sliding_0 * ratio,
        equations.rigid_sliding_1 * ratio,
        equations.external_input,
        equations.static_tilt,
    )


# Inlined: taking arrays out of tuples again and again costs as much as the forces (see `packed_tables`).
@njit(cache=True, inline="always")
def _load_pairs(
    equations: PairEquations, law: PairLaw, pairs: FloatArray, state: FloatArray, pitches: float
) -> tuple[float, float, float, float, float]:
    """Write the table of pairs of a state; return ΣN, ΣF, Σ s F, Σμ and Σ ζ F."""
    rows, node = equations.rows, pairs[:1, pairs.shape[1] - columns.NODE_ROWS :].T
    n = rows.shape[1]
    approach, approach_rate = equations.static_approach, 0.0
    sliding_0, sliding_1 = equations.rigid_sliding_0, equations.rigid_sliding_1
    for i in range(n):
        approach += rows[2 * n, i] * state[i]
        approach_rate += rows[2 * n, i] * state[n + i]
        sliding_0 += rows[2 * n + 1, i] * state[n + i]
        sliding_1 += rows[2 * n + 2, i] * state[n + i]
    node[columns.NODE_APPROACH, 0], node[columns.NODE_RATE, 0] = approach, approach_rate
    node[columns.NODE_SLIDING_0, 0], node[columns.NODE_SLIDING_1, 0] = sliding_0, sliding_1
    if rows.shape[0] > 2 * n + 6:
        tilt, tilt_rate = equations.static_tilt, 0.0
        for i in range(n):
            tilt += rows[2 * n + 6, i] * state[i]
            tilt_rate += rows[2 * n + 6, i] * state[n + i]
        node[columns.NODE_TILT, 0], node[columns.NODE_TILT_RATE, 0] = tilt, tilt_rate
    write_forces(law, pitches, pairs)
    return (
        node[columns.NODE_NORMAL, 0],
        node[columns.NODE_FRICTION, 0],
        node[columns.NODE_ARM, 0],
        node[columns.NODE_MOMENT, 0],
        node[columns.NODE_TURN, 0],
    )


# Inlined for the same reason; the forces themselves are not, since that would make five compilations of them.
@njit(cache=True, inline="always")
def pair_rate(
    model: tuple[PairEquations, PairLaw, FloatArray], state: FloatArray, pitches: float, rate: FloatArray
) -> None:
    """Write ż (2n,) of a state into `rate`; the form that integrators call."""
    equations, law, pairs = model
    normal, friction, moment, across, rubbed = _load_pairs(equations, law, pairs, state, pitches)
    excess = normal - equations.static_force
    rows = equations.rows
    n = rows.shape[1]
    for i in range(n):
        rate[i] = state[n + i]
        rate[n + i] = -(rows[2 * n + 3, i] * excess + rows[2 * n + 4, i] * friction + rows[2 * n + 5, i] * moment)
    if rows.shape[0] > 2 * n + 6:
        for i in range(n):
            rate[n + i] -= rows[2 * n + 7, i] * across + rows[2 * n + 8, i] * rubbed
    # Columns outside, so that the inner loop carries no sum and runs on several rates at once; displacement and
    # velocity of a coordinate together, which halves the traffic to memory.
    for j in range(n):
        displacement, velocity = state[j], state[n + j]
        for i in range(n):
            rate[n + i] += rows[j, i] * displacement + rows[n + j, i] * velocity


@njit(cache=True)
def _advance(
    equations: PairEquations,
    law: PairLaw,
    pairs: FloatArray,
    step_s: float,
    speed_input: int,
    pitches: FloatArray,
    inputs: FloatArray,
    trajectory: FloatArray,
) -> None:
    scratch = np.empty((3, trajectory.shape[1]))
    pushes = np.empty((2, trajectory.shape[1] // 2 if inputs.shape[1] > 0 else 0))
    model = (equations, law, pairs)
    for i in range(pitches.size - 1):
        start, end = trajectory[i], trajectory[i + 1]
        external_push(equations.external_input, inputs[i], pushes[0])
        external_push(equations.external_input, inputs[i + 1], pushes[1])
        if speed_input >= 0:
            model = (_at_speed(equations, 0.5 * (inputs[i, speed_input] + inputs[i + 1, speed_input])), law, pairs)
        runge_kutta_step(pair_rate, model, step_s, (pitches[i], pitches[i + 1]), pushes, start, end, scratch)


@njit(cache=True)
def _steps_apart(
    equations: PairEquations, law: PairLaw, pairs: FloatArray, states: FloatArray, pitches: FloatArray
) -> int:
    count = 0
    for i in range(states.shape[0]):
        _load_pairs(equations, law, pairs, states[i], pitches[i])
        touching = False
        for j in range(pairs.shape[0]):
            touching = touching or pairs[j, columns.FLANK] != 0.0
        if not touching:
            count += 1
    return count


@njit(cache=True)
def _all_pairs(
    equations: PairEquations,
    law: PairLaw,
    states: FloatArray,
    pitches: FloatArray,
    speed_deviation: FloatArray,
    result: FloatArray,
) -> None:
    for i in range(states.shape[0]):
        _load_pairs(_at_speed(equations, speed_deviation[i]), law, result[i], states[i], pitches[i])
