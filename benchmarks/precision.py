"""Precision: error of the delivered acceleration and cost of the time loop, of every integrator of the law pairs.

Errors are against Runge-Kutta with REFERENCE_STEPS steps per sample, behind the same low-pass: the median over all
motions of a record of the relative rms difference. Costs are CPU time of the loop alone, per second of signal.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.row import Row, cost_row, duration_text
from benchmarks.shipped import ROOT, shipped
from siggen.arrays import FloatArray
from siggen.config import Config
from siggen.dynamics.time.equations import no_inputs
from siggen.dynamics.time.exponential_motion import ExponentialMotion
from siggen.dynamics.time.motion import Motion
from siggen.dynamics.time.pair_motion import PairMotion
from siggen.dynamics.time.response import Response, response_of
from siggen.planning.plan import planned_record
from siggen.planning.specimen import OperatingPoint, Specimen, draw_operating_point, draw_specimen
from siggen.record.simulation import SpecimenState, specimen_state, start_angle_rad
from siggen.specimen.drive import RecordDrive, record_drive
from siggen.specimen.integration import TimeGrid, time_grid
from siggen.specimen.motion import specimen_motion

PRESETS = (ROOT / "configs" / "quickstart.yaml", ROOT / "configs" / "bench.yaml")
CONTACTS = ("slices", "face")
REFERENCE_STEPS = 32
WAYS = (
    *(("exponential", steps) for steps in (1, 2, 4)),
    *(("runge_kutta", steps) for steps in (1, 2, 4, 8, 16)),
)
SIGNAL_S, LOOP_S, SCIPY_S = 0.3, 1.0, 0.02
GOAL_S, GOAL_ERROR, GOAL_FACTOR = 0.015, 1e-3, 1.5


@dataclass(frozen=True, slots=True)
class Case:
    """A record, ready to be integrated in many ways."""

    config: Config
    specimen: Specimen
    state: SpecimenState
    point: OperatingPoint
    driven: RecordDrive

    def motion(self, integrator: str, steps: int) -> Motion:
        """Return a motion with so many steps of integration per sample."""
        dynamics, grid = self.specimen.dynamics.model_copy(update={"integrator": integrator}), _grid(integrator, steps)
        step_s = 1.0 / (self.config.fs_hz * grid.per_sample)
        return specimen_motion(dynamics, self.state.mesh, self.point, step_s, self.driven, stride=grid.stride)

    def own_steps(self) -> int:
        """Return the steps of integration per sample that the rule takes."""
        mesh = self.state.mesh
        grid = time_grid(self.config, self.specimen, mesh.structure, mesh.tables)
        return grid.per_sample // grid.stride

    def response(self, integrator: str, steps: int) -> Response:
        """Return the response to SIGNAL_S."""
        return response_of(
            self.motion(integrator, steps), self.driven.rotation, fs_hz=self.config.fs_hz,
            samples=round(SIGNAL_S * self.config.fs_hz), bearing_forces=False,
            steps_per_sample=_grid(integrator, steps).per_sample,
            excitation=self.driven.excitation,
        )  # fmt: skip

    def driven_steps(self, motion: Motion, per_sample: int, duration_s: float) -> tuple[FloatArray, FloatArray]:
        """Return the angles in base pitches and the inputs at so many steps per sample from sample 0 on."""
        rate_hz = self.config.fs_hz * per_sample
        times = np.arange(round(duration_s * rate_hz) + 1) / rate_hz
        pitches = self.driven.rotation.angle_rad(times) * motion.teeth / (2.0 * np.pi)
        excitation = self.driven.excitation
        inputs = no_inputs(pitches) if excitation is None else excitation.inputs(times, self.driven.rotation)
        return pitches, inputs

    def loop_s(self, integrator: str, steps: int, rounds: int = 3) -> float:
        """Return the CPU time of the loop per second of signal, the median of some rounds."""
        motion = self.motion(integrator, steps)
        pitches, inputs = self.driven_steps(motion, _grid(integrator, steps).per_sample, LOOP_S)
        path = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))
        found = []
        for _ in range(rounds + 1):
            path[0] = motion.start(pitches[0])
            begin = time.process_time()
            motion.advance(pitches, inputs, path)
            found.append((time.process_time() - begin) / LOOP_S)
        return float(np.median(found[1:]))  # the first one compiles


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield errors by class with the steps that the tolerance asks for, and work against precision."""
    for contact in CONTACTS:
        yield from _classes(contact, 1 if quick else 6)
    for contact, tilt in (("slices", False), ("face", False), ("face", True)):
        case = precision_case(PRESETS[0], contact, 0, -1, tilt=tilt)
        yield from _work_rows(case, f"severe state, {contact}, {'with' if tilt else 'without'} tilt")
    yield from _scipy_rows(precision_case(PRESETS[0], "slices", 0, -1))


def _work_rows(case: Case, what: str) -> Iterator[Row]:
    """Yield cost against error of both integrators, called in turn, and how much cheaper one is at equal error."""
    fine = case.response("runge_kutta", REFERENCE_STEPS)
    errors = {way: _error(case.response(*way), fine) for way in WAYS}
    rounds = [{way: case.loop_s(*way, rounds=1) for way in WAYS} for _ in range(3)]
    costs = {way: float(np.median([one[way] for one in rounds])) for way in WAYS}
    for way in WAYS:
        yield Row(f"{what}: {way[0]}, {way[1]} steps", f"{duration_text(costs[way])}, error {errors[way]:.1e}")
    own = ("exponential", case.own_steps())
    others = sorted((way for way in WAYS if way[0] == "runge_kutta"), key=lambda way: errors[way])
    logs = np.log([[errors[way], costs[way]] for way in others])
    equal = float(np.exp(np.interp(np.log(errors[own]), logs[:, 0], logs[:, 1])))
    yield cost_row(
        f"{what}: exponential with the steps of the rule ({own[1]})", costs[own],
        f"Runge-Kutta at its error of {errors[own]:.1e}, between the rows above", equal,
    )  # fmt: skip


def _classes(contact: str, gearboxes: int) -> Iterator[Row]:
    """Yield the errors of the healthy and of the severest state over gearboxes of all presets, and what they cost."""
    errors: dict[str, list[float]] = {"healthy": [], "severest": []}
    costs, tried = [], []
    for preset in PRESETS:
        for gearbox in range(gearboxes):
            for name, state in (("healthy", 0), ("severest", -1)):
                case = precision_case(preset, contact, gearbox, state)
                steps = case.own_steps()
                fine = case.response("runge_kutta", REFERENCE_STEPS)
                errors[name].append(_error(case.response("exponential", steps), fine))
                costs.append(case.loop_s("exponential", steps))
                tried.append(_attempts(case, steps))
    for name, found in errors.items():
        median = float(np.median(found))
        yield Row(
            f"{contact}, {name}, {len(found)} records: error (median over motions)",
            f"median {median:.1e}, largest {max(found):.1e}", goal=f"<= {GOAL_ERROR:g}", met=max(found) <= GOAL_ERROR,
        )  # fmt: skip
    medians = [float(np.median(found)) for found in errors.values()]
    factor = max(medians) / min(medians)
    yield Row(
        f"{contact}: medians of the classes, factor", f"{factor:.2f}", goal=f"<= {GOAL_FACTOR}", met=factor <= 1.5
    )
    cost = float(np.median(costs))
    what = f"{contact}: time loop per s of signal, {np.median(tried):.2f} steps tried per sample"
    yield Row(what, duration_text(cost), goal=f"<= {duration_text(GOAL_S)}", met=cost <= GOAL_S)


def _attempts(case: Case, steps: int) -> float:
    """Return how many steps are tried per sample."""
    motion = case.motion("exponential", steps)
    assert isinstance(motion, ExponentialMotion)
    pitches, inputs = case.driven_steps(motion, _grid("exponential", steps).per_sample, 0.2)
    path = np.empty((pitches.size, 2 * len(motion.structure.coordinates)))
    path[0] = motion.start(pitches[0])
    motion.advance(pitches, inputs, path)
    return motion.steps_tried / (0.2 * case.config.fs_hz)


def _grid(integrator: str, steps: int) -> TimeGrid:
    """Return where states are with so many steps per sample: of the exponential one never fewer than two per sample."""
    return TimeGrid(2, 2) if (integrator, steps) == ("exponential", 1) else TimeGrid(steps, 1)


def _scipy_rows(case: Case) -> Iterator[Row]:
    """Yield scipy's adaptive methods from the static start at constant speed; errors in the rate of the approach."""
    reference = case.motion("runge_kutta", 64)
    assert isinstance(reference, PairMotion)
    fs_hz, vector = case.config.fs_hz, reference.structure.mesh_vector
    samples, per_s = round(SCIPY_S * fs_hz), reference.teeth * case.point.speed_hz
    start = reference.start(0.3)

    def rates(motion: PairMotion, steps: int) -> np.ndarray:
        pitches = 0.3 + per_s * np.arange(samples * steps + 1) / (fs_hz * steps)
        path = np.empty((pitches.size, start.size))
        motion.start(0.3)
        path[0] = start
        inputs = np.zeros((pitches.size, motion.equations.external_input.shape[0]))
        motion.advance(pitches, inputs, path)
        return np.asarray(path[::steps, vector.size :] @ vector)

    fine = rates(reference, 64)
    exponential = case.motion("exponential", 2)
    assert isinstance(exponential, PairMotion)
    own = _relative(rates(exponential, 2), fine)
    for method in ("DOP853", "LSODA"):
        begin = time.process_time()
        found = solve_ivp(
            lambda t, z: reference.rate(z, 0.3 + per_s * t), (0.0, SCIPY_S), start, method=method, rtol=1e-5,
            atol=1e-11, t_eval=np.arange(samples + 1) / fs_hz,
        )  # fmt: skip
        cost = (time.process_time() - begin) / SCIPY_S
        error = _relative(found.y[vector.size :].T @ vector, fine)
        what = f"severe state, slices: scipy {method}, rtol 1e-5, 20 ms from the static start, scaled"
        yield Row(what, f"{duration_text(cost)}, error {error:.1e}", f"exponential, 2 steps: error {own:.1e}")


def _relative(found: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.sqrt(np.mean((found - wanted) ** 2) / np.mean(wanted**2)))


def _error(found: Response, wanted: Response) -> float:
    """Return the median over the motions of the relative rms difference."""
    pairs = [(found.acceleration_m_s2[name], values) for name, values in wanted.acceleration_m_s2.items()]
    return float(np.median([_relative(one, other) for one, other in pairs]))


def precision_case(preset: Path, contact: str, gearbox: int, state: int, *, tilt: bool = True) -> Case:
    """Return a record of a preset of a state, negative from the last one on, ready to be integrated in many ways."""
    rigid = ("dynamics.shafts=null",) if contact == "slices" or not tilt else ()  # slices do not feel a tilt
    config = shipped(preset, f"dynamics.mesh.contact={contact}", f"duration_s={SIGNAL_S}", *rigid)
    state_id = state % len(config.states)
    record = next(
        one
        for one in (
            planned_record(config, gearbox * config.records_per_specimen + i)
            for i in range(config.records_per_specimen)
        )
        if one.state_id == state_id
    )
    specimen = draw_specimen(config, gearbox)
    made = specimen_state(config, specimen, state_id)
    point = draw_operating_point(config, gearbox, record.operating_point_id)
    angle = start_angle_rad(config, made.pair, record)
    driven = record_drive(config, specimen, made.pair, made.mesh.structure, point, record, angle)
    return Case(config, specimen, made, point, driven)
