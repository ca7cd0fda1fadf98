"""PairMotion: a structure under the forces of single tooth pairs, as what `response` steps through time.

Equations (derived, signs by power): M ẅ + C w' + K w = -p (ΣN - F_s) - f_0 ΣF - f_1 Σ s F of every mesh, about the
static state at the mean mesh stiffness; p and r are the vectors of the mesh, f those r without what moves the train
as a whole: how that turns is prescribed, with it the phase of every mesh. The load is less by what friction takes on
the mean: bodies turn at one speed, and every shaft is in balance.
Where gears tilt, - t Σμ - t_x Σ ζ F come to the right side, with the moments μ of the pairs across the face and the
centre ζ = μ/N at which they rub; what tilting adds to the sliding speed, some 1e-6 of it, is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.drivetrain.structure import (
    Structure,
    driven_and_loaded,
    rigid_rotation,
    rolling,
    static_solution,
    vector,
    without_drift,
)
from siggen.mesh import pair_columns as columns
from siggen.mesh import pair_law as layout
from siggen.mesh.node_forces import static_approach_m
from siggen.mesh.pair_internals import PairContact, as_back_flanks, pair_internal_names, pair_internals, with_units
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table
from siggen.motion.equations import (
    APPROACH,
    TILT,
    PairEquations,
    at_speed,
    equations_about,
    external_push,
    load_pairs,
    mesh_springs,
    pair_equations,
    pair_rate,
    steps_apart,
)
from siggen.motion.motion import APPROACH_LIMIT_PITCHES, decay_s, transient_s
from siggen.motion.runge_kutta import runge_kutta_step

LARGEST_SHIFT = 0.02
"""Of a base pitch: gears that shafts let move farther apart no longer mesh at their centre distance."""
MOTION = ("approach_m", "approach_rate_m_s")
ACROSS = ("mesh_tilt_rad", "mesh_moment_nm")
MEAN_ANGLES = 24
GOLDEN = 0.6180339887498949
"""Angles spread over all teeth and the path of contact."""


class MeanState(NamedTuple):
    """Motor torque and speed of the first shaft of a mean; the speed against the structure's frame."""

    torque_nm: float
    speed_hz: float


class PairMesh(NamedTuple):
    """Law of one mesh and its mean stiffness; errors count against a light force at least.

    `begins_pitches`: base pitches that it has turned where the first mesh has turned none.
    """

    law: PairLaw
    stiffness_n_per_m: float
    light_force_n: float = 0.0
    contact: PairContact | None = None
    begins_pitches: float = 0.0


class PairMotion:
    """Steps with the classical Runge-Kutta method; works with any structure.

    `meshes` in the order of those of the structure. `input_vectors` (m, n) are those of `equations_about`;
    `speed_input` is the number of the input that is Ω/Ω_0 - 1, or -1 where the speed is constant. `load_relief_nm`: by
    how much mean friction makes the load's torque [N m] less than the ratio would.
    """

    coarse_inputs = False
    stride = 1
    starts_settled = True

    def __init__(
        self,
        structure: Structure,
        meshes: Sequence[PairMesh],
        *,
        mean: MeanState,
        step_s: float,
        input_vectors: FloatArray | None = None,
        speed_input: int = -1,
    ) -> None:
        self.structure, self.meshes = structure, tuple(meshes)
        self._step_s, self._speed_input = step_s, speed_input
        self.laws = tuple(mesh.law for mesh in meshes)
        self._stiffness = np.array([mesh.stiffness_n_per_m for mesh in meshes])
        touching_m = np.array([[0.0, -law.backlash_m] for law in self.laws])
        about = structure, mean.torque_nm, self._stiffness, touching_m, input_vectors
        self.equations = equations_about(*about)
        self.teeth = self.laws[0].teeth
        self.pair_equations = pair_equations(structure, self.equations, mean.speed_hz, self._places())
        self._rubbing, self.load_relief_nm = self._mean_friction(), 0.0
        if self._rubbing.any():
            load = vector(structure.coordinates, {driven_and_loaded(structure)[1]: 1.0})
            rotation = rigid_rotation(structure)
            self.load_relief_nm = float(rotation @ self._rubbing / (rotation @ load))
            relief = without_drift(structure, self.load_relief_nm * load[None])[0]
            self.equations = equations_about(*about, relief)
            self.pair_equations = pair_equations(structure, self.equations, mean.speed_hz, self._places())
        seen = structure, self.equations, self.damping
        self.transient_s, self.decay_s = transient_s(*seen), decay_s(*seen)
        self.limits_m = np.array([law.backlash_m + APPROACH_LIMIT_PITCHES * law.base_pitch_m for law in self.laws])
        self.tilts = structure.mesh.tilt is not None
        self._bodies = structure.bodies
        moved = (structure.coordinates[i] for i in self._bodies)
        self.internal_names = (*self._mesh_names(), *with_units(moved))
        self._pairs = tuple(pair_table(law) for law in self.laws)

    @property
    def law(self) -> PairLaw:
        """The law of the first mesh."""
        return self.laws[0]

    @property
    def places(self) -> FloatArray:
        """How base pitches of every mesh follow from those of the first."""
        return self.pair_equations.places

    @property
    def damping(self) -> FloatArray:
        """Damping (meshes,) of the linear part [N s/m]."""
        return np.asarray(np.array([law.damping_root_kg for law in self.laws]) * np.sqrt(self._stiffness))

    def _places(self) -> FloatArray:
        """Return how base pitches of every mesh follow from those of the first, see `PairEquations`."""
        turning, names = rolling(self.structure), self.structure.coordinates
        speeds = [abs(turning[names.index(mesh.turning[0])]) for mesh in self.structure.meshes]
        rates = [law.teeth * speed / (self.teeth * speeds[0]) for law, speed in zip(self.laws, speeds, strict=True)]
        return np.array([[rate, mesh.begins_pitches] for rate, mesh in zip(rates, self.meshes, strict=True)])

    def _mesh_names(self) -> Iterator[str]:
        """Yield the names of what happens in the meshes; those of several begin with the name of the mesh."""
        across = ACROSS if self.tilts else ()
        for mesh, own in zip(self.meshes, self.structure.drivetrain.meshes, strict=True):
            first = f"{own.name}_" if own.name and len(self.meshes) > 1 else ""
            gears = own.driver.body, own.driven.body
            for name in (*pair_internal_names(mesh.law.slots, mesh.contact, gears), *MOTION, *across):
                yield first + name

    def start(self, pitches: float) -> FloatArray:
        """Return the state (2n,) at rest in which the pairs at this angle carry the torque, moved by mean friction.

        Raises
        ------
        ValueError
            If shafts are so soft that gears tilt or move beyond the model.
        """
        if self.tilts or len(self.meshes) > 1:
            self._refuse_soft_shafts()
        state = self._standing(pitches)
        state[: self._rest.size] += self._rest
        return state

    def _standing(self, pitches: float) -> FloatArray:
        """Return the state (2n,) at rest in which the pairs at this angle carry the torque, without friction."""
        equations = self.equations
        deviation = np.zeros_like(equations.static_deflection)
        for m, law in enumerate(self.laws):
            rate, begins = self.pair_equations.places[m]
            approach = static_approach_m(law, equations.static_force[m], pitches * rate + begins)
            deviation += self._given_way[m] * (approach - equations.static_approach[m])
        return np.concatenate([deviation, np.zeros_like(deviation)])

    @cached_property
    def _given_way(self) -> list[FloatArray]:
        """Deflections (n,) by every mesh for a unit of its approach, about the static state [m/m, rad/m]."""
        pushed = self.equations.mesh_vector * self._stiffness[:, np.newaxis]
        return [static_solution(self.structure, self._loaded, row) for row in pushed]

    @property
    def _loaded(self) -> FloatArray:
        """Stiffness (n, n) with the springs of the meshes."""
        return np.asarray(self.structure.stiffness + mesh_springs(self.structure, self._stiffness))

    @cached_property
    def _rest(self) -> FloatArray:
        """The deflection (n,) by the mean of friction over the mesh."""
        push = without_drift(self.structure, -self._rubbing[None])[0]
        return static_solution(self.structure, self._loaded, push)

    def _mean_friction(self) -> FloatArray:
        """Return what the mean of friction takes (n,) [N, N m], over the mesh at rest at its mean speed."""
        taken = np.zeros_like(self.equations.static_deflection)
        if not any(law.places[layout.ROUGHNESSES] > 0 for law in self.laws):
            return taken
        angles = np.asarray(np.arange(MEAN_ANGLES) * self.teeth * GOLDEN % self.teeth, dtype=np.float64)
        states = np.stack([self._standing(angle) for angle in angles])
        for mesh, pairs in zip(self.structure.meshes, self.pairs(states, angles), strict=True):
            friction, (r_0, r_1) = pairs[:, :, columns.FRICTION], mesh.sliding
            taken = taken + r_0 * friction.sum() + r_1 * (pairs[:, :, columns.POSITION] * friction).sum()
        return np.asarray(taken / MEAN_ANGLES)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> NDArray[np.bool_] | None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""
        column = self._speed_input
        _advance(self.pair_equations, self.laws, self._pairs, self._step_s, column, pitches, inputs, trajectory)
        return None

    def rate(self, state: FloatArray, pitches: float) -> FloatArray:
        """Return ż (2n,) of a state, for other solvers."""
        rate = np.empty_like(state)
        pair_rate((self.pair_equations, self.laws, self._pairs), state, pitches, rate)
        return rate

    def refuse_outside(self, states: FloatArray) -> None:
        """Raise if the gears tilt so far in any of the states (k, 2n) that an end of the face meets the other flank.

        Raises
        ------
        ValueError
            With the tilt and its limit.
        """
        n = self.equations.static_deflection.size
        for m, mesh in enumerate(self.structure.meshes):
            if mesh.tilt is not None:
                static = self.pair_equations.static[m]
                tilt = static[TILT] + states[:, :n] @ mesh.tilt
                self._refuse_tilt(m, tilt, static[APPROACH] + states[:, :n] @ mesh.vector, "in motion")

    def steps_apart(self, states: FloatArray, pitches: FloatArray) -> NDArray[np.int64]:
        """Return at how many states no pair of each mesh carries (meshes,)."""
        parts = enumerate(zip(self.laws, self._pairs, strict=True))
        return np.array([steps_apart(self.pair_equations, m, law, pairs, states, pitches) for m, (law, pairs) in parts])

    def _refuse_soft_shafts(self) -> None:
        """Raise where the static deflection alone is beyond the model."""
        moved = dict(zip(self.structure.coordinates, np.abs(self.equations.static_deflection), strict=True))
        for m, (mesh, law) in enumerate(zip(self.structure.meshes, self.laws, strict=True)):
            static, allowed = self.pair_equations.static[m], LARGEST_SHIFT * law.base_pitch_m
            self._refuse_tilt(m, static[TILT : TILT + 1], static[APPROACH : APPROACH + 1], "under the mean torque")
            shift = max(moved[f"{axis}{name.removeprefix('theta')}"] for name in mesh.turning for axis in "xy")
            if not shift <= allowed:
                where = "machine" if len(self.meshes) > 1 else "dynamics.shafts"
                raise ValueError(
                    f"{where}: a gear moves by {1e3 * shift:.3g} mm under the mean torque; allowed: at most "
                    f"{1e3 * allowed:.3g} mm. Take thicker or shorter shafts, or a smaller torque"
                )

    def _refuse_tilt(self, mesh: int, tilt_rad: FloatArray, approach_m: FloatArray, when: str) -> None:
        """Raise where an end of the face lies behind the flank that it faces by more than the backlash.

        Flanks that have parted, and those on the back flank, are counted as if they just touched: there the gap is that
        in the middle of the face.
        """
        half_face, backlash = self.laws[mesh].half_face_m, self.laws[mesh].backlash_m
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

    def pairs(
        self, states: FloatArray, pitches: FloatArray, inputs: FloatArray | None = None
    ) -> tuple[FloatArray, ...]:
        """Return the table of pairs of every state (k, slots, COLUMNS) of every mesh; without inputs at Ω_0."""
        result = tuple(np.stack([pair_table(law)] * len(states)) for law in self.laws)
        column = self._speed_input
        deviation = np.zeros(len(states)) if inputs is None or column < 0 else np.ascontiguousarray(inputs[:, column])
        for m, tables in enumerate(result):
            _all_pairs(self.pair_equations, m, self.laws[m], states, pitches, deviation, tables)
        return result

    def internals(self, states: FloatArray, pitches: FloatArray, inputs: FloatArray | None = None) -> FloatArray:
        """Return the values named in `internal_names` (k, names) of states (k, 2n)."""
        n = self.equations.static_deflection.size
        tables = self.pairs(states, pitches, inputs)
        found = [self._mesh_internals(m, states, pairs) for m, pairs in enumerate(tables)]
        moved = (states[:, :n] + self.equations.static_deflection)[:, self._bodies]
        return np.concatenate([*found, moved], axis=1)

    def _mesh_internals(self, mesh: int, states: FloatArray, pairs: FloatArray) -> FloatArray:
        """Return what happens in a mesh (k, names) in states (k, 2n) with their tables of pairs."""
        law, contact, p = self.laws[mesh], self.meshes[mesh].contact, self.equations.mesh_vector[mesh]
        n = p.size
        found = pair_internals(pairs, law.line_of_action_m, contact)
        approach = [
            self.equations.static_approach[mesh] + (states[:, :n] * p).sum(axis=1),
            (states[:, n:] * p).sum(axis=1),
        ]
        if self.tilts:
            approach += [pairs[:, 0, columns.TILT], pairs[:, :, columns.MOMENT].sum(axis=1)]
        if self.structure.meshes[mesh].flanks.side < 0.0:
            found = as_back_flanks(found, law.slots, law.line_of_action_m, contact)
            approach[:2] = [-law.backlash_m - approach[0], -approach[1]]
        return np.concatenate([found, np.stack(approach, axis=1)], axis=1)


@entry(cache=True)
def _advance(
    equations: PairEquations,
    laws: tuple[PairLaw, ...],
    pairs: tuple[FloatArray, ...],
    step_s: float,
    speed_input: int,
    pitches: FloatArray,
    inputs: FloatArray,
    trajectory: FloatArray,
) -> None:
    scratch = np.empty((3, trajectory.shape[1]))
    pushes = np.empty((2, trajectory.shape[1] // 2 if inputs.shape[1] > 0 else 0))
    model = (equations, laws, pairs)
    for i in range(pitches.size - 1):
        start, end = trajectory[i], trajectory[i + 1]
        external_push(equations.external_input, inputs[i], pushes[0])
        external_push(equations.external_input, inputs[i + 1], pushes[1])
        if speed_input >= 0:
            model = (at_speed(equations, 0.5 * (inputs[i, speed_input] + inputs[i + 1, speed_input])), laws, pairs)
        runge_kutta_step(pair_rate, model, step_s, (pitches[i], pitches[i + 1]), pushes, start, end, scratch)


@entry(cache=True)
def _all_pairs(
    equations: PairEquations,
    mesh: int,
    law: PairLaw,
    states: FloatArray,
    pitches: FloatArray,
    speed_deviation: FloatArray,
    result: FloatArray,
) -> None:
    for i in range(states.shape[0]):
        load_pairs(at_speed(equations, speed_deviation[i]), mesh, law, result[i], states[i], pitches[i])
