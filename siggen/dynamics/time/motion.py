"""Motion: what is stepped through time, whatever the structure and the law of the mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.equations import Equations

APPROACH_LIMIT_PITCHES = 0.1
"""Penetration of the flanks, in base pitches, beyond which no teeth exist: about 1 mm, a hundred times a usual load."""


class Motion(Protocol):
    """A structure under some mesh law: what is stepped through time, and what can be asked about its states (2n,).

    `teeth`: of the first gear, by which angles are counted in base pitches; `limits_m` (meshes,): approaches beyond
    which a state is refused. `coarse_inputs`: whether inputs may be splines over a coarse grid; motions of older sets
    keep every bit without.
    `stride`: 2 where every other state stands in the middle of a step of the integrator, else 1.
    `starts_settled`: whether a motion starts near its end, on a whole sample. `transient_s` is discarded before a
    record, `decay_s` one decay time of the slowest mode that bearings show.
    """

    structure: Structure
    equations: Equations
    transient_s: float
    decay_s: float
    teeth: int
    limits_m: FloatArray
    internal_names: tuple[str, ...]
    coarse_inputs: bool
    stride: int
    starts_settled: bool

    @property
    def laws(self) -> Sequence[NamedTuple]:
        """The laws of the meshes: tables and numbers."""

    @property
    def places(self) -> FloatArray:
        """How base pitches of every mesh follow from those of the first (meshes, 2), as in `PairEquations`."""

    def start(self, pitches: float) -> FloatArray:
        """Return the state at the start, at a pinion angle in base pitches."""

    def advance(self, pitches: FloatArray, inputs: FloatArray, trajectory: FloatArray) -> NDArray[np.bool_] | None:
        """Fill `trajectory` (steps + 1, 2n) after row 0; `pitches` (steps + 1,), `inputs` (steps + 1, m).

        Returns (meshes, steps) whether no teeth touch at the end of each step, if that is known; else `steps_apart`
        tells it.
        """

    def refuse_outside(self, states: FloatArray) -> None:
        """Raise ValueError if a state (k, 2n) lies outside what the mesh law was made for."""

    def steps_apart(self, states: FloatArray, pitches: FloatArray) -> NDArray[np.int64]:
        """Return at how many states no teeth of each mesh touch (meshes,)."""

    def internals(self, states: FloatArray, pitches: FloatArray, inputs: FloatArray | None = None) -> FloatArray:
        """Return the values named in `internal_names` (k, names)."""
