"""Motion: what is stepped through time, whatever the structure and the law of the mesh."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.drivetrain.structure import Structure
from siggen.motion.equations import Equations
from siggen.motion.modes import slowest_decay_per_s

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


# The time that is simulated and discarded before the first sample.

DECAY_TIMES = 9.0
"""Length of the discarded transient in decay times of the slowest mode, where nothing is known of the start.

Turning a shaft lets its flanks carry the mean load: it starts in equilibrium, moved by the mean of friction. At 35 Hz
and 40 N m an earlier start changes samples by 1e-4 after 3 decays, at 2 Hz and 1 N m after 8: then pairs carry by
errors of a micrometre, and whatever moves by one moves them. Of several meshes those modes count that meshes show
alone, such as torsion between sun and load: their shares of the load are not those of the mean stiffness.
"""
SHORTEST_DECAYS = 3.0
"""Shortest transient, whatever is measured of a start."""
QUARTERS = 4
"""Steps of a decay time in which transients are chosen: a rounding changes none."""
IN_A_ROW = 0.4
"""Of the shorter one of two times over which things settle: what it adds where they stand in a row."""
TRANSIENT_CAP_S = 5.0
"""Longest transient that is computed; reached by modes that decay slower than 1/s, undamped ones included."""


def transient_s(structure: Structure, equations: Equations, mesh_damping_n_s_per_m: FloatArray) -> float:
    """Return the time [s] that is simulated and discarded before sample 0, where nothing is known of the start."""
    several = len(structure.meshes) > 1
    return _capped(slowest_decay_per_s(structure, equations, mesh_damping_n_s_per_m, at_meshes=several))


def decay_s(structure: Structure, equations: Equations, mesh_damping_n_s_per_m: FloatArray) -> float:
    """Return one decay time [s] of the slowest mode that meshes excite and a bearing shows."""
    return _capped(slowest_decay_per_s(structure, equations, mesh_damping_n_s_per_m)) / DECAY_TIMES


def forgotten(error: float, after_s: float, allowed: float, unknown_s: float) -> tuple[float, float]:
    """Return the transient [s] after which a start errs by no more than allowed, and by how much it does then.

    It erred by `error` after `after_s`; `unknown_s` is what `transient_s` says. Nothing is known to decay at the cap.
    """
    if error == math.inf or unknown_s >= TRANSIENT_CAP_S:
        return unknown_s, error
    decay_s = unknown_s / DECAY_TIMES
    needed = min(after_s / decay_s + math.log(max(error / allowed, 1.0)), TRANSIENT_CAP_S / decay_s)
    transient = math.ceil(QUARTERS * max(SHORTEST_DECAYS, needed)) / QUARTERS * decay_s
    return transient, error * math.exp((after_s - transient) / decay_s)


def _capped(decay_per_s: float) -> float:
    return min(TRANSIENT_CAP_S, DECAY_TIMES / decay_per_s) if decay_per_s > 0.0 else TRANSIENT_CAP_S


def both_settled_s(first_s: float, second_s: float) -> float:
    """Return the time [s] over which two things that ring in a row settle, each of which alone needs its own time.

    Derived: where both times are seven decays, what is left is no more than e^-7, which the slower one alone leaves.
    With equal ones it is (1 + x) e^-x, 6e-4 at x = 9.8.
    """
    return max(first_s, second_s) + IN_A_ROW * min(first_s, second_s)


def settling_steps(transient_s: float, settle_s: float, rate_hz: float) -> int:
    """Return the steps that are computed and discarded before sample 0: the transient's, or of `settle_s` if longer."""
    return math.ceil(max(transient_s, settle_s) * rate_hz)


# History: the samples before the first one of a record or behind its last, for filters that remember (derived).


@dataclass(frozen=True, slots=True)
class History:
    """What came before sample 0: place/axis -> (h,), the last value one sample before it; empty in a failed response.

    Or what comes behind the last sample, the first value one sample behind it.

    The acceleration before the history is zero where it is shorter than was asked for: the motion began at rest.
    """

    acceleration_m_s2: Mapping[str, FloatArray]
    bearing_force_n: Mapping[str, FloatArray]
    shaft_reading: Mapping[str, FloatArray] = field(default_factory=dict)

    @property
    def parts(self) -> tuple[Mapping[str, FloatArray], ...]:
        """Accelerations, bearing forces and readings of shafts."""
        return self.acceleration_m_s2, self.bearing_force_n, self.shaft_reading
