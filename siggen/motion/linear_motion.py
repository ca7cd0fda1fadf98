"""LinearMotion: a structure under the linear mesh law, as what `response` steps through time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_force import MeshLaw, mean_mesh_stiffness, mesh_force, mesh_law, mesh_stiffness
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.equations import Equations, approach_of, equations_of_motion, external_push, linear_rate, start_state
from siggen.motion.motion import APPROACH_LIMIT_PITCHES, DECAY_TIMES, transient_s
from siggen.motion.product_integration import ProductIntegration
from siggen.motion.runge_kutta import runge_kutta_step


class Integrator(Protocol):
    """What steps a state through time."""

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""


class RungeKutta:
    """Advances the state with one classical Runge-Kutta step per time step, as reference."""

    def __init__(self, equations: Equations, law: MeshLaw, step_s: float) -> None:
        self._equations = equations
        self._law = law
        self._step_s = step_s

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""
        _advance(self._equations, self._law, self._step_s, pitches, inputs, trajectory)


@entry(cache=True)
def _advance(
    equations: Equations,
    law: MeshLaw,
    step_s: float,
    pitches: FloatArray,
    inputs: FloatArray,
    trajectory: FloatArray,
) -> None:
    scratch = np.empty((3, trajectory.shape[1]))
    pushes = np.empty((2, trajectory.shape[1] // 2 if inputs.shape[1] > 0 else 0))
    model = (equations, law)
    for i in range(pitches.size - 1):
        start, end = trajectory[i], trajectory[i + 1]
        external_push(equations.external_input, inputs[i], pushes[0])
        external_push(equations.external_input, inputs[i + 1], pushes[1])
        runge_kutta_step(linear_rate, model, step_s, (pitches[i], pitches[i + 1]), pushes, start, end, scratch)


INTEGRATORS: Mapping[str, Callable[[Equations, MeshLaw, float], Integrator]] = {
    "product": ProductIntegration,
    "runge_kutta": RungeKutta,
}


class LinearMotion:
    """Mesh damping is c = 2 ζ √(K m_e) with the mean healthy mesh stiffness K: the same for every state of a pair."""

    internal_names: tuple[str, ...] = ("mesh_force_n", "mesh_stiffness_n_per_m", "approach_m", "approach_rate_m_s")

    coarse_inputs = False
    stride = 1
    starts_settled = False

    def __init__(
        self,
        structure: Structure,
        tables: MeshTables,
        *,
        torque_nm: float,
        mesh_damping_ratio: float,
        backlash_m: float,
        step_s: float,
        integrator: str = "product",
        input_vectors: FloatArray | None = None,
    ) -> None:
        stiffness = mean_mesh_stiffness(tables)
        damping = 2.0 * mesh_damping_ratio * float(np.sqrt(stiffness * structure.mesh.mass_kg))
        self.structure = structure
        self._law = mesh_law(tables, damping, backlash_m)
        self.equations = equations_of_motion(structure, self._law, torque_nm, stiffness, input_vectors)
        self.transient_s = transient_s(structure, self.equations, np.array([damping]))
        self.decay_s = self.transient_s / DECAY_TIMES
        self.teeth, self.laws = self._law.table_of_pair.shape[0], (self._law,)
        self.limits_m = np.array([0.5 * backlash_m + APPROACH_LIMIT_PITCHES * tables.base_pitch_m])
        self._integrator = INTEGRATORS[integrator](self.equations, self._law, step_s)

    @property
    def law(self) -> MeshLaw:
        """The mesh law with its tables."""
        return self._law

    @property
    def places(self) -> FloatArray:
        """The only mesh turns as the first one."""
        return np.array([[1.0, 0.0]])

    def start(self, pitches: float) -> FloatArray:
        """Return the static state (2n,) at a pinion angle in base pitches."""
        return start_state(self.structure, self._law, self.equations, pitches)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""
        self._integrator.advance(pitches, inputs, trajectory)

    def refuse_outside(self, states: FloatArray) -> None:
        """Accept any state: parallel gears do not tilt."""

    def steps_apart(self, states: FloatArray, pitches: FloatArray) -> NDArray[np.int64]:  # noqa: ARG002 - as every motion
        """Return at how many states no teeth touch (1,): the approach is inside the backlash."""
        return np.array([_steps_in_gap(self.equations, self._law.half_backlash_m, states)])

    def internals(
        self,
        states: FloatArray,
        pitches: FloatArray,
        inputs: FloatArray | None = None,  # noqa: ARG002 - as every motion
    ) -> FloatArray:
        """Return the values named in `internal_names` (k, names) of states (k, 2n)."""
        found = _evaluate_inner(self.equations, self._law, states, pitches)
        side = self.structure.mesh.flanks.side
        return np.asarray(found * np.array([side, 1.0, side, side]))


@entry(cache=True)
def _steps_in_gap(equations: Equations, half_backlash_m: float, states: FloatArray) -> int:
    if half_backlash_m == 0.0:
        return 0
    count = 0
    for i in range(states.shape[0]):
        approach, _ = approach_of(equations, 0, states[i])
        if not abs(approach) > half_backlash_m:
            count += 1
    return count


@entry(cache=True)
def _evaluate_inner(equations: Equations, law: MeshLaw, states: FloatArray, pitches: FloatArray) -> FloatArray:
    result = np.empty((states.shape[0], 4))
    for i in range(states.shape[0]):
        approach, rate = approach_of(equations, 0, states[i])
        result[i, 0] = mesh_force(law, approach, rate, pitches[i])
        result[i, 1] = mesh_stiffness(law, pitches[i])
        result[i, 2] = approach
        result[i, 3] = rate
    return result
