"""ExponentialMotion: a pair motion whose linear part is propagated exactly (`exponential_scheme`)."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.mesh.event_places import event_places
from siggen.dynamics.mesh.pair_internals import PairContact
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.exponential_scheme import NODES, exponential_scheme
from siggen.dynamics.time.exponential_step import advance, fresh_memory, work_arrays
from siggen.dynamics.time.pair_motion import PairMotion

EVENT_SHARE = 1e-2
"""Of the static force: how large the cubic part of the force over a step may be."""


class ExponentialMotion(PairMotion):
    """Steps with the exponential integrator; arguments as `PairMotion`.

    It remembers the end of the last step, so steps follow one another: blocks of a run give what one block gives.
    """

    def __init__(
        self,
        structure: Structure,
        law: PairLaw,
        *,
        torque_nm: float,
        speed_hz: float,
        reference_stiffness_n_per_m: float,
        step_s: float,
        contact: PairContact | None = None,
        input_vectors: FloatArray | None = None,
        speed_input: int = -1,
    ) -> None:
        super().__init__(
            structure, law, torque_nm=torque_nm, speed_hz=speed_hz, step_s=step_s, contact=contact,
            reference_stiffness_n_per_m=reference_stiffness_n_per_m, input_vectors=input_vectors,
            speed_input=speed_input,
        )  # fmt: skip
        damping = law.damping_root_kg * float(np.sqrt(reference_stiffness_n_per_m))
        rigid = (self.pair_equations.rigid_sliding_0, self.pair_equations.rigid_sliding_1)
        self.scheme = exponential_scheme(structure, self.equations, damping, rigid, step_s)
        self._tolerance_n = EVENT_SHARE * abs(self.equations.static_force)
        self._events = event_places(
            law, abs(self.equations.static_force) / reference_stiffness_n_per_m, law.teeth * speed_hz * step_s
        )
        self._memory, self._tables = fresh_memory(), np.concatenate([pair_table(law)] * NODES)
        self._work = work_arrays(self.scheme.transition.shape[2], self.scheme.input_response.shape[2])

    def start(self, pitches: float) -> FloatArray:
        """Return the state (2n,) at rest in which the pairs at this angle carry the torque; forgets earlier steps."""
        self._memory, self._tables = fresh_memory(), np.concatenate([pair_table(self.law)] * NODES)
        return super().start(pitches)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m)."""
        apart = np.empty(pitches.size - 1, dtype=np.int64)
        advance(
            self.scheme, self.law, self._speed_input, self._tolerance_n, self._events, pitches, inputs, self._memory,
            self._tables, self._work, apart, trajectory,
        )  # fmt: skip
