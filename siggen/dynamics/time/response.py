"""Response: accelerations and bearing forces of a gear stage at the output rate, after the transient."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import njit
from siggen.dynamics.drive.drive import Drive, Rotation
from siggen.dynamics.drive.excitation import Excitation
from siggen.dynamics.drive.sampled_excitation import SampledExcitation
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.decimation import half_length
from siggen.dynamics.time.equations import Equations, approach_of, no_inputs
from siggen.dynamics.time.history import History
from siggen.dynamics.time.linear_motion import LinearMotion
from siggen.dynamics.time.motion import Motion
from siggen.dynamics.time.response_filters import acceleration_decimator, force_decimator
from siggen.dynamics.time.transient import settling_steps
from siggen.errors import SolverFailure

if TYPE_CHECKING:
    from siggen.gears.stiffness.mesh_tables import MeshTables


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
    bearing_force_n : place/axis -> (n,), force of spring and damper on the housing, low-passed alike, mean included;
        empty if not asked for
    angle_rad : (n,) pinion angle at the samples
    tacho_s : (k,) times of whole revolutions of the pinion
    contact_loss_share : share of the time with the approach inside the backlash gap; 0 if the simulation failed
    status, reason : "ok" and "", or what went wrong, with numbers
    internals : name -> (n,), values at the instants of the samples, not low-passed; empty unless asked for
    history : the samples before sample 0 of accelerations and bearing forces; (0,) arrays unless asked for
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
    history: History


@dataclass(frozen=True, slots=True)
class _Run:
    """A motion with its time grid, `steps_per_sample` states per sample, step 0 at time 0, and wanted `motions`."""

    motion: Motion
    drive: Rotation
    fs_hz: float
    steps_per_sample: int
    excitation: Excitation | SampledExcitation | None = None
    motions: tuple[str, ...] = ()

    @property
    def limit_m(self) -> float:
        return self.motion.largest_approach_m + APPROACH_LIMIT_PITCHES * self.motion.base_pitch_m

    def time_s(self, first: int, count: int) -> FloatArray:
        return np.arange(first, first + count) / (self.fs_hz * self.steps_per_sample)

    def pitches(self, first: int, count: int) -> FloatArray:
        """Return the pinion angle in base pitches at `count` steps from step `first`."""
        return self.drive.angle_rad(self.time_s(first, count)) * (self.motion.teeth / (2.0 * np.pi))

    def inputs(self, first: int, pitches: FloatArray) -> FloatArray:
        """Return the external inputs (k, m) at the steps from step `first` whose pinion angles are given."""
        if self.excitation is None:
            return no_inputs(pitches)
        return self.excitation.inputs(self.time_s(first, pitches.size), self.drive)


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
    """Return the stationary response under the linear mesh law at constant speed and motor torque.

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
    check_grid(fs_hz, samples, steps_per_sample)
    motion = LinearMotion(
        structure,
        tables,
        torque_nm=torque_nm,
        mesh_damping_ratio=mesh_damping_ratio,
        backlash_m=backlash_m,
        step_s=1.0 / (fs_hz * steps_per_sample),
        integrator=integrator,
    )
    drive = Drive(speed_hz, start_angle_rad)
    return response_of(
        motion, drive, fs_hz=fs_hz, samples=samples, steps_per_sample=steps_per_sample, internals=internals
    )


def response_of(
    motion: Motion,
    drive: Rotation,
    *,
    fs_hz: float,
    samples: int,
    steps_per_sample: int,
    internals: bool = False,
    bearing_forces: bool = True,
    motions: Collection[str] | None = None,
    excitation: Excitation | None = None,
    settle_s: float = 0.0,
    history_s: float = 0.0,
) -> Response:
    """Return the stationary response of a motion that was made for the step 1/(fs_hz steps_per_sample).

    Starts from the static equilibrium and discards the transient that the motion states, or `settle_s` if that is
    longer. Of this time the last `history_s` at most are kept as history; asking for it changes nothing else.
    Filtering costs about a fifth of a response for four forces or motions: without `bearing_forces` there are none, and
    accelerations are those of the named `motions`; None: all. The motion must hold the vectors of `excitation`.

    Raises
    ------
    ValueError
        If rate or counts are not positive.
    """
    check_grid(fs_hz, samples, steps_per_sample)
    settle = settling_steps(motion.transient_s, settle_s, fs_hz * steps_per_sample)
    history = min(round(history_s * fs_hz), settle // steps_per_sample)
    acting: Excitation | SampledExcitation | None = excitation
    if excitation is not None and motion.coarse_inputs:
        half, rate_hz = half_length(steps_per_sample), fs_hz * steps_per_sample
        ends_s = -(settle + half) / rate_hz, (samples * steps_per_sample + half) / rate_hz
        acting = SampledExcitation(excitation, drive, *ends_s, rate_hz)
    wanted = tuple(name for name in motion.structure.motions if motions is None or name in motions)
    run = _Run(motion, drive, fs_hz, steps_per_sample, acting, wanted)
    try:
        return _simulate(run, samples, internals, bearing_forces, settle, history)
    except SolverFailure as failure:
        return _failed(run, failure)


def check_grid(fs_hz: float, samples: int, steps_per_sample: int) -> None:
    """Refuse rates and counts that are no time grid.

    Raises
    ------
    ValueError
        If one of them is not positive.
    """
    if not (np.isfinite(fs_hz) and fs_hz > 0.0):
        raise ValueError(f"fs_hz: received {fs_hz}; allowed are finite rates above 0")
    if samples < 1 or steps_per_sample < 1:
        raise ValueError(
            f"samples, steps_per_sample: received {samples}, {steps_per_sample}; allowed are counts from 1"
        )


def _simulate(run: _Run, samples: int, internals: bool, bearing_forces: bool, settle: int, history: int) -> Response:
    """Step through transient and record block by block; keep only the filtered outputs and what was asked for."""
    half, steps = half_length(run.steps_per_sample), run.steps_per_sample
    state = run.motion.start(run.pitches(-half - settle, 1)[0])
    begin = -half - history * steps
    for _ in _blocks(run, state, -half - settle, begin):
        pass
    structure = run.motion.structure
    decimators = [acceleration_decimator(structure, run.motions, run.fs_hz, steps, history + samples)]
    decimators += [force_decimator(structure, steps, history + samples)] if bearing_forces else []
    inner: list[FloatArray] = []
    lost = 0
    for first, states, apart in _blocks(run, state, begin, (samples - 1) * steps + half + 1):
        for decimator in decimators:
            decimator.take(states)
        recorded = slice(max(0, -first), max(0, samples * steps - first))
        run.motion.refuse_outside(states[recorded])
        lost += _steps_apart(run, first, states, apart, recorded)
        if internals and first + len(states) > 0:  # nothing of the history
            inner.append(_inner_values(run, first, states, samples))
    return _finished(run, [d.values for d in decimators], inner, lost / (samples * steps), history)


def _steps_apart(run: _Run, first: int, states: FloatArray, apart: NDArray[np.bool_] | None, recorded: slice) -> int:
    """Return at how many of the recorded steps of a block no teeth touch."""
    if apart is None:
        return run.motion.steps_apart(states[recorded], run.pitches(first, len(states))[recorded])
    return int(apart[recorded].sum())


def _blocks(
    run: _Run, state: FloatArray, start: int, stop: int
) -> Iterator[tuple[int, FloatArray, NDArray[np.bool_] | None]]:
    """Yield first step, states (steps, 2n) and where teeth are apart, if known, from step `start` up to without `stop`.

    Leaves `state` at `stop`.

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
        pitches = run.pitches(first, count + 1)
        apart = run.motion.advance(pitches, run.inputs(first, pitches), trajectory[: count + 1])
        beyond = _first_beyond(run.motion.equations, trajectory[: count + 1], run.limit_m)
        if beyond >= 0:
            raise _divergence(run, first + beyond, trajectory[beyond])
        state[:] = trajectory[count]
        yield first, trajectory[:count], apart


def _divergence(run: _Run, step: int, state: FloatArray) -> SolverFailure:
    approach, _ = approach_of(run.motion.equations, state)
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


def _inner_values(run: _Run, first: int, states: FloatArray, samples: int) -> FloatArray:
    """Return the internals (k, names) at those steps of a block that are output samples."""
    steps = np.arange(first, first + len(states))
    chosen = (steps >= 0) & (steps % run.steps_per_sample == 0) & (steps < samples * run.steps_per_sample)
    pitches = run.pitches(first, len(states))
    return run.motion.internals(states[chosen], pitches[chosen], run.inputs(first, pitches)[chosen])


def _finished(
    run: _Run, values: list[FloatArray], inner: list[FloatArray], contact_loss_share: float, history: int
) -> Response:
    """Name the rows of accelerations and forces (channels, history + n), forces if there are any, and internals."""
    motions, names, count = run.motions, run.motion.structure.bearing_forces, values[0].shape[1] - history
    for forces in values[1:]:
        _add_static_part(run, forces)
    before, recorded = [_named(names, p) for f in values[1:] for p in np.split(f, [history], axis=1)] or ({}, {})
    return Response(
        fs_hz=run.fs_hz,
        acceleration_m_s2=_named(motions, values[0][:, history:]),
        bearing_force_n=recorded,
        angle_rad=_frozen(run.drive.angle_rad(np.arange(count) / run.fs_hz)),
        tacho_s=run.drive.tacho_s(count / run.fs_hz),
        contact_loss_share=contact_loss_share,
        status="ok",
        reason="",
        internals=_named(run.motion.internal_names, np.concatenate(inner).T.copy()) if inner else {},
        history=History(_named(motions, values[0][:, :history]), before),
    )


def _add_static_part(run: _Run, forces: FloatArray) -> None:
    """Add to bearing forces (places, n), which were filtered about their static values, what they are at rest."""
    static, pairs = run.motion.equations.static_deflection, run.motion.structure.bearing_forces
    forces += np.array([(stiffness * static).sum() for stiffness, _ in pairs.values()]).reshape(-1, 1)


def _named(names: Iterable[str], rows: FloatArray) -> Mapping[str, FloatArray]:
    return {name: _frozen(row) for name, row in zip(names, rows, strict=True)}


def _failed(run: _Run, failure: SolverFailure) -> Response:
    """Return a response without samples that says what went wrong."""
    empty = _frozen(np.empty(0))
    return Response(
        fs_hz=run.fs_hz,
        acceleration_m_s2=dict.fromkeys(run.motions, empty),
        bearing_force_n=dict.fromkeys(run.motion.structure.bearing_forces, empty),
        angle_rad=empty,
        tacho_s=empty,
        contact_loss_share=0.0,
        status=failure.status,
        reason=failure.reason,
        internals={},
        history=History({}, {}),
    )


def _frozen(values: FloatArray) -> FloatArray:
    """Return the array, read-only."""
    values.setflags(write=False)
    return values
