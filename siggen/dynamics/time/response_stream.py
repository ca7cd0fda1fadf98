"""ResponseStream: accelerations, bearing forces and readings of shafts at the output rate, piece after piece.

Transient and record are stepped in blocks, whose states are filtered and forgotten: memory does not grow with the
record.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.dynamics.drive.drive import Rotation
from siggen.dynamics.drive.excitation import Excitation
from siggen.dynamics.drive.sampled_excitation import SampledExcitation
from siggen.dynamics.structure.fixed_frame import at_rest_beside, in_space
from siggen.dynamics.structure.shaft_lines import frame_turns
from siggen.dynamics.time.decimation import Decimator, half_length, value_taps
from siggen.dynamics.time.equations import Equations, approach_of, no_inputs
from siggen.dynamics.time.motion import Motion
from siggen.dynamics.time.response_filters import ValueDecimator, acceleration_decimator
from siggen.errors import SolverFailure

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
