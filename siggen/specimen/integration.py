"""How many integration steps a sample of a gearbox takes: a rule without pilot runs, the same for all of its states.

Product integration and Runge-Kutta take the number of the file. The exponential integrator takes what its tolerance
asks for. Its error falls with the square of the step (`python -m benchmarks precision`: friction and flanks that touch
within steps set it), and two rates set its size: the highest natural frequency to which the
mesh contributes, and the rate of the teeth. The faster one counts, at the record's own speed.
"""

from __future__ import annotations

from math import ceil, pi, sqrt
from typing import NamedTuple

from siggen.config import Config
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.modes import natural_modes
from siggen.gears.stiffness.mesh_tables import MeshTables
from siggen.planning.specimen import OperatingPoint, Specimen

MOST_RADIANS, LEAST_PER_PITCH = 1.4, 50.0
"""Radians of the mesh's vibration in one step, and steps per base pitch.

At 1.84 rad and 38 steps per pitch the worst of 24 records of quickstart erred by 1.15e-3; at half of that by 2.6e-4
(`siggen verify DIR --physics 24`). The bound lies between: at 1.34 rad (35.2 kHz) the worst of 8 records errs by
4.4e-4.
"""
USUAL_TOLERANCE = 1e-3
MESH_SHARE = 0.05
"""Of the strain energy: modes with less in the mesh do not feel how its force is integrated."""


class TimeGrid(NamedTuple):
    """States per sample, and how many of them one step of the integrator gives.

    A motion has content above half the sampling rate. So its states are never kept more seldom than twice per sample,
    however long the steps: one state per sample folds 6e-4 of a record into its band, on some gearboxes 4e-3.
    """

    per_sample: int
    stride: int


def time_grid(
    config: Config, specimen: Specimen, structure: Structure, tables: MeshTables, point: OperatingPoint
) -> TimeGrid:
    """Return where the states of a gearbox at an operating point are.

    Parameters
    ----------
    config, specimen, structure
    tables : MeshTables
        Of any state: what counts is the stiffest pair at every position, which is healthy.
    point : OperatingPoint
        As drawn: steps are those of this point alone.
    """
    dynamics = specimen.dynamics
    if dynamics.method != "exponential":
        return TimeGrid(dynamics.steps_per_sample, 1)
    healthy = tables.pair_stiffness_n_per_m.max(axis=0)
    stiffness = float(healthy.mean()) * (tables.end_m - tables.start_m) / tables.base_pitch_m
    modes = natural_modes(structure, stiffness)
    fastest_hz = float(modes.frequency_hz[modes.mesh_share >= MESH_SHARE].max(initial=0.0))
    teeth_hz = float(tables.table_of_pair.shape[0]) * abs(point.speed_hz)
    rate_hz = max(2.0 * pi * fastest_hz / MOST_RADIANS, LEAST_PER_PITCH * teeth_hz)
    finer = sqrt(USUAL_TOLERANCE / dynamics.integration_tolerance)
    steps = max(1, ceil(rate_hz / config.fs_hz * finer))
    return TimeGrid(2, 2) if steps == 1 else TimeGrid(steps, 1)
