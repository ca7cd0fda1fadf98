"""How many steps a record takes and how early it starts, as a stretch of the record itself says, with the error left.

The rule knows speed, friction and natural frequencies, but not how often flanks part and how hard they meet again. So a
stretch of the record is integrated twice from one state, with the steps at hand and with twice as many, and delivered
accelerations are compared. Where they differ too much steps are refined. The stretch begins before a damaged pair
enters, if one does, since such a pair may be rare. Its length follows from the speed, from how long motions ring
and from what pushes now and then, such as a spalled bearing.

Errors fall with the square of the step, so a difference is three quarters of the error. Motions of sensors are left
out: a sensor that is added must not change the others.

The stretch begins settled. From a start at its beginning it is integrated once more: what that changes falls with the
slowest decay, so it says how long before its samples the record has to start, and what is left of that. Where flanks
part and samples have nothing in common, levels over a longer time are compared.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, hypot, inf, pi, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.excitation import SampledExcitation
from siggen.drivetrain.structure import Structure
from siggen.errors import SolverFailure
from siggen.gearbox.specimen import OperatingPoint
from siggen.gears.gear_pair import GearPair
from siggen.mesh.friction import SLIP_SPEED_M_S
from siggen.mesh.mesh_tables import MeshTables
from siggen.mesh.tooth_law import CONSTANT, EXPONENTIAL, MIXED_EHL, ToothLaw
from siggen.motion.exponential_motion import ExponentialMotion
from siggen.motion.modes import natural_modes
from siggen.motion.motion import DECAY_TIMES, Motion, forgotten
from siggen.motion.response import LEAD, Run, Sampling, Seen, Stretch, seen_stretch, state_at
from siggen.record.drive import RecordDrive
from siggen.record.friction import FrictionTurn, friction_turn
from siggen.record.motion import MeshBehind, SpecimenMesh, specimen_motion
from siggen.sensors.quantity import STILL_M_S2

# How many integration steps a sample takes, to begin with: a rule without pilot runs (`step_choice` checks it).
#
# Product integration and Runge-Kutta take the number of the file. The exponential integrator takes what its tolerance
# asks for. Its error falls with the square of the step (`python -m benchmarks precision`: friction and flanks that
# touch within steps set it), and three rates set its size: the highest natural frequency to which the mesh
# contributes, the rate of the teeth, and the rate at which friction stops the sliding around the pitch point. The
# fastest one counts. All are those of the record: another operating point of the set does not change them.

MOST_RADIANS, LEAST_PER_PITCH = 1.4, 50.0
"""Radians of the mesh's vibration in one step, and steps per base pitch.

At 1.84 rad and 38 steps per pitch the worst of 24 records of quickstart erred by 1.15e-3; at half of that by 2.6e-4
(`siggen verify DIR --physics 24`). The bound lies between: at 1.34 rad (35.2 kHz) the worst of 8 records errs by
4.4e-4.
"""
MOST_STOPPED = 1.2
"""Step over the time in which friction stops the sliding where it turns.

Forces of friction follow from those of the iteration before, which converges where this is below 2 (derived).
"""
USUAL_TOLERANCE = 1e-3
ENOUGH_STATES = 3
"""Per sample: with fewer steps the integrator also gives the state in the middle of each."""
MESH_SHARE = 0.05
"""Of the strain energy: modes with less in the mesh do not feel how its force is integrated."""


class TimeGrid(NamedTuple):
    """States per sample, and how many of them one step of the integrator gives.

    A motion has content above half the sampling rate, which states that are too seldom fold into the band. At 25.6 kHz
    two states per sample folded 2e-3 of what bearings show from 8.8 to 10.4 kHz, four 3e-5: a housing that resonates
    there shows it.
    """

    per_sample: int
    stride: int

    @property
    def steps(self) -> int:
        """Steps of the integrator per sample."""
        return self.per_sample // self.stride


def exponential_grid(steps: int) -> TimeGrid:
    """Return where states are with so many steps of the exponential integrator per sample."""
    return TimeGrid(2 * steps, 2) if steps < ENOUGH_STATES else TimeGrid(steps, 1)


def rule_grid(fs_hz: float, law: ToothLaw, mesh: SpecimenMesh, point: OperatingPoint) -> TimeGrid:
    """Return where the states of a record are by the rule.

    The tables may be of any state: what counts is the stiffest pair at every position, which is healthy.
    """
    if law.method != EXPONENTIAL:
        return TimeGrid(law.steps_per_sample, 1)
    mesh, front = mesh.carrying(point)
    teeth_hz = max(
        float(one.mesh.tables.table_of_pair.shape[0]) * one.turning * abs(point.speed_hz) for one in mesh.every
    )
    vibration_per_s = 2.0 * pi * _fastest_hz(mesh.structure, [one.mesh.tables for one in mesh.every]) / MOST_RADIANS
    by_mesh = zip(mesh.every, mesh.structure.meshes, strict=True)
    stopping_per_s = max(
        _stopping_per_s(law, mesh.structure, vectors.sliding, one.mesh.pair, one.at(front))
        for one, vectors in by_mesh
    ) / MOST_STOPPED  # fmt: skip
    rate_hz = max(vibration_per_s, LEAST_PER_PITCH * teeth_hz, stopping_per_s)
    finer = sqrt(USUAL_TOLERANCE / law.tolerance)
    return exponential_grid(max(1, ceil(rate_hz / fs_hz * finer)))


def _fastest_hz(structure: Structure, meshes: Sequence[MeshTables]) -> float:
    """Return the highest natural frequency to which a mesh contributes."""
    healthy = [float(one.pair_stiffness_n_per_m.max(axis=0).mean()) for one in meshes]
    pairs = [(one.end_m - one.start_m) / one.base_pitch_m for one in meshes]
    modes = natural_modes(structure, [k * count for k, count in zip(healthy, pairs, strict=True)])
    return float(modes.frequency_hz[modes.mesh_share >= MESH_SHARE].max(initial=0.0))


def _stopping_per_s(
    law: ToothLaw, structure: Structure, vectors: FloatArray, pair: GearPair, point: OperatingPoint
) -> float:
    """Return how fast friction under the static force stops the sliding where it turns: μ F/v_0 · r M⁻¹ r (derived)."""
    turn = friction_turn(law.friction, pair, point) if law.friction.model == MIXED_EHL else None
    if law.friction.model == CONSTANT:
        turn = FrictionTurn(law.friction.coefficient, SLIP_SPEED_M_S)
    if turn is None:
        return 0.0
    force_n = abs(point.torque_nm) / pair.pinion.base_radius_m
    r_0, r_1 = vectors
    sliding = r_0 + pair.pitch_point_m * r_1
    by_mass = float(sliding @ np.linalg.solve(structure.mass, sliding))
    return float(turn.coefficient * force_n / turn.slip_speed_m_s * by_mass)


MARGIN = 0.6
"""Of the tolerance: what a stretch may err by. The record of a channel may err by more.

Behind resonances of the housing at 9 to 10 kHz it did by up to 1.64 times (12 records of six gearboxes of quickstart).
"""
LEAST_S, LEAST_PITCHES = 0.03, 5.0
"""Length over which accelerations are compared."""
LONGEST_RINGING_S = 0.1
"""Before that, two motions from one state may part, one decay time long but no longer than this."""
SETTLING_DECAYS = 2.0
"""Decay times of the slowest mode from the start to that state. All motions but one begin with it, so it need only be

usual: with five of them no label of 27 records of three presets moved by more than 1 %.
"""
START_SHARE = 0.1
"""Of the tolerance: what is left of the start."""
LEVELS_S = 0.5
"""Over which levels are compared."""
SAMPLES, LEVELS = "samples", "levels"
PITCHES_BEFORE = 1.0
"""Before a damaged pair enters."""
SHRINKS = 4.0 / 3.0
"""Error over the difference from half the step."""
MOST_STEPS = 64
"""Per sample."""
HOPELESS = 0.5
"""Of the error with four times the step: a motion that does not come nearer depends on every rounding."""
SPREAD_POINTS = 1024


class Stepped(NamedTuple):
    """Where the states of a record are, its motion, and its error by a stretch; None where the integrator states none.

    The motion may have been stepped: `start` makes it forget that. Its `transient_s` is what this record needs.
    `error_of`: what was compared.
    """

    grid: TimeGrid
    motion: Motion
    error: float | None
    error_of: str = SAMPLES


@dataclass(frozen=True, slots=True)
class Probe:
    """A record that can be integrated with any steps."""

    sampling: Sampling
    law: ToothLaw
    mesh: SpecimenMesh
    point: OperatingPoint
    driven: RecordDrive

    def motion(self, grid: TimeGrid, like: Motion | None = None) -> Motion:
        """Return the motion for a grid, quickly where one for another grid is at hand."""
        step_s = 1.0 / (self.sampling.fs_hz * grid.per_sample)
        if isinstance(like, ExponentialMotion):
            return like.with_steps(step_s, grid.stride)
        return specimen_motion(self.law, self.mesh, self.point, step_s, self.driven, stride=grid.stride)

    def inputs(self, first: int, end: int, rate_hz: float) -> SampledExcitation | None:
        """Return what acts between two samples and as far around them as filters reach."""
        acting, fs_hz = self.driven.excitation, self.sampling.fs_hz
        if acting is None:
            return None
        return SampledExcitation(acting, self.driven.rotation, (first - LEAD) / fs_hz, (end + LEAD) / fs_hz, rate_hz)

    def run(self, motion: Motion, steps: int, acting: SampledExcitation | None) -> Run:
        """Return a motion with so many states per sample."""
        return Run(motion, self.driven.rotation, self.sampling.fs_hz, steps, acting, _compared(motion))

    def ringing(self, motion: Motion) -> int:
        """Return the samples in which two motions from one state part as far as they will."""
        return ceil(min(motion.decay_s, LONGEST_RINGING_S) * self.sampling.fs_hz)

    def stretch(self, motion: Motion) -> Stretch:
        """Return where the record is looked at."""
        pitches_hz = min(
            one.mesh.tables.table_of_pair.shape[0] * one.turning * abs(self.point.speed_hz) for one in self.mesh.every
        )
        count = self.samples(max(LEAST_S, LEAST_PITCHES / pitches_hz, self._sharp_s()))
        ringing = self.ringing(motion)
        return Stretch(self._first() - ringing, ringing + count)

    def samples(self, compared_s: float) -> int:
        """Return the samples of a time, as far as the record has them."""
        return max(2, min(ceil(compared_s * self.sampling.fs_hz), self.sampling.samples))

    def _sharp_s(self) -> float:
        """Return the time over which what acts shows all that it changes within few steps."""
        acting = self.driven.excitation
        return 0.0 if acting is None else acting.sharp_turn_rad / (2.0 * np.pi * abs(self.point.speed_hz))

    def _first(self) -> int:
        """Return the sample before the first damaged pair of any mesh enters; without one the first of the record."""
        if self.mesh.sham:
            return 0
        entering = (self._entering(one) for one in self.mesh.every)
        return min((sample for sample in entering if sample is not None), default=0)

    def _entering(self, one: MeshBehind) -> int | None:
        samples = np.linspace(0.0, self.sampling.samples, SPREAD_POINTS)
        kinds = one.mesh.tables.table_of_pair
        first_pinion = self.driven.rotation.angle_rad(samples / self.sampling.fs_hz) * kinds.shape[0] / (2.0 * np.pi)
        turned = first_pinion * one.turning + one.turned_pitches
        pairs = np.arange(ceil(turned[0] + PITCHES_BEFORE), int(turned[-1]))
        damaged = pairs[kinds[pairs % kinds.shape[0], pairs % kinds.shape[1]] > 0]
        return int(np.interp(damaged[0] - PITCHES_BEFORE, turned, samples)) if damaged.size else None


def stepped_motion(
    sampling: Sampling, law: ToothLaw, mesh: SpecimenMesh, point: OperatingPoint, driven: RecordDrive
) -> Stepped:
    """Return the motion of a record with its steps.

    Raises
    ------
    ValueError
        If the motion cannot start, as `specimen_motion` and `Motion.start`.
    """
    probe = Probe(sampling, law, mesh, point, driven)
    grid = rule_grid(sampling.fs_hz, law, mesh, point)
    motion = probe.motion(grid)
    if law.method != EXPONENTIAL:
        return Stepped(grid, motion, None)
    try:
        errors = _Errors(probe, grid, motion)
    except SolverFailure:
        return Stepped(grid, motion, inf)
    steps, error = refined_steps(errors, grid.steps, MARGIN * law.tolerance)
    motion.transient_s, left = errors.forgotten_start(START_SHARE * law.tolerance)
    if steps > grid.steps:
        grid = exponential_grid(steps)
        motion = probe.motion(grid, motion)
    error = hypot(error, left)
    if errors.parts and error > law.tolerance:
        return Stepped(grid, motion, errors.of_levels(grid.steps), LEVELS)
    return Stepped(grid, motion, error)


class _Errors:
    """Steps per sample -> error of a stretch that begins with a motion; what was integrated last is kept.

    `parts`: whether no teeth of a mesh touch at one of its steps.

    Raises
    ------
    SolverFailure
        If the motion diverges before the stretch.
    """

    def __init__(self, probe: Probe, grid: TimeGrid, motion: Motion) -> None:
        self._probe, self._motion = probe, motion
        self._stretch, self._ringing = probe.stretch(motion), probe.ringing(motion)
        first, end = self._stretch.first, self._stretch.first + self._stretch.samples
        settling = ceil(SETTLING_DECAYS * motion.transient_s / DECAY_TIMES * probe.sampling.fs_hz)
        self._acting = probe.inputs(first - settling, end, probe.sampling.fs_hz * grid.per_sample)
        run = probe.run(motion, grid.per_sample, self._acting)
        self._state = state_at(run, first - settling, first)
        self._last = grid.steps, _seen(run, self._state, self._stretch)
        self._start = state_at(run, first, first)
        self._by_start = self._apart(_seen(run, self._start, self._stretch), self._last[1])
        self.parts = self._last[1] is not None and self._last[1].parts

    def __call__(self, steps: int) -> float:
        """Return the error of the worst motion, infinite where a motion diverges."""
        coarse = self._last[1] if self._last[0] == steps else _seen(self._run(steps), self._state, self._stretch)
        fine = _seen(self._run(2 * steps), self._state, self._stretch)
        self._last = 2 * steps, fine
        return SHRINKS * self._apart(coarse, fine)

    def forgotten_start(self, allowed: float) -> tuple[float, float]:
        """Return how long before its samples [s] the record has to start, and its error by that."""
        ringing_s = self._ringing / self._probe.sampling.fs_hz
        return forgotten(self._by_start, ringing_s, allowed, self._motion.transient_s)

    def of_levels(self, steps: int) -> float:
        """Return by how much levels change with a later start and half the steps, infinite where a motion diverges."""
        first, count = self._stretch.first, self._ringing + self._probe.samples(LEVELS_S)
        self._acting = self._probe.inputs(first, first + count, self._probe.sampling.fs_hz * steps)
        cases = (steps, self._state), (2 * steps, self._start)
        seen = [_seen(self._run(tried), state, Stretch(first, count)) for tried, state in cases]
        if None in seen:
            return inf
        mine, other = (np.sqrt((one.accelerations[:, self._ringing :] ** 2).mean(axis=1)) for one in seen if one)
        return float((np.abs(mine - other) / np.maximum(other, STILL_M_S2)).max(initial=0.0))

    def _run(self, steps: int) -> Run:
        grid = exponential_grid(steps)
        return self._probe.run(self._probe.motion(grid, self._motion), grid.per_sample, self._acting)

    def _apart(self, found: Seen | None, wanted: Seen | None) -> float:
        if found is None or wanted is None:
            return inf
        apart = ((found.accelerations - wanted.accelerations)[:, self._ringing :] ** 2).mean(axis=1)
        whole = (wanted.accelerations[:, self._ringing :] ** 2).mean(axis=1)
        return float(np.sqrt(apart / np.maximum(whole, STILL_M_S2**2)).max(initial=0.0))


def _seen(run: Run, state: FloatArray, stretch: Stretch) -> Seen | None:
    """Return what is seen of a stretch; None where the motion diverges."""
    try:
        return seen_stretch(run, state, stretch)
    except SolverFailure:
        return None


def refined_steps(errors: Callable[[int], float], steps: int, allowed: float) -> tuple[int, float]:
    """Return steps per sample, no fewer than given, with which the error is allowed, and the error with them.

    Where no steps lead there the given ones stay, with the largest error that was seen, or the finest are taken.
    """
    tried: list[tuple[int, float]] = []
    while True:
        error = errors(steps)
        tried.append((steps, error))
        if error <= 4.0 * allowed:
            enough = max(steps, ceil(steps * sqrt(error / allowed)))
            return enough, error * (steps / enough) ** 2
        finest = 2 * steps > MOST_STEPS
        if (finest and error == inf) or (len(tried) > 2 and not error <= HOPELESS * tried[-3][1]):
            return tried[0][0], max(error for _, error in tried)
        if finest:
            return steps, error
        steps *= 2


def _compared(motion: Motion) -> tuple[str, ...]:
    """Return the motions that are compared: those of the bearings."""
    return tuple(name for name in motion.structure.motions if not name.startswith("casing_"))
