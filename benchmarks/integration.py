"""Integration of the severe state of paper A: cost per second of signal, and error, of every integrator."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from unittest.mock import patch

import numpy as np

from benchmarks.row import Row, cost_row, duration_text
from benchmarks.shipped import PAPER_A, shipped
from benchmarks.solve_ivp import RELATIVE_TOLERANCE, solve_ivp_integrators
from benchmarks.timing import Candidate, medians
from siggen.config import Config, constant
from siggen.dataset.plan import PlannedRecord, planned_record
from siggen.dataset.specimen import OperatingPoint, Specimen, draw_operating_point, draw_specimen
from siggen.dynamics.equations import equations_of_motion
from siggen.dynamics.mesh_force import mean_mesh_stiffness, mesh_law
from siggen.dynamics.response import INTEGRATORS, simulate_response, transient_s
from siggen.simulation import SpecimenState, specimen_state, start_angle_rad

SEVERE = 3
STEPS, REFERENCE_STEPS = 4, 64
CHECKED_S = 0.2
"""Length of the signal whose error is computed."""
SHORT_S = 0.05
"""Length of the signal of the slow alternative; the transient before it is integrated too."""
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
        response = simulate_response(
            self.state.structure,
            self.state.tables,
            torque_nm=self.point.torque_nm,
            speed_hz=self.point.speed_hz,
            start_angle_rad=start_angle_rad(self.config, self.state.pair, self.planned),
            mesh_damping_ratio=constant(dynamics.mesh_damping_ratio),
            backlash_m=1e-6 * constant(dynamics.backlash_um),
            fs_hz=self.config.fs_hz,
            samples=round(duration_s * self.config.fs_hz),
            steps_per_sample=steps,
            integrator=integrator,
        )
        return response.acceleration_m_s2[CHANNEL]

    def transient_s(self) -> float:
        """Return the time that is integrated before the signal [s]."""
        dynamics, structure = self.specimen.dynamics, self.state.structure
        stiffness = mean_mesh_stiffness(self.state.tables)
        ratio = constant(dynamics.mesh_damping_ratio)
        damping = 2.0 * ratio * float(np.sqrt(stiffness * structure.equivalent_mesh_mass_kg))
        law = mesh_law(self.state.tables, damping, 1e-6 * constant(dynamics.backlash_um))
        return transient_s(structure, equations_of_motion(structure, law, self.point.torque_nm, stiffness), damping)


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the cost of product integration beside Runge-Kutta and scipy, with the errors of all."""
    case = _paper_case()
    duration_s, rounds = (1.0, 3) if quick else (case.config.duration_s, 5)
    errors = _errors(case)
    candidates = {
        name: Candidate(lambda _, name=name, steps=steps: case.acceleration_m_s2(name, steps, duration_s))
        for name, steps in (("product", STEPS), ("runge_kutta", STEPS))
    }
    cost = {name: value / duration_s for name, value in medians(candidates, rounds).items()}
    what = f"product, {STEPS} steps, {duration_s:g} s of signal + {case.transient_s():.2f} s transient, per s of signal"
    yield _row(
        what, cost["product"], errors["product"], "Runge-Kutta, 4 steps", cost["runge_kutta"], errors["runge_kutta"]
    )
    scale = (duration_s + case.transient_s()) / duration_s
    for method in ("DOP853",) if quick else ("DOP853", "LSODA"):
        cost_s, error = _by_scipy(case, method)
        name = f"solve_ivp {method}, rtol {RELATIVE_TOLERANCE:g}, {SHORT_S:g} s + transient, scaled"
        yield _row(what, cost["product"], errors["product"], name, cost_s * scale, error)


def _paper_case() -> _Case:
    config = shipped(PAPER_A)
    planned = planned_record(config, SEVERE)
    specimen = draw_specimen(config, 0)
    return _Case(
        config, specimen, specimen_state(config, specimen, SEVERE), draw_operating_point(config, 0, 0), planned
    )


def _errors(case: _Case) -> dict[str, float]:
    reference = case.acceleration_m_s2("product", REFERENCE_STEPS, CHECKED_S)
    return {name: _error(case.acceleration_m_s2(name, STEPS, CHECKED_S), reference) for name in INTEGRATORS}


def _by_scipy(case: _Case, method: str) -> tuple[float, float]:
    """Return CPU time per integrated second, and the error, of scipy's method."""
    with patch.dict(INTEGRATORS, solve_ivp_integrators(method)):
        start = time.process_time()
        short = case.acceleration_m_s2(method, STEPS, SHORT_S)
        cost_s = time.process_time() - start
    reference = case.acceleration_m_s2("product", REFERENCE_STEPS, SHORT_S)
    return cost_s / (SHORT_S + case.transient_s()), _error(short, reference)


def _error(acceleration: np.ndarray, reference: np.ndarray) -> float:
    return float(np.sqrt(np.mean((acceleration - reference) ** 2) / np.mean(reference**2)))


def _row(what: str, cost_s: float, error: float, name: str, other_s: float, other_error: float) -> Row:
    row = cost_row(what, cost_s, name, other_s)
    measured = f"{duration_text(cost_s)}, error {error:.0e}"
    return Row(what, measured, f"{row.alternative}, error {other_error:.0e}", row.ratio)
