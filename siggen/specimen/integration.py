"""How many integration steps a sample of a gearbox takes: a rule without pilot runs, the same for all of its states.

Product integration and Runge-Kutta take the number of the file. The exponential integrator takes what its tolerance
asks for. Its error falls with the square of the step (`python -m benchmarks precision`: friction and flanks that touch
within steps set it), and two rates set its size: the highest natural frequency to which the
mesh contributes, and the rate of the teeth. The faster one counts, at the highest speed of the set.
"""

from __future__ import annotations

from math import ceil, pi, sqrt

from siggen.config import Config, bounds
from siggen.dynamics.structure.structure import Structure
from siggen.dynamics.time.modes import natural_modes
from siggen.gears.stiffness.mesh_tables import MeshTables
from siggen.planning.specimen import Specimen

SMOOTH, KINKED = (1.4, 50.0), (1.1, 66.0)
"""Radians of the mesh's vibration in one step, and steps per base pitch, of contact across the face and of slices.

At 1.84 rad and 39 steps per pitch the worst of 16 records of quickstart, `contact: face`, erred by 1.3e-3 in a
delivered channel (`siggen verify DIR --physics 16`); the square of the step and a quarter in hand give these. Slices
touch one by one, so their force has corners: at the same step the worst of 24 motions erred by 2.7e-3.
"""
USUAL_TOLERANCE = 1e-3
MESH_SHARE = 0.05
"""Of the strain energy: modes with less in the mesh do not feel how its force is integrated."""


def steps_per_sample(config: Config, specimen: Specimen, structure: Structure, tables: MeshTables) -> int:
    """Return the integration steps per sample.

    Parameters
    ----------
    config, specimen, structure
    tables : MeshTables
        Of any state: what counts is the stiffest pair at every position, which is healthy.
    """
    dynamics = specimen.dynamics
    if dynamics.method != "exponential":
        return dynamics.steps_per_sample
    healthy = tables.pair_stiffness_n_per_m.max(axis=0)
    stiffness = float(healthy.mean()) * (tables.end_m - tables.start_m) / tables.base_pitch_m
    modes = natural_modes(structure, stiffness)
    fastest_hz = float(modes.frequency_hz[modes.mesh_share >= MESH_SHARE].max(initial=0.0))
    teeth_hz = float(tables.table_of_pair.shape[0]) * max(
        bounds(point.speed_hz)[1] for point in config.operating_points
    )
    radians, steps_per_pitch = SMOOTH if dynamics.mesh.contact == "face" else KINKED
    rate_hz = max(2.0 * pi * fastest_hz / radians, steps_per_pitch * teeth_hz)
    finer = sqrt(USUAL_TOLERANCE / dynamics.integration_tolerance)
    return max(1, ceil(rate_hz / config.fs_hz * finer))
