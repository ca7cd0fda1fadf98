"""Integration: cost per second of signal, and error, of every integrator for paper A, and cost of tooth pairs."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from unittest.mock import patch

import numpy as np

from benchmarks.row import Row, cost_row, duration_text
from benchmarks.shipped import PAPER_A, PAPER_B, shipped
from benchmarks.solve_ivp import RELATIVE_TOLERANCE, Method, solve_ivp_integrators
from benchmarks.timing import Candidate, medians
from siggen.config import Config
from siggen.dynamics.drive.drive import Drive
from siggen.dynamics.mesh.mesh_force import mean_mesh_stiffness, mesh_law
from siggen.dynamics.time.equations import equations_of_motion, no_inputs
from siggen.dynamics.time.linear_motion import INTEGRATORS, LinearMotion
from siggen.dynamics.time.response import SampleGrid, response_of
from siggen.dynamics.time.transient import transient_s
from siggen.keys.number import constant
from siggen.planning.plan import PlannedRecord, planned_record
from siggen.planning.specimen import OperatingPoint, Specimen, draw_operating_point, draw_specimen
from siggen.record.simulation import start_angle_rad
from siggen.record.specimen_state import SpecimenState, specimen_state
from siggen.specimen.motion import specimen_motion

SEVERE = 3
STEPS, REFERENCE_STEPS = 4, 64
CHECKED_S = 0.2
"""Length of the signal whose error is computed."""
SHORT_S = 0.05
"""Length of the signal of the slow alternative; the transient before it is integrated too."""
METHODS: tuple[Method, ...] = ("DOP853", "LSODA")
CHANNEL = "pinion_bearing/vertical"


@dataclass(frozen=True, slots=True)
class _Case:
    """One record of paper A, ready to be integrated in many ways."""

    config: Config
    specimen: Specimen
    state: SpecimenState
    point: OperatingPoint
    planned: PlannedRecord

    def acceleration_m_s2(self, integrator: str, steps: int, duration_s: float) -> np.ndarray:
        """Return the acceleration of the pinion bearing (n,)."""
        dynamics = self.specimen.dynamics
        grid = SampleGrid(self.config.fs_hz, round(duration_s * self.config.fs_hz), steps)
        motion = LinearMotion(
            self.state.mesh.structure,
            self.state.mesh.tables,
            torque_nm=self.point.torque_nm,
            mesh_damping_ratio=constant(dynamics.mesh_damping_ratio),
            backlash_m=1e-6 * constant(dynamics.backlash_um),
            step_s=1.0 / (grid.fs_hz * steps),
            integrator=integrator,
        )
        drive = Drive(self.point.speed_hz, start_angle_rad(self.config, self.specimen, self.planned))
        response = response_of(motion, drive, grid)
        return response.acceleration_m_s2[CHANNEL]

    def transient_s(self) -> float:
        """Return the time that is integrated before the signal [s]."""
        dynamics, structure = self.specimen.dynamics, self.state.mesh.structure
        stiffness = mean_mesh_stiffness(self.state.mesh.tables)
        ratio = constant(dynamics.mesh_damping_ratio)
        damping = 2.0 * ratio * float(np.sqrt(stiffness * structure.mesh.mass_kg))
        law = mesh_law(self.state.mesh.tables, damping, 1e-6 * constant(dynamics.backlash_um))
        return transient_s(
            structure, equations_of_motion(structure, law, self.point.torque_nm, stiffness), np.array([damping])
        )


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the cost of product integration beside Runge-Kutta and scipy, with the errors of all."""
    case = _paper_case()
    duration_s, rounds = (1.0, 3) if quick else (case.config.duration_s, 5)
    cost = _costs(case, duration_s, rounds)
    error = {name: _error(case, name, STEPS, CHECKED_S) for name in cost}
    transient = case.transient_s()
    signal = f"{duration_s:g} s of signal + {transient:.2f} s transient"
    what = f"product integration, {STEPS} steps per sample, per s of signal ({signal})"
    fixed = f"Runge-Kutta, {STEPS} steps per sample"
    yield _row(what, cost["product"], error["product"], fixed, cost["runge_kutta"], error["runge_kutta"])
    short = f"{SHORT_S:g} s of signal, scaled"
    others = [("runge_kutta", REFERENCE_STEPS, f"Runge-Kutta, {REFERENCE_STEPS} steps per sample, {short}")]
    others += [(name, STEPS, f"solve_ivp {name}, rtol {RELATIVE_TOLERANCE:g}, {short}") for name in METHODS]
    for integrator, steps, name in others:
        with patch.dict(INTEGRATORS, solve_ivp_integrators(*METHODS)):
            start = time.process_time()
            case.acceleration_m_s2(integrator, steps, SHORT_S)
            per_second = (time.process_time() - start) / (SHORT_S + transient)
            other_error = _error(case, integrator, steps, SHORT_S)
        scaled = per_second * (duration_s + transient) / duration_s
        yield _row(what, cost["product"], error["product"], name, scaled, other_error)
    yield from _pair_rows(duration_s=1.0, rounds=rounds)


PAIR_CASES = {
    "friction off": ("dynamics.friction.model=off", "dynamics.mesh.damping=constant"),
    "mixed friction": ("dynamics.mesh.damping=constant",),
    "mixed friction, damping by asperities": (),
}
PAIR_GOAL_S = 0.13
"""Per second of signal: 410 000 evaluations of 11 accelerations and two tooth pairs, some 300 ns of arithmetic each."""


def _pair_rows(duration_s: float, rounds: int) -> Iterator[Row]:
    """Yield the cost of the time loop alone, for tooth pairs in a casing with the severe damage of paper_b."""
    loops = {name: _pair_loop(shipped(PAPER_B, *overrides), duration_s) for name, overrides in PAIR_CASES.items()}
    for loop in loops.values():
        loop(0)  # compiles
    for name, cost_s in medians({name: Candidate(loop) for name, loop in loops.items()}, rounds).items():
        what = f"time loop of law pairs, {PAIR_STEPS} steps per sample, 11 coordinates, {name}, per s of signal"
        per_second = cost_s / duration_s
        yield Row(what, duration_text(per_second), goal=f"<= {PAIR_GOAL_S:g} s", met=per_second <= PAIR_GOAL_S)


PAIR_STEPS = 2


def _pair_loop(config: Config, duration_s: float) -> Callable[[int], object]:
    """Return what steps the severe state through time once."""
    specimen = draw_specimen(config, 0)
    planned = planned_record(config, SEVERE * len(config.operating_points))
    point = draw_operating_point(config, 0, planned.operating_point_id)
    step_s = 1.0 / (config.fs_hz * PAIR_STEPS)
    motion = specimen_motion(specimen.dynamics, specimen_state(config, specimen, planned.state_id).mesh, point, step_s)
    steps = round(duration_s / step_s)
    pitches = np.arange(steps + 1, dtype=np.float64) * (motion.teeth * point.speed_hz * step_s)
    trajectory = np.empty((steps + 1, 2 * len(motion.structure.coordinates)))
    trajectory[0] = motion.start(pitches[0])
    return lambda _: motion.advance(pitches, no_inputs(pitches), trajectory)


def _costs(case: _Case, duration_s: float, rounds: int) -> dict[str, float]:
    """Return the CPU time per second of signal of siggen's integrators."""

    def integrated(integrator: str) -> Candidate:
        return Candidate(lambda _: case.acceleration_m_s2(integrator, STEPS, duration_s))

    for integrator in INTEGRATORS:
        case.acceleration_m_s2(integrator, STEPS, SHORT_S)  # compiles
    costs = medians({integrator: integrated(integrator) for integrator in INTEGRATORS}, rounds)
    return {integrator: cost_s / duration_s for integrator, cost_s in costs.items()}


def _paper_case() -> _Case:
    config = shipped(PAPER_A)
    planned = planned_record(config, SEVERE)
    specimen = draw_specimen(config, 0)
    return _Case(
        config, specimen, specimen_state(config, specimen, SEVERE), draw_operating_point(config, 0, 0), planned
    )


def _error(case: _Case, integrator: str, steps: int, duration_s: float) -> float:
    """Return the relative rms difference from product integration with many steps per sample."""
    reference = case.acceleration_m_s2("product", REFERENCE_STEPS, duration_s)
    difference = case.acceleration_m_s2(integrator, steps, duration_s) - reference
    return float(np.sqrt(np.mean(difference**2) / np.mean(reference**2)))


def _row(what: str, cost_s: float, error: float, name: str, other_s: float, other_error: float) -> Row:
    row = cost_row(what, cost_s, name, other_s)
    measured = f"{duration_text(cost_s)}, error {error:.0e}"
    return Row(what, measured, f"{row.alternative}, error {other_error:.0e}", row.ratio)
