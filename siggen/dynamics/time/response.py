"""Response: accelerations, bearing forces and readings of shafts at the output rate, after the transient."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Rotation
from siggen.dynamics.drive.excitation import Excitation
from siggen.dynamics.drive.sampled_excitation import SampledExcitation
from siggen.dynamics.time.decimation import half_length
from siggen.dynamics.time.history import History
from siggen.dynamics.time.motion import Motion
from siggen.dynamics.time.response_stream import Piece, ResponseStream, Run
from siggen.dynamics.time.transient import settling_steps
from siggen.errors import SolverFailure

WINDOW_SAMPLES = 32_768
"""Output samples that one spline of the inputs covers."""


@dataclass(frozen=True, slots=True)
class SampleGrid:
    """Output rate [Hz], how many samples, and steps of integration per sample.

    Raises
    ------
    ValueError
        If one of them is not positive.
    """

    fs_hz: float
    samples: int
    steps_per_sample: int

    def __post_init__(self) -> None:
        if not (np.isfinite(self.fs_hz) and self.fs_hz > 0.0):
            raise ValueError(f"fs_hz: received {self.fs_hz}; allowed are finite rates above 0")
        if self.samples < 1 or self.steps_per_sample < 1:
            raise ValueError(
                f"samples, steps_per_sample: received {self.samples}, {self.steps_per_sample}; allowed are counts "
                "from 1"
            )


@dataclass(frozen=True, slots=True)
class Wanted:
    """What of a response is wanted: internals; bearing forces; accelerations of motions, None: of all; shafts.

    Filtering costs about a fifth of a response for four forces or motions.
    """

    internals: bool = False
    bearing_forces: bool = True
    motions: Collection[str] | None = None
    shafts: bool = False


ACCELERATIONS_AND_FORCES = Wanted()


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
    contact_loss_share : share of the time with the approach inside the backlash gap, of the mesh where that is longest;
        0 if the simulation failed
    status, reason : "ok" and "", or what went wrong, with numbers
    internals : name -> (n,), values at the instants of the samples, not low-passed; empty unless asked for
    history, after : the samples before sample 0 and behind the last one of accelerations, bearing forces and readings;
        (0,) arrays unless asked for
    shaft_reading : name of `Structure.shaft_readings` -> (n,), low-passed alike, mean included; empty if not asked for
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
    shaft_reading: Mapping[str, FloatArray] = field(default_factory=dict)

    @property
    def motions(self) -> tuple[str, ...]:
        """Names of the accelerations."""
        return tuple(self.acceleration_m_s2)

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the bearing forces."""
        return tuple(self.bearing_force_n)

    @property
    def readings(self) -> tuple[str, ...]:
        """Names of the readings of shafts."""
        return tuple(self.shaft_reading)

    @property
    def before(self) -> int:
        """Samples of the history."""
        return max((values.size for part in self.history.parts for values in part.values()), default=0)

    def pieces(self) -> Iterator[Piece]:
        """Yield history, record and what comes behind it."""
        for outside in (self.history, None, self.after):
            inside = self.acceleration_m_s2, self.bearing_force_n, self.shaft_reading
            yield Piece(*(_rows(part) for part in (inside if outside is None else outside.parts)))


def response_of(
    motion: Motion,
    drive: Rotation,
    grid: SampleGrid,
    *,
    wanted: Wanted = ACCELERATIONS_AND_FORCES,
    excitation: Excitation | None = None,
    settle_s: float = 0.0,
    history_s: float = 0.0,
) -> Response:
    """Return the stationary response of a motion that was made for the steps of the grid.

    Arguments and errors as `response_stream`; a failed one has a status and its reason.
    """
    return collected_response(
        response_stream(
            motion, drive, grid, wanted=wanted, excitation=excitation, settle_s=settle_s, history_s=history_s
        )
    )


def response_stream(
    motion: Motion,
    drive: Rotation,
    grid: SampleGrid,
    *,
    wanted: Wanted = ACCELERATIONS_AND_FORCES,
    excitation: Excitation | None = None,
    settle_s: float = 0.0,
    history_s: float = 0.0,
    ahead: int = 0,
) -> ResponseStream:
    """Return what a motion that was made for the steps of the grid does, before it is stepped.

    Starts from the static equilibrium and discards the transient that the motion states, or `settle_s` if that is
    longer. Of this time the last `history_s` at most are kept as history; asking for it changes nothing else, nor do
    `ahead` samples behind the record. The motion must hold the vectors of `excitation`.
    """
    rate_hz = grid.fs_hz * grid.steps_per_sample
    settle = settling_steps(motion.transient_s, settle_s, rate_hz)
    if motion.starts_settled:  # at the same time with any steps, so that the same motion is compared
        samples = settling_steps(motion.transient_s, settle_s, grid.fs_hz) + half_length(1)
        settle = samples * grid.steps_per_sample - half_length(grid.steps_per_sample)
    history = min(round(history_s * grid.fs_hz), settle // grid.steps_per_sample)
    acting: Excitation | SampledExcitation | None = excitation
    if excitation is not None and motion.coarse_inputs:
        half = half_length(grid.steps_per_sample)
        ends_s = -(settle + half) / rate_hz, ((grid.samples + ahead) * grid.steps_per_sample + half) / rate_hz
        acting = SampledExcitation(excitation, drive, *ends_s, rate_hz, WINDOW_SAMPLES / grid.fs_hz)
    names = tuple(name for name in motion.structure.motions if wanted.motions is None or name in wanted.motions)
    return ResponseStream(
        Run(motion, drive, grid.fs_hz, grid.steps_per_sample, acting, names), grid.samples, settle=settle,
        history=history, ahead=ahead,
        bearing_forces=wanted.bearing_forces, shafts=wanted.shafts, internals=wanted.internals,
    )  # fmt: skip


def collected_response(stream: ResponseStream) -> Response:
    """Return all pieces of a stream as one response; a failed one has a status and its reason."""
    length = stream.before + stream.samples + stream.ahead
    whole = Piece(*(np.empty((len(names), length)) for names in (stream.motions, stream.places, stream.readings)))
    done = 0
    try:
        for piece in stream.pieces():
            block = slice(done, done + piece.acceleration_m_s2.shape[1])
            for rows, taken in zip(whole, piece, strict=True):
                rows[:, block] = taken
            done = block.stop
    except SolverFailure as failure:
        return _failed(stream.run, failure)
    return _finished(stream, whole)


def _finished(stream: ResponseStream, whole: Piece) -> Response:
    """Name the rows of accelerations, forces and readings (channels, history + n + ahead), and internals."""
    run, count, end = stream.run, stream.samples, stream.before + stream.samples
    names_of = stream.motions, stream.places, stream.readings
    parts = [
        tuple(_named(names, rows[:, block]) for names, rows in zip(names_of, whole, strict=True))
        for block in (slice(stream.before), slice(stream.before, end), slice(end, None))
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
        shaft_reading=parts[1][2],
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
