"""ExponentialMotion: a pair motion whose linear part is propagated exactly (`exponential_scheme`)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.drivetrain.structure import Structure
from siggen.mesh.event_places import event_places
from siggen.mesh.pair_springs import pair_table
from siggen.motion.exponential_scheme import NODES, exponential_scheme
from siggen.motion.exponential_step import ATTEMPTS, CHANNELS, Loop, advance, fresh_memory, work_arrays
from siggen.motion.pair_motion import MeanState, PairMesh, PairMotion

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
        meshes: Sequence[PairMesh],
        *,
        mean: MeanState,
        step_s: float,
        input_vectors: FloatArray | None = None,
        speed_input: int = -1,
        stride: int = 1,
    ) -> None:
        super().__init__(
            structure, meshes, mean=mean, step_s=step_s, input_vectors=input_vectors, speed_input=speed_input
        )  # fmt: skip
        self._mean_hz = mean.speed_hz
        self._take_steps(step_s, stride)

    def with_steps(self, step_s: float, stride: int = 1) -> ExponentialMotion:
        """Return the same motion in other steps; it has to be started."""
        other = ExponentialMotion.__new__(ExponentialMotion)
        other.__dict__.update(self.__dict__)
        other._take_steps(step_s, stride)
        return other

    def _take_steps(self, step_s: float, stride: int) -> None:
        self._step_s, self.stride = step_s, stride
        of_pairs, k = self.pair_equations, self._stiffness
        self.scheme = exponential_scheme(self.structure, self.equations, of_pairs, self.damping, stride * step_s)
        light_n = np.array([mesh.light_force_n for mesh in self.meshes])
        static_n = np.maximum(np.abs(self.equations.static_force), light_n)
        approach_m = np.maximum(np.abs(self.equations.static_approach), light_n / k)
        pitches_per_step = self.teeth * self._mean_hz * stride * step_s * of_pairs.places[:, 0]
        parts = zip(self.laws, static_n / k, pitches_per_step, strict=True)
        events = tuple(event_places(law, float(sunk), float(pitches)) for law, sunk, pitches in parts)
        self._loop = Loop(self.scheme, self.laws, stride, self._speed_input, BEND_SHARE * static_n, approach_m, events)
        self._work = work_arrays(self.scheme, self.laws)
        self._forget()

    def _forget(self) -> None:
        """Forget earlier steps."""
        self._memory = fresh_memory(len(self.laws))
        self._tables = tuple(np.concatenate([pair_table(law)] * NODES) for law in self.laws)

    def start(self, pitches: float) -> FloatArray:
        """Return the state at the start, as all pair motions do; forgets earlier steps."""
        self._forget()
        return super().start(pitches)

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> NDArray[np.bool_]:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m).

        Returns
        -------
        (meshes, steps) whether no pair touched at the end of each step
        """
        apart = np.empty((len(self.laws), pitches.size - 1), dtype=np.bool_)
        advance(self._loop, pitches, inputs, self._memory, self._tables, self._work, apart, trajectory)
        return apart

    @property
    def steps_tried(self) -> int:
        """How many steps of any length were tried since the start."""
        return int(self._memory[CHANNELS * len(self.laws), ATTEMPTS])
