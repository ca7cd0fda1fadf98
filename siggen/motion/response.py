"""Response: accelerations, bearing forces and readings of shafts at the output rate, after the transient."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.drivetrain.drive import Rotation
from siggen.drivetrain.excitation import Excitation, SampledExcitation
from siggen.drivetrain.structure import Structure, at_rest_beside, frame_turns, in_space
from siggen.errors import SolverFailure
from siggen.motion.decimation import Decimator, half_length, second_difference_taps, value_taps
from siggen.motion.equations import Equations, approach_of, no_inputs
from siggen.motion.motion import History, Motion, settling_steps

# Filters that make delivered accelerations, bearing forces and readings of shafts of a structure's states.


def acceleration_decimator(
    structure: Structure, motions: Sequence[str], fs_hz: float, steps_per_sample: int
) -> Decimator:
    """Return what turns displacements into low-passed accelerations of the named motions."""
    still = np.zeros(len(structure.coordinates))
    rows = np.array([np.concatenate([structure.motions[name], still]) for name in motions]).reshape(-1, 2 * still.size)
    second_rate = second_difference_taps(steps_per_sample) * (fs_hz * steps_per_sample) ** 2
    return Decimator(rows, second_rate, steps_per_sample)


class ValueDecimator:
    """Filters values first · q + second · q̇ about their static values: states count from the static deflection.

    Parameters
    ----------
    pairs : pairs of (n,), first and second
    static_deflection : (n,)
    steps_per_sample : int
    """

    def __init__(
        self, pairs: Iterable[tuple[FloatArray, FloatArray]], static_deflection: FloatArray, steps_per_sample: int
    ) -> None:
        kept = list(pairs)
        rows = np.array([np.concatenate(pair) for pair in kept]).reshape(-1, 2 * static_deflection.size)
        self._decimator = Decimator(rows, value_taps(steps_per_sample), steps_per_sample)
        self._at_rest = np.array([(first * static_deflection).sum() for first, _ in kept]).reshape(-1, 1)

    def take(self, states: FloatArray) -> FloatArray:
        """Filter the next states (steps, 2n) as far as the filter reaches; return the next samples (pairs, k)."""
        return np.asarray(self._decimator.take(states) + self._at_rest)


# ResponseStream: accelerations, bearing forces and readings of shafts at the output rate, piece after piece.
#
# Transient and record are stepped in blocks, whose states are filtered and forgotten: memory does not grow with the
# record.

BLOCK_SAMPLES = 2048
"""Output samples per block of integration; bounds the memory independently of the duration."""


@dataclass(frozen=True, slots=True)
class Run:
    """A motion with its time grid, `steps_per_sample` states per sample, step 0 at time 0, and wanted `motions`."""

    motion: Motion
    drive: Rotation
    fs_hz: float
    steps_per_sample: int
    excitation: Excitation | SampledExcitation | None = None
    motions: tuple[str, ...] = ()

    def time_s(self, first: int, count: int, each: int = 1) -> FloatArray:
        """Return the times (count,) of steps from step `first` on, of every `each`-th one."""
        return np.arange(first, first + count * each, each) / (self.fs_hz * self.steps_per_sample)

    def pitches(self, first: int, count: int, each: int = 1) -> FloatArray:
        """Return the angle of the mesh law in base pitches at `count` steps as for `time_s`."""
        per_turn = self.motion.teeth * (1.0 - frame_turns(self.motion.structure))
        turned = self.drive.angle_rad(self.time_s(first, count, each)) * (per_turn / (2.0 * np.pi))
        return turned + self.motion.structure.mesh.flanks.ahead_pitches

    def seen(self, first: int, states: FloatArray) -> FloatArray:
        """Return states (steps, 2n) from step `first` on as sensors at rest see their places."""
        motion = self.motion
        if not motion.structure.frame:
            return states
        turned = self.drive.angle_rad(self.time_s(first, len(states))) * frame_turns(motion.structure)
        return in_space(motion.structure.drivetrain, states, motion.equations.static_deflection, turned)

    @property
    def seen_from(self) -> FloatArray:
        """The static deflection (n,) that states as `seen` count from."""
        structure, static = self.motion.structure, self.motion.equations.static_deflection
        return at_rest_beside(structure.drivetrain, static) if structure.frame else static

    def inputs(self, first: int, pitches: FloatArray, each: int = 1) -> FloatArray:
        """Return the external inputs (k, m) at the steps as for `time_s` whose pinion angles are given."""
        if self.excitation is None:
            return no_inputs(pitches)
        return self.excitation.inputs(self.time_s(first, pitches.size, each), self.drive)

    def driven(self, first: int, count: int) -> tuple[FloatArray, FloatArray]:
        """Return pitches (count + 1,) and inputs (count + 1, m) from step `first` on, as the integrator looks at them.

        One that gives the state in the middle of its steps asks for nothing there: what it takes as linear is linear.
        """
        each = self.motion.stride if count % self.motion.stride == 0 else 1
        pitches = self.pitches(first, count // each + 1, each)
        inputs = self.inputs(first, pitches, each)
        return (pitches, inputs) if each == 1 else (_with_middles(pitches), _with_middles(inputs))


class Piece(NamedTuple):
    """Accelerations (motions, k), bearing forces (places, k) and readings of shafts (readings, k) at the next samples.

    Static forces and readings are included.
    """

    acceleration_m_s2: FloatArray
    bearing_force_n: FloatArray
    shaft_reading: FloatArray


class SteppedStates(NamedTuple):
    """States (steps, 2n) from step `first` on, inputs (steps, m); `apart` (meshes, steps): where no teeth touch."""

    first: int
    states: FloatArray
    inputs: FloatArray
    apart: NDArray[np.bool_] | None


class ResponsePieces(Protocol):
    """Pieces of the named motions, forces and readings, the first one from `before` samples before sample 0."""

    @property
    def motions(self) -> tuple[str, ...]:
        """Names of the rows of accelerations."""

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the rows of bearing forces."""

    @property
    def readings(self) -> tuple[str, ...]:
        """Names of the rows of readings of shafts."""

    @property
    def before(self) -> int:
        """Samples of the history."""

    def pieces(self) -> Iterator[Piece]:
        """Yield all pieces in order."""


class ResponseStream:
    """What a run gives from `history` samples before sample 0 to `ahead` samples behind the last of `samples`.

    `settle` steps come before sample 0. `inner` collects internals (k, names), if asked for.
    """

    def __init__(
        self,
        run: Run,
        samples: int,
        *,
        settle: int,
        history: int = 0,
        ahead: int = 0,
        bearing_forces: bool = True,
        shafts: bool = False,
        internals: bool = False,
    ) -> None:
        self.run, self.samples, self.before, self.ahead = run, samples, history, ahead
        self.motions: tuple[str, ...] = run.motions
        self.places: tuple[str, ...] = tuple(run.motion.structure.bearing_forces) if bearing_forces else ()
        self.readings: tuple[str, ...] = tuple(run.motion.structure.shaft_readings) if shafts else ()
        self.inner: list[FloatArray] = []
        self._settle, self._with_internals = settle, internals
        self._lost = np.zeros(len(run.motion.structure.meshes), dtype=np.int64)

    @property
    def contact_loss_share(self) -> float:
        """Share of the record in which no teeth touched, of the mesh that parts most, once all pieces were taken."""
        return int(self._lost.max()) / (self.samples * self.run.steps_per_sample)

    def pieces(self) -> Iterator[Piece]:
        """Step through transient and record.

        Raises
        ------
        SolverFailure
            If the state is not finite or the teeth would have passed through each other.
        """
        run, steps = self.run, self.run.steps_per_sample
        half, structure = half_length(steps), run.motion.structure
        state = run.motion.start(run.pitches(-half - self._settle, 1)[0])
        begin = -half - self.before * steps
        for _ in stepped_blocks(run, state, -half - self._settle, begin):
            pass
        accelerations = acceleration_decimator(structure, run.motions, run.fs_hz, steps)
        static, shafts = run.motion.equations.static_deflection, structure.shaft_readings
        forces = BearingForces(run, self.places)
        readings = ValueDecimator((shafts[name] for name in self.readings), static, steps)
        end = (self.samples + self.ahead - 1) * steps + half + 1
        for block in stepped_blocks(run, state, begin, end):
            seen = run.seen(block.first, block.states)
            piece = Piece(accelerations.take(seen), forces.take(seen, block.inputs), readings.take(block.states))
            self._count(block)
            if piece.acceleration_m_s2.shape[1]:
                yield piece

    def _count(self, block: SteppedStates) -> None:
        first, states = block.first, block.states
        recorded = slice(max(0, -first), max(0, self.samples * self.run.steps_per_sample - first))
        self.run.motion.refuse_outside(states[recorded])
        self._lost += _steps_apart(self.run, block, recorded)
        if self._with_internals and first + len(states) > 0:  # nothing of the history
            self.inner.append(_inner_values(self.run, first, states, self.samples))


class BearingForces:
    """Low-passed bearing forces of a run, from states and inputs that are taken block after block."""

    def __init__(self, run: Run, places: tuple[str, ...]) -> None:
        motion, steps = run.motion, run.steps_per_sample
        pairs = (motion.structure.bearing_forces[name] for name in places)
        self._of_states = ValueDecimator(pairs, run.seen_from, steps)
        rows = np.zeros((0, 0)) if run.excitation is None else run.excitation.seat_force_rows(places)
        self._of_inputs = Decimator(rows, value_taps(steps), steps) if rows.any() else None

    def take(self, seen: FloatArray, inputs: FloatArray) -> FloatArray:
        """Return the forces on the seats (places, k) as far as the filter reaches, of states as `Run.seen`."""
        forces = self._of_states.take(seen)
        return forces if self._of_inputs is None else forces + self._of_inputs.take(inputs)


def _steps_apart(run: Run, block: SteppedStates, recorded: slice) -> NDArray[np.int64]:
    """Return at how many of the recorded steps of a block no teeth of each mesh touch (meshes,)."""
    if block.apart is None:
        pitches = run.pitches(block.first, len(block.states))
        return run.motion.steps_apart(block.states[recorded], pitches[recorded])
    return np.asarray(block.apart[:, recorded].sum(axis=1))


def stepped_blocks(run: Run, state: FloatArray, start: int, stop: int) -> Iterator[SteppedStates]:
    """Yield blocks from step `start` up to without `stop`; their states are valid until the next one is asked for.

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
        pitches, inputs = run.driven(first, count)
        apart = run.motion.advance(pitches, inputs, trajectory[: count + 1])
        beyond = _first_beyond(run.motion.equations, trajectory[: count + 1], run.motion.limits_m)
        if beyond >= 0:
            raise _divergence(run, first + beyond, trajectory[beyond])
        state[:] = trajectory[count]
        yield SteppedStates(first, trajectory[:count], inputs[:count], apart)


def _with_middles(values: FloatArray) -> FloatArray:
    """Return values (k, ...) with the mean of neighbours between them (2 k - 1, ...)."""
    result = np.empty((2 * len(values) - 1, *values.shape[1:]))
    result[::2] = values
    result[1::2] = 0.5 * (values[1:] + values[:-1])
    return result


def _divergence(run: Run, step: int, state: FloatArray) -> SolverFailure:
    limits = run.motion.limits_m
    found = [approach_of(run.motion.equations, mesh, state)[0] for mesh in range(len(limits))]
    worst = next(m for m, approach in enumerate(found) if not abs(approach) <= limits[m])
    time = step / (run.fs_hz * run.steps_per_sample)
    return SolverFailure(
        "diverged",
        f"approach {found[worst]:.3e} m at {time:.6f} s (before 0 s: transient); allowed are finite values within "
        f"{limits[worst]:.3e} m; raise steps_per_sample (received {run.steps_per_sample}) or the damping",
    )


@entry(cache=True)
def _first_beyond(equations: Equations, states: FloatArray, limits_m: FloatArray) -> int:
    """Return the first row in which the approach of a mesh is not a finite number within its limit, or -1."""
    for i in range(states.shape[0]):
        for mesh in range(limits_m.size):
            approach, _ = approach_of(equations, mesh, states[i])
            if not abs(approach) <= limits_m[mesh]:
                return i
    return -1


def _inner_values(run: Run, first: int, states: FloatArray, samples: int) -> FloatArray:
    """Return the internals (k, names) at those steps of a block that are output samples."""
    steps = np.arange(first, first + len(states))
    chosen = (steps >= 0) & (steps % run.steps_per_sample == 0) & (steps < samples * run.steps_per_sample)
    pitches = run.pitches(first, len(states))
    return run.motion.internals(states[chosen], pitches[chosen], run.inputs(first, pitches)[chosen])


WINDOW_SAMPLES = 32_768
"""Output samples that one spline of the inputs covers."""


@dataclass(frozen=True, slots=True)
class SampleGrid:
    """Output rate [Hz], how many samples, and steps of integration per sample."""

    fs_hz: float
    samples: int
    steps_per_sample: int


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


# A stretch of a motion at the output rate, from a state that is at hand: to compare steps before a record is made.

LEAD = half_length(1)
"""Samples that the low-pass reaches to either side, at any number of steps per sample."""


class Stretch(NamedTuple):
    """So many samples from `first` on; the motion begins LEAD samples before."""

    first: int
    samples: int


def state_at(run: Run, first: int, until: int) -> FloatArray:
    """Return the state (2n,) LEAD samples before sample `until` of a motion that starts as many before `first`.

    Raises
    ------
    SolverFailure
        If the motion diverges.
    """
    steps = run.steps_per_sample
    state = run.motion.start(run.pitches((first - LEAD) * steps, 1)[0])
    for _ in stepped_blocks(run, state, (first - LEAD) * steps, (until - LEAD) * steps):
        pass
    return state


class Seen(NamedTuple):
    """Accelerations (motions, samples) of a stretch, and whether no teeth of a mesh touched at one of its steps."""

    accelerations: FloatArray
    parts: bool


def seen_stretch(run: Run, state: FloatArray, stretch: Stretch) -> Seen:
    """Return what is seen of a stretch from the `state` (2n,) LEAD samples before it.

    Raises
    ------
    SolverFailure
        If the motion diverges.
    """
    steps = run.steps_per_sample
    decimator = acceleration_decimator(run.motion.structure, run.motions, run.fs_hz, steps)
    begin, end = (stretch.first - LEAD) * steps, (stretch.first + stretch.samples + LEAD) * steps
    skipped, taken, parts = LEAD * steps - half_length(steps), [], False
    for block in stepped_blocks(run, state.copy(), begin, end):
        taken.append(decimator.take(block.states[skipped:]))
        parts = parts or (block.apart is not None and bool(block.apart.any()))
        skipped = 0
    return Seen(np.concatenate(taken, axis=1)[:, : stretch.samples], parts)


# Sampling: how many samples a record has, and how fast they follow.


@dataclass(frozen=True, slots=True)
class Sampling:
    """Rate, duration as it was asked for, and number of samples of a record."""

    fs_hz: float
    duration_s: float
    samples: int
