"""ExponentialMotion: a pair motion whose linear part is propagated exactly (`exponential_scheme`)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.dynamics.mesh.event_places import event_places
from siggen.dynamics.mesh.pair_internals import PairContact
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.exponential_scheme import NODES, exponential_scheme
from siggen.dynamics.time.exponential_step import ATTEMPTS, CHANNELS, Loop, advance, fresh_memory, work_arrays
from siggen.dynamics.time.pair_motion import MeanState, PairMotion

BEND_SHARE = 4e-2
"""Of the static force, or that of a light contact: how large its quadratic part over a step may be."""


class ExponentialMotion(PairMotion):
    """Steps with the exponential integrator; arguments as `PairMotion`; `stride` steps, 1 or 2, are one of its own.

    It remembers the end of the last step, so steps follow one another: blocks of a run give what one block gives.
    """

    coarse_inputs = True

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
        stride: int = 1,
    ) -> None:
        super().__init__(
            structure, law, mean=mean, step_s=step_s, contact=contact, input_vectors=input_vectors,
            speed_input=speed_input,
        )  # fmt: skip
        damping = law.damping_root_kg * float(np.sqrt(mean.stiffness_n_per_m))
        rigid = (self.pair_equations.rigid_sliding_0, self.pair_equations.rigid_sliding_1)
        self.scheme = exponential_scheme(structure, self.equations, damping, rigid, stride * step_s)
        light_n, pitches_per_s = mean.light_force_n, law.teeth * mean.speed_hz
        static_n = max(abs(self.equations.static_force), light_n)
        approach_m = max(abs(self.equations.static_approach), light_n / mean.stiffness_n_per_m)
        events = event_places(law, static_n / mean.stiffness_n_per_m, pitches_per_s * stride * step_s)
        self._loop = Loop(self.scheme, law, stride, speed_input, BEND_SHARE * static_n, approach_m, events)
        self._memory, self._tables = fresh_memory(), np.concatenate([pair_table(law)] * NODES)
        self._work = work_arrays(self.scheme, law)

    def start(self, pitches: float) -> FloatArray:
        """Return the state at the start, as all pair motions do; forgets earlier steps."""
        self._memory, self._tables = fresh_memory(), np.concatenate([pair_table(self.law)] * NODES)
        return super().start(pitches)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> NDArray[np.bool_]:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m).

        Returns
        -------
        (steps,) whether no pair touched at the end of each step
        """
        apart = np.empty(pitches.size - 1, dtype=np.bool_)
        advance(self._loop, pitches, inputs, self._memory, self._tables, self._work, apart, trajectory)
        return apart

    @property
    def steps_tried(self) -> int:
        """How many steps of any length were tried since the start."""
        return int(self._memory[CHANNELS, ATTEMPTS])
