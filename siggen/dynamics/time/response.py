"""Response: accelerations and bearing forces of a gear stage at the output rate, after the transient."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Drive, Rotation
from siggen.dynamics.drive.excitation import Excitation
from siggen.dynamics.drive.sampled_excitation import SampledExcitation
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.decimation import half_length
from siggen.dynamics.time.history import History
from siggen.dynamics.time.linear_motion import LinearMotion
from siggen.dynamics.time.motion import Motion
from siggen.dynamics.time.response_stream import Piece, ResponseStream, Run
from siggen.dynamics.time.transient import settling_steps
from siggen.errors import SolverFailure

if TYPE_CHECKING:
    from siggen.gears.stiffness.mesh_tables import MeshTables


WINDOW_SAMPLES = 32_768
"""Output samples that one spline of the inputs covers."""


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
    history, after : the samples before sample 0 and behind the last one of accelerations and bearing forces; (0,)
        arrays unless asked for
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
    after: History

    @property
    def motions(self) -> tuple[str, ...]:
        """Names of the accelerations."""
        return tuple(self.acceleration_m_s2)

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the bearing forces."""
        return tuple(self.bearing_force_n)

    @property
    def before(self) -> int:
        """Samples of the history."""
        return max((values.size for values in self.history.acceleration_m_s2.values()), default=0)

    def pieces(self) -> Iterator[Piece]:
        """Yield history, record and what comes behind it."""
        for outside in (self.history, None, self.after):
            accelerations = self.acceleration_m_s2 if outside is None else outside.acceleration_m_s2
            forces = self.bearing_force_n if outside is None else outside.bearing_force_n
            yield Piece(_rows(accelerations), _rows(forces))


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

    Arguments and errors as `response_stream`; a failed one has a status and its reason.
    """
    stream = response_stream(
        motion, drive, fs_hz=fs_hz, samples=samples, steps_per_sample=steps_per_sample, internals=internals,
        bearing_forces=bearing_forces, motions=motions, excitation=excitation, settle_s=settle_s, history_s=history_s,
    )  # fmt: skip
    return collected_response(stream)


def response_stream(
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
    ahead: int = 0,
) -> ResponseStream:
    """Return what a motion that was made for the step 1/(fs_hz steps_per_sample) does, before it is stepped.

    Starts from the static equilibrium and discards the transient that the motion states, or `settle_s` if that is
    longer. Of this time the last `history_s` at most are kept as history; asking for it changes nothing else, nor do
    `ahead` samples behind the record. Filtering costs about a fifth of a response for four forces or motions: without
    `bearing_forces` there are none, and accelerations are those of the named `motions`; None: all. The motion must hold
    the vectors of `excitation`.

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
        ends_s = -(settle + half) / rate_hz, ((samples + ahead) * steps_per_sample + half) / rate_hz
        acting = SampledExcitation(excitation, drive, *ends_s, rate_hz, WINDOW_SAMPLES / fs_hz)
    wanted = tuple(name for name in motion.structure.motions if motions is None or name in motions)
    return ResponseStream(
        Run(motion, drive, fs_hz, steps_per_sample, acting, wanted), samples, settle=settle, history=history,
        ahead=ahead, bearing_forces=bearing_forces, internals=internals,
    )  # fmt: skip


def collected_response(stream: ResponseStream) -> Response:
    """Return all pieces of a stream as one response; a failed one has a status and its reason."""
    length = stream.before + stream.samples + stream.ahead
    accelerations = np.empty((len(stream.motions), length))
    forces = np.empty((len(stream.places), length))
    done = 0
    try:
        for piece in stream.pieces():
            block = slice(done, done + piece.acceleration_m_s2.shape[1])
            accelerations[:, block] = piece.acceleration_m_s2
            if stream.places:
                forces[:, block] = piece.bearing_force_n
            done = block.stop
    except SolverFailure as failure:
        return _failed(stream.run, failure)
    return _finished(stream, accelerations, forces)


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


def _finished(stream: ResponseStream, accelerations: FloatArray, forces: FloatArray) -> Response:
    """Name the rows of accelerations and forces (channels, history + n + ahead), and internals."""
    run, count, end = stream.run, stream.samples, stream.before + stream.samples
    parts = [
        (_named(stream.motions, a), _named(stream.places, f))
        for a, f in zip(
            np.split(accelerations, [stream.before, end], axis=1),
            np.split(forces, [stream.before, end], axis=1),
            strict=True,
        )
    ]
    names = run.motion.internal_names
    return Response(
        fs_hz=run.fs_hz,
        acceleration_m_s2=parts[1][0],
        bearing_force_n=parts[1][1],
        angle_rad=_frozen(run.drive.angle_rad(np.arange(count) / run.fs_hz)),
        tacho_s=run.drive.tacho_s(count / run.fs_hz),
        contact_loss_share=stream.contact_loss_share,
        status="ok",
        reason="",
        internals=_named(names, np.concatenate(stream.inner).T.copy()) if stream.inner else {},
        history=History(*parts[0]),
        after=History(*parts[2]),
    )


def _rows(named: Mapping[str, FloatArray]) -> FloatArray:
    return np.array(list(named.values())) if named else np.empty((0, 0))


def _named(names: Iterable[str], rows: FloatArray) -> Mapping[str, FloatArray]:
    return {name: _frozen(row) for name, row in zip(names, rows, strict=True)}


def _failed(run: Run, failure: SolverFailure) -> Response:
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
        after=History({}, {}),
    )


def _frozen(values: FloatArray) -> FloatArray:
    """Return the array, read-only."""
    values.setflags(write=False)
    return values
