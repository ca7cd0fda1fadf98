"""Response: accelerations and bearing forces of a gear stage at the output rate, after the transient."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numba import njit
from numpy.typing import NDArray

from siggen.dynamics.decimation import Decimator, half_length, second_difference_taps, value_taps
from siggen.dynamics.drive import Drive
from siggen.dynamics.equations import Equations, approach_of, equations_of_motion, start_state
from siggen.dynamics.mesh_force import MeshLaw, in_contact, mean_mesh_stiffness, mesh_force, mesh_law, mesh_stiffness
from siggen.dynamics.modes import slowest_decay_per_s
from siggen.dynamics.product_integration import ProductIntegration
from siggen.dynamics.runge_kutta import RungeKutta
from siggen.dynamics.structure import Structure
from siggen.errors import SolverFailure

if TYPE_CHECKING:
    from siggen.gears.tables import MeshTables

FloatArray = NDArray[np.float64]


class Integrator(Protocol):
    """What steps a state through time."""

    def advance(self, pitches: FloatArray, trajectory: FloatArray) -> None:
        """Fill rows 1.. of `trajectory` (steps + 1, 2n) from row 0, with the pinion angles `pitches` (steps + 1,)."""


INTEGRATORS: Mapping[str, Callable[[Equations, MeshLaw, float], Integrator]] = {
    "product": ProductIntegration,
    "runge_kutta": RungeKutta,
}

DECAY_TIMES = 5.0
"""Length of the discarded transient in decay times of the slowest mode that the mesh excites; from the static start
less than 1e-5 of the acceleration is left then."""
TRANSIENT_CAP_S = 5.0
"""Longest transient that is computed; reached by modes that decay slower than 1/s, undamped ones included."""
APPROACH_LIMIT_PITCHES = 0.1
"""Penetration of the flanks, in base pitches, beyond which no teeth exist: about 1 mm, a hundred times a usual load."""
BLOCK_SAMPLES = 2048
"""Output samples per block of integration; bounds the memory independently of the duration."""


@dataclass(frozen=True, slots=True)
class Response:
    """What the gear stage does, at the output rate; sample 0 is at time 0. A failed one has a status and empty arrays.

    Attributes
    ----------
    acceleration_m_s2 : place/axis -> (n,), low-passed to the band of `fs_hz`
    bearing_force_n : place/axis -> (n,), force of spring and damper on the housing, low-passed alike, mean included
    angle_rad : (n,) pinion angle at the samples
    tacho_s : (k,) times of whole revolutions of the pinion
    contact_loss_share : share of the time with the approach inside the backlash gap; 0 if the simulation failed
    status, reason : "ok" and "", or what went wrong, with numbers
    internals : name -> (n,), values at the instants of the samples, not low-passed; empty unless asked for
    """

    fs_hz: float
    acceleration_m_s2: Mapping[str, FloatArray]
    bearing_force_n: Mapping[str, FloatArray]
    angle_rad: FloatArray
    tacho_s: FloatArray
    contact_loss_share: float
    status: str
    reason: str
    internals: Mapping[str, FloatArray]


@dataclass(frozen=True, slots=True)
class _Run:
    """A model with its time grid: `steps_per_sample` integration steps per output sample, step 0 at time 0."""

    structure: Structure
    law: MeshLaw
    equations: Equations
    drive: Drive
    integrator: Integrator
    fs_hz: float
    steps_per_sample: int
    transient_s: float
    limit_m: float

    def time_s(self, first: int, count: int) -> FloatArray:
        return np.arange(first, first + count) / (self.fs_hz * self.steps_per_sample)

    def pitches(self, first: int, count: int) -> FloatArray:
        """Return the pinion angle in base pitches at `count` steps from step `first`."""
        return self.drive.angle_rad(self.time_s(first, count)) * (self.law.table_of_pair.shape[0] / (2.0 * np.pi))


def simulate_response(
    structure: Structure,
    tables: MeshTables,
    *,
    torque_nm: float,
    speed_hz: float,
    start_angle_rad: float,
    mesh_damping_ratio: float,
    backlash_m: float,
    fs_hz: float,
    samples: int,
    steps_per_sample: int,
    integrator: str = "product",
    internals: bool = False,
) -> Response:
    """Return the stationary response of a gear stage at constant speed and motor torque.

    Starts from the static equilibrium and discards DECAY_TIMES decay times of the slowest excited mode. Mesh damping is
    c = 2 ζ √(K m_e) with the mean healthy mesh stiffness K, so that it is the same for every state of a gear pair.

    Parameters
    ----------
    torque_nm : motor torque; negative loads the back flank
    speed_hz, start_angle_rad : pinion speed and its angle at sample 0
    mesh_damping_ratio, backlash_m : ζ and the total normal backlash j_n; backlash 0 gives the linear model
    fs_hz, samples, steps_per_sample : output rate, number of output samples, integration steps per output sample
    integrator : "product" or "runge_kutta"
    internals : whether to add mesh_force_n, mesh_stiffness_n_per_m, approach_m (half the backlash plus the dynamic
        transmission error on the drive flank) and approach_rate_m_s

    Raises
    ------
    ValueError
        If an argument is outside its allowed range.
    """
    _check_grid(fs_hz, samples, steps_per_sample, mesh_damping_ratio, integrator)
    stiffness = mean_mesh_stiffness(tables)
    damping = 2.0 * mesh_damping_ratio * float(np.sqrt(stiffness * structure.equivalent_mesh_mass_kg))
    law = mesh_law(tables, damping, backlash_m)
    equations = equations_of_motion(structure, law, torque_nm, stiffness)
    run = _Run(
        structure=structure,
        law=law,
        equations=equations,
        drive=Drive(speed_hz, start_angle_rad),
        integrator=INTEGRATORS[integrator](equations, law, 1.0 / (fs_hz * steps_per_sample)),
        fs_hz=fs_hz,
        steps_per_sample=steps_per_sample,
        transient_s=transient_s(structure, equations, damping),
        limit_m=0.5 * backlash_m + APPROACH_LIMIT_PITCHES * tables.base_pitch_m,
    )
    try:
        return _simulate(run, samples, internals)
    except SolverFailure as failure:
        return _failed(run, failure)


def _check_grid(fs_hz: float, samples: int, steps_per_sample: int, damping_ratio: float, integrator: str) -> None:
    if not (np.isfinite(fs_hz) and fs_hz > 0.0):
        raise ValueError(f"fs_hz: received {fs_hz}; allowed are finite rates above 0")
    if samples < 1 or steps_per_sample < 1:
        raise ValueError(
            f"samples, steps_per_sample: received {samples}, {steps_per_sample}; allowed are counts from 1"
        )
    if not (np.isfinite(damping_ratio) and damping_ratio >= 0.0):
        raise ValueError(f"mesh_damping_ratio: received {damping_ratio}; allowed are finite values from 0")
    if integrator not in INTEGRATORS:
        raise ValueError(f"integrator: received {integrator!r}; allowed are {', '.join(INTEGRATORS)}")


def transient_s(structure: Structure, equations: Equations, mesh_damping_n_s_per_m: float) -> float:
    """Return the time [s] that is simulated and discarded before sample 0."""
    decay = slowest_decay_per_s(structure, equations, mesh_damping_n_s_per_m)
    return min(TRANSIENT_CAP_S, DECAY_TIMES / decay) if decay > 0.0 else TRANSIENT_CAP_S


def _simulate(run: _Run, samples: int, internals: bool) -> Response:
    """Step through transient and record block by block; keep only the filtered outputs and what was asked for."""
    half = half_length(run.steps_per_sample)
    settle = math.ceil(run.transient_s * run.fs_hz * run.steps_per_sample)
    state = start_state(run.structure, run.law, run.equations, run.pitches(-half - settle, 1)[0])
    for _ in _blocks(run, state, -half - settle, -half):
        pass
    accelerations, forces = _decimators(run, samples)
    inner: list[FloatArray] = []
    lost = 0
    for first, states in _blocks(run, state, -half, (samples - 1) * run.steps_per_sample + half + 1):
        accelerations.take(states)
        forces.take(states)
        recorded = states[max(0, -first) : max(0, samples * run.steps_per_sample - first)]
        lost += _steps_in_gap(run.equations, run.law, recorded)
        if internals:
            inner.append(_inner_values(run, first, states, samples))
    share = lost / (samples * run.steps_per_sample)
    return _finished(run, accelerations.values, forces.values, inner, share)


def _blocks(run: _Run, state: FloatArray, start: int, stop: int) -> Iterator[tuple[int, FloatArray]]:
    """Yield (first step, states (steps, 2n)) from step `start` up to but without `stop`; leave `state` at `stop`.

    Raises
    ------
    SolverFailure
        If the state is not finite or the teeth would have passed through each other.
    """
    block = BLOCK_SAMPLES * run.steps_per_sample
    trajectory = np.empty((min(block, stop - start) + 1, state.size))
    for first in range(start, stop, block):
        count = min(block, stop - first)
        trajectory[0] = state
        run.integrator.advance(run.pitches(first, count + 1), trajectory[: count + 1])
        beyond = _first_beyond(run.equations, trajectory[: count + 1], run.limit_m)
        if beyond >= 0:
            raise _divergence(run, first + beyond, trajectory[beyond])
        state[:] = trajectory[count]
        yield first, trajectory[:count]


def _divergence(run: _Run, step: int, state: FloatArray) -> SolverFailure:
    approach, _ = approach_of(run.equations, state)
    time = step / (run.fs_hz * run.steps_per_sample)
    return SolverFailure(
        "diverged",
        f"approach {approach:.3e} m at {time:.6f} s (before 0 s: transient); allowed are finite values within "
        f"{run.limit_m:.3e} m; raise steps_per_sample (received {run.steps_per_sample}) or the damping",
    )


@njit(cache=True)
def _first_beyond(equations: Equations, states: FloatArray, limit_m: float) -> int:
    """Return the first row whose approach is not a finite number within the limit, or -1."""
    for i in range(states.shape[0]):
        approach, _ = approach_of(equations, states[i])
        if not abs(approach) <= limit_m:
            return i
    return -1


@njit(cache=True)
def _steps_in_gap(equations: Equations, law: MeshLaw, states: FloatArray) -> int:
    count = 0
    for i in range(states.shape[0]):
        approach, _ = approach_of(equations, states[i])
        if not in_contact(law, approach):
            count += 1
    return count


INTERNALS = ("mesh_force_n", "mesh_stiffness_n_per_m", "approach_m", "approach_rate_m_s")


def _inner_values(run: _Run, first: int, states: FloatArray, samples: int) -> FloatArray:
    """Return the internals (k, 4) at those steps of a block that are output samples."""
    steps = np.arange(first, first + len(states))
    chosen = (steps >= 0) & (steps % run.steps_per_sample == 0) & (steps < samples * run.steps_per_sample)
    pitches = run.pitches(first, len(states))
    return _evaluate_inner(run.equations, run.law, states[chosen], pitches[chosen])


@njit(cache=True)
def _evaluate_inner(equations: Equations, law: MeshLaw, states: FloatArray, pitches: FloatArray) -> FloatArray:
    result = np.empty((states.shape[0], 4))
    for i in range(states.shape[0]):
        approach, rate = approach_of(equations, states[i])
        result[i, 0] = mesh_force(law, approach, rate, pitches[i])
        result[i, 1] = mesh_stiffness(law, pitches[i])
        result[i, 2] = approach
        result[i, 3] = rate
    return result


def _decimators(run: _Run, samples: int) -> tuple[Decimator, Decimator]:
    """Return what filters accelerations (from displacements) and bearing forces (about their static values)."""
    structure, steps = run.structure, run.steps_per_sample
    still = np.zeros(len(structure.coordinates))
    motions = np.array([np.concatenate([motion, still]) for motion in structure.motions.values()])
    forces = np.array([np.concatenate(pair) for pair in structure.bearing_forces.values()])
    second_rate = second_difference_taps(steps) * (run.fs_hz * steps) ** 2
    return Decimator(motions, second_rate, steps, samples), Decimator(forces, value_taps(steps), steps, samples)


def _finished(
    run: _Run, accelerations: FloatArray, forces: FloatArray, inner: list[FloatArray], contact_loss_share: float
) -> Response:
    """Name the columns of accelerations and forces (n, channels) and of the internals."""
    static = run.equations.static_deflection
    bearings = run.structure.bearing_forces
    return Response(
        fs_hz=run.fs_hz,
        acceleration_m_s2=_named(run.structure.motions, accelerations.T),
        bearing_force_n=_named(
            bearings,
            [column + (pair[0] * static).sum() for column, pair in zip(forces.T, bearings.values(), strict=True)],
        ),
        angle_rad=_frozen(run.drive.angle_rad(np.arange(len(accelerations)) / run.fs_hz)),
        tacho_s=run.drive.tacho_s(len(accelerations) / run.fs_hz),
        contact_loss_share=contact_loss_share,
        status="ok",
        reason="",
        internals=_named(INTERNALS, np.concatenate(inner).T) if inner else {},
    )


def _named(names: Iterable[str], columns: Iterable[FloatArray]) -> Mapping[str, FloatArray]:
    return {name: _frozen(column) for name, column in zip(names, columns, strict=True)}


def _failed(run: _Run, failure: SolverFailure) -> Response:
    """Return a response without samples that says what went wrong."""
    empty = _frozen(np.empty(0))
    return Response(
        fs_hz=run.fs_hz,
        acceleration_m_s2=dict.fromkeys(run.structure.motions, empty),
        bearing_force_n=dict.fromkeys(run.structure.bearing_forces, empty),
        angle_rad=empty,
        tacho_s=empty,
        contact_loss_share=0.0,
        status=failure.status,
        reason=failure.reason,
        internals={},
    )


def _frozen(values: FloatArray) -> FloatArray:
    """Return a contiguous read-only copy."""
    array = np.array(values)
    array.setflags(write=False)
    return array
