"""The time that is simulated and discarded before the first sample."""

from __future__ import annotations

import math

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.equations import Equations
from siggen.dynamics.time.modes import slowest_decay_per_s

DECAY_TIMES = 5.0
"""Length of the discarded transient of one mesh in decay times of the slowest mode that it excites.

Turning a shaft lets its flanks carry the mean load: it starts in equilibrium, moved by the mean of friction. With an
earlier start 0.1 s of quickstart change by 3e-4 of their rms at 1 Hz, by 7e-5 at 5 Hz and 8e-6 at 35 Hz.
"""
DECAYS_OF_SEVERAL = 9.0
"""The same of several meshes, of modes that meshes show alone too, such as torsion between sun and load.

Their shares of the load are not those of the mean stiffness, and modes of a casing sound that they excite. After 5
decay times an earlier start changes 0.1 s of two stages by 1e-3, after 8 by 6e-5.
"""
IN_A_ROW = 0.4
"""Of the shorter one of two times over which things settle: what it adds where they stand in a row."""
TRANSIENT_CAP_S = 5.0
"""Longest transient that is computed; reached by modes that decay slower than 1/s, undamped ones included."""


def transient_s(structure: Structure, equations: Equations, mesh_damping_n_s_per_m: FloatArray) -> float:
    """Return the time [s] that is simulated and discarded before sample 0."""
    several = len(structure.meshes) > 1
    decay = slowest_decay_per_s(structure, equations, mesh_damping_n_s_per_m, at_meshes=several)
    return _capped(DECAYS_OF_SEVERAL if several else DECAY_TIMES, decay)


def decay_s(structure: Structure, equations: Equations, mesh_damping_n_s_per_m: FloatArray) -> float:
    """Return one decay time [s] of the slowest mode that meshes excite and a bearing shows."""
    slowest = slowest_decay_per_s(structure, equations, mesh_damping_n_s_per_m)
    return _capped(DECAY_TIMES, slowest) / DECAY_TIMES


def _capped(decays: float, decay_per_s: float) -> float:
    return min(TRANSIENT_CAP_S, decays / decay_per_s) if decay_per_s > 0.0 else TRANSIENT_CAP_S


def both_settled_s(first_s: float, second_s: float) -> float:
    """Return the time [s] over which two things that ring in a row settle, each of which alone needs its own time.

    Derived: where both times are seven decays, what is left is no more than e^-7, which the slower one alone leaves.
    With equal ones it is (1 + x) e^-x, 6e-4 at x = 9.8.
    """
    return max(first_s, second_s) + IN_A_ROW * min(first_s, second_s)


def settling_steps(transient_s: float, settle_s: float, rate_hz: float) -> int:
    """Return the steps that are computed and discarded before sample 0: the transient's, or of `settle_s` if longer."""
    return math.ceil(max(transient_s, settle_s) * rate_hz)
