"""Work against precision of one record: siggen, Runge-Kutta, DOP853, Newmark and scipy on the same equations.

All start from the same state and see the same angle and inputs. An error is the median over the motions of the relative
rms difference of the acceleration between samples (second difference of the displacement), behind the first STARTING_S,
from a reference of REFERENCE_STEPS steps per sample. A cost is CPU time per second of signal, of the loop alone.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.compiled_dop853 import dop853
from benchmarks.compiled_newmark import inverse_tangent, newmark
from benchmarks.driven_rate import compiled_rate, driven_rate
from benchmarks.precision_case import Case, state_grid
from siggen.arrays import FloatArray
from siggen.motion.equations import state_matrix
from siggen.motion.pair_motion import PairMotion

WINDOW_S, STARTING_S, LOOP_S, ROUNDS = 0.1, 0.02, 0.5, 3
REFERENCE_STEPS = 64
OWN_STEPS, PLAIN_STEPS = (1, 2, 4), (1, 2, 4, 8, 16)
FINEST_PLAIN_STEPS = 64
"""Of the linear law: Runge-Kutta loses its order where a pair of teeth enters within a step."""
NEWMARK_STEPS = (4, 16, 64)
TOLERANCES, ABSOLUTE_SHARE = (1e-3, 1e-5, 1e-7), 1e-6
GRID_STEPS = 4
"""Per sample: points between which other solvers find angle and inputs straight, an error of 1e-8 rad at most."""
PLAIN, COMPILED, NEWMARK = "Runge-Kutta, numba", "DOP853, numba", "Newmark, numba"
"""Compiled as a whole, the second one adaptive; those of scipy call a compiled rate from Python."""
Scipy = Literal["DOP853", "LSODA"]
SCIPY: tuple[Scipy, ...] = ("DOP853", "LSODA")

Run = Callable[[], FloatArray]
"""Gives states (samples + 1, 2n) at the samples; what it costs is the loop."""
Solver = Callable[[float], Run]
"""Of a duration [s]: prepares angle and inputs, which all methods take as they are."""


@dataclass(frozen=True, slots=True)
class Point:
    """Cost per second of signal and error of a method with a setting."""

    method: str
    setting: str
    cost_s: float
    error: float


def work_points(case: Case, *, quick: bool) -> Iterator[Point]:
    """Yield the points of all methods; own and Runge-Kutta's costs are medians of runs in turn."""
    tolerances = TOLERANCES[1:2] if quick else TOLERANCES
    wanted = _accelerations(case, _reference(case)(WINDOW_S)())
    compiled = {(case.method, steps_text(k)): own_solver(case, case.method, k) for k in OWN_STEPS}
    compiled |= {(COMPILED, _rtol(rtol)): _compiled_solver(case, rtol) for rtol in tolerances}
    plain = (*PLAIN_STEPS, FINEST_PLAIN_STEPS) if case.method == "product" else PLAIN_STEPS
    compiled |= {(PLAIN, steps_text(k)): own_solver(case, "runge_kutta", k) for k in plain}
    if case.method == "exponential":
        compiled |= {(NEWMARK, steps_text(k)): _newmark_solver(case, k) for k in NEWMARK_STEPS}
    errors = {key: _error(_accelerations(case, solver(WINDOW_S)()), wanted) for key, solver in compiled.items()}
    rounds = [{key: _cost(solver, LOOP_S) for key, solver in compiled.items()} for _ in range(ROUNDS)]
    for key, error in errors.items():
        yield Point(*key, float(np.median([one[key] for one in rounds])), error)
    slow = {(method, _rtol(rtol)): _scipy_solver(case, method, rtol) for method in SCIPY for rtol in tolerances}
    for key, solver in slow.items():
        solver(0.002)()  # compiles
        run = solver(WINDOW_S)
        begin = time.process_time()
        states = run()
        cost = (time.process_time() - begin) / WINDOW_S
        yield Point(*key, cost, _error(_accelerations(case, states), wanted))


def own_solver(case: Case, integrator: str, steps: int) -> Solver:
    """Return siggen's integrator of this name with so many steps per sample."""
    grid = state_grid(integrator, steps)
    motion, start = case.motion(integrator, steps), _start(case)

    def prepared(duration_s: float) -> Run:
        pitches, inputs = case.driven_steps(motion, grid.per_sample, duration_s)
        path = np.empty((pitches.size, start.size))
        motion.start(pitches[0])  # forgets earlier steps
        path[0] = start

        def run() -> FloatArray:
            motion.advance(pitches, inputs, path)
            return path[:: grid.per_sample]

        return run

    return prepared


def steps_text(steps: int) -> str:
    """Return the setting of a method with so many steps per sample."""
    return f"{steps} step" if steps == 1 else f"{steps} steps"


def equal_cost_s(points: Sequence[Point], error: float) -> tuple[float, bool]:
    """Return what a method costs at an error, its logarithm straight between points, and whether it gets so far.

    Beyond its points the nearest one counts.
    """
    kept = sorted((point for point in points if np.isfinite(point.error)), key=lambda point: point.error)
    logs = np.log([[point.error, point.cost_s] for point in kept])
    return float(np.exp(np.interp(np.log(error), logs[:, 0], logs[:, 1]))), bool(kept[0].error <= error)


def _reference(case: Case) -> Solver:
    """Return Runge-Kutta; for the linear law, whose jumps cost it its order, product integration."""
    linear = case.method == "product"
    return own_solver(case, "product" if linear else "runge_kutta", REFERENCE_STEPS)


def _scipy_solver(case: Case, method: Scipy, rtol: float) -> Solver:
    motion, start, fs_hz = case.motion("runge_kutta", 1), _start(case), case.config.fs_hz

    def prepared(duration_s: float) -> Run:
        pitches, inputs = case.driven_steps(motion, GRID_STEPS, duration_s)
        rate = driven_rate(motion, case.driven.speed_input, pitches, inputs, fs_hz * GRID_STEPS)
        times = np.arange(round(duration_s * fs_hz) + 1) / fs_hz

        def run() -> FloatArray:
            found = solve_ivp(
                rate, (0.0, times[-1]), start, method=method, t_eval=times, rtol=rtol, atol=ABSOLUTE_SHARE * rtol
            )
            if not found.success:
                raise RuntimeError(f"{method} with rtol {rtol:g}: {found.message}")
            return np.ascontiguousarray(found.y.T)

        return run

    return prepared


def _compiled_solver(case: Case, rtol: float) -> Solver:
    motion, start, fs_hz = case.motion("runge_kutta", 1), _start(case), case.config.fs_hz

    def prepared(duration_s: float) -> Run:
        pitches, inputs = case.driven_steps(motion, GRID_STEPS, duration_s)
        function, model = compiled_rate(motion, case.driven.speed_input, pitches, inputs)
        tolerance = (rtol, ABSOLUTE_SHARE * rtol)
        return lambda: dop853(function, model, start, fs_hz * GRID_STEPS, 1.0 / fs_hz, tolerance)

    return prepared


def _newmark_solver(case: Case, steps: int) -> Solver:
    motion, start, rate_hz = case.motion("runge_kutta", 1), _start(case), case.config.fs_hz * steps
    assert isinstance(motion, PairMotion)
    linear = state_matrix(motion.equations, motion.equations.reference_stiffness, motion.damping)
    inverse = inverse_tangent(linear, 1.0 / rate_hz)

    def prepared(duration_s: float) -> Run:
        pitches, inputs = case.driven_steps(motion, GRID_STEPS, duration_s)
        function, model = compiled_rate(motion, case.driven.speed_input, pitches, inputs)
        path = np.empty((round(duration_s * rate_hz) + 1, start.size))

        def run() -> FloatArray:
            newmark(function, model, inverse, start, GRID_STEPS / steps, 1.0 / rate_hz, path)
            return path[::steps]

        return run

    return prepared


def _rtol(rtol: float) -> str:
    return f"rtol {rtol:g}"


def _start(case: Case) -> FloatArray:
    """Return the state that the case's own integrator starts from; at rest."""
    motion = case.motion(case.method, 2)
    return motion.start(case.driven_steps(motion, 1, 0.001)[0][0])


def _cost(solver: Solver, duration_s: float) -> float:
    run = solver(duration_s)
    begin = time.process_time()
    run()
    return (time.process_time() - begin) / duration_s


def _accelerations(case: Case, states: FloatArray) -> FloatArray:
    """Return the accelerations (samples, motions) of states at the samples, as second differences."""
    motions = np.array(list(case.state.mesh.structure.motions.values()))
    with np.errstate(all="ignore"):
        moved = states[:, : motions.shape[1]] @ motions.T
        return np.asarray(np.diff(moved, n=2, axis=0)[round(STARTING_S * case.config.fs_hz) :] * case.config.fs_hz**2)


def _error(found: FloatArray, wanted: FloatArray) -> float:
    """Return the median over the motions of the relative rms difference; infinite where a state is not finite."""
    with np.errstate(all="ignore"):
        errors = np.sqrt(np.mean((found - wanted) ** 2, axis=0) / np.mean(wanted**2, axis=0))
        return float(np.nan_to_num(np.median(errors), nan=np.inf, posinf=np.inf))
