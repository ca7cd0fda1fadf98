"""Runs of one integrator from the static start, and an independent reference with scipy."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_force import MeshLaw, mean_mesh_stiffness, mesh_law
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.equations import Equations, equations_of_motion, no_inputs, start_state, state_rate

MESH_HZ = 540.0
FIRST_PITCHES = 54.2
"""Angle of the start: neither at an engagement event nor at a table point."""


def model(
    structure: Structure, tables: MeshTables, damping: float = 700.0, backlash: float = 80e-6, torque: float = 60.0
) -> tuple[Equations, MeshLaw, np.ndarray]:
    """Return equations, law and the start state at FIRST_PITCHES."""
    law = mesh_law(tables, damping, backlash)
    equations = equations_of_motion(structure, law, torque, mean_mesh_stiffness(tables))
    return equations, law, start_state(structure, law, equations, FIRST_PITCHES)


def trajectory(
    integrator, equations: Equations, law: MeshLaw, start: np.ndarray, step_s: float, steps: int
) -> np.ndarray:
    """Return the states (steps + 1, 2n) of an integrator class."""
    states = np.empty((steps + 1, start.size))
    states[0] = start
    pitches = FIRST_PITCHES + MESH_HZ * step_s * np.arange(steps + 1)
    integrator(equations, law, step_s).advance(pitches, no_inputs(pitches), states)
    return states


def reference(equations: Equations, law: MeshLaw, start: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return the states at `times` by DOP853, stopped and restarted at every engagement event and table point."""
    last = FIRST_PITCHES + MESH_HZ * times[-1]
    interval = law.contact_ratio / (law.stiffness.shape[1] - 1)
    pairs = np.arange(np.floor(FIRST_PITCHES) - 2, np.ceil(last) + 1)
    kinks = (pairs[:, None] + interval * np.arange(law.stiffness.shape[1])).ravel()
    kinks = np.unique(kinks[(kinks > FIRST_PITCHES) & (kinks < last)])
    knots = np.concatenate([[0.0], (kinks - FIRST_PITCHES) / MESH_HZ, [times[-1]]])
    states = np.empty((times.size, start.size))
    state = start
    for begin, end in pairwise(knots):
        if end - begin < 1e-13:
            continue
        # Angles just inside the segment: at its ends the stiffness would be that of the neighbouring one.
        inside = (FIRST_PITCHES + MESH_HZ * begin + 1e-11, FIRST_PITCHES + MESH_HZ * end - 1e-11)
        wanted = (times >= begin) & (times <= end)
        solution = solve_ivp(
            lambda t, z, low, high: rate(equations, law, z, min(max(FIRST_PITCHES + MESH_HZ * t, low), high)),
            (begin, end), state, method="DOP853", rtol=1e-11, atol=1e-16, dense_output=True, args=inside,
        )  # fmt: skip
        states[wanted] = solution.sol(times[wanted]).T
        state = solution.y[:, -1]
    return states


def rate(equations: Equations, law: MeshLaw, state: np.ndarray, pitches: float) -> np.ndarray:
    """Return the time derivative of a state."""
    result = np.empty_like(state)
    state_rate(equations, law, state, pitches, result)
    return result


def relative_error(states: np.ndarray, expected: np.ndarray, column: int) -> float:
    """Return the rms difference of one column over the rms of its motion."""
    difference = states[:, column] - expected[:, column]
    return float(np.sqrt((difference**2).mean() / expected[:, column].var()))
