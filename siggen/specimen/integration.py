"""How many integration steps a sample takes, to begin with: a rule without pilot runs (`step_choice` checks it).

Product integration and Runge-Kutta take the number of the file. The exponential integrator takes what its tolerance
asks for. Its error falls with the square of the step (`python -m benchmarks precision`: friction and flanks that touch
within steps set it), and three rates set its size: the highest natural frequency to which the mesh contributes, the
rate of the teeth, and the rate at which friction stops the sliding around the pitch point. The fastest one counts. All
are those of the record: another operating point of the set does not change them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, pi, sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.friction.friction import SLIP_SPEED_M_S
from siggen.dynamics.mesh.tooth_law import CONSTANT, EXPONENTIAL, MIXED_EHL, ToothLaw
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.modes import natural_modes
from siggen.gearbox.specimen import OperatingPoint
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.mesh_tables import MeshTables
from siggen.specimen.asperities import FrictionTurn, friction_turn
from siggen.specimen.motion import SpecimenMesh

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
